#include <sixdof/algorithm/ccd/convex_hull.h>

#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Frees what Qhull has allocated.
struct FreeQhull {
  void operator()(qhT* qh) const {
    qh_freeqhull(qh, !qh_ALL);
    int current = 0, total = 0;
    qh_memfreeshort(qh, &current, &total);
    delete qh;
  }
};

}  // namespace

Mesh convex_hull(const Mesh& mesh) {
  static_assert(sizeof(coordT) == sizeof(double) && sizeof(Eigen::Vector3d) == 3 * sizeof(coordT));
  // Qhull would print its errors.
  const std::unique_ptr<std::FILE, CloseFile> nowhere(std::fopen("/dev/null", "w"));
  if (nowhere == nullptr) throw Error("/dev/null cannot be opened");
  // Centred, since Qhull's tolerance grows with the coordinates.
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& v : mesh.vertices()) points.push_back(v - mesh.center());
  auto fresh = std::make_unique<qhT>();
  qh_zero(fresh.get(), nowhere.get());
  const std::unique_ptr<qhT, FreeQhull> owned(fresh.release());
  qhT* const qh = owned.get();
  char command[] = "qhull Qt";
  if (qh_new_qhull(qh, 3, static_cast<int>(points.size()), points.data()->data(), False, command, nowhere.get(),
                   nowhere.get()) != 0) {
    throw BadMesh(mesh.name() + ": no convex hull: the vertices lie in a plane, or nearly so");
  }
  std::vector<Triangle> triangles;
  facetT* facet = nullptr;
  FORALLfacets {
    Triangle t{};
    std::size_t count = 0;
    vertexT *vertex = nullptr, **vertexp = nullptr;
    FOREACHvertex_(facet->vertices) {
      if (count < t.size()) t[count] = static_cast<std::uint32_t>(qh_pointid(qh, vertex->point));
      ++count;
    }
    const Eigen::Vector3d p = points[t[0]], area = (points[t[1]] - p).cross(points[t[2]] - p);
    // Towards the facet's outward normal.
    if (area.dot(Eigen::Vector3d(facet->normal[0], facet->normal[1], facet->normal[2])) < 0.0) std::swap(t[1], t[2]);
    triangles.push_back(t);
  }
  return Mesh::build(mesh.vertices(), std::move(triangles), mesh.name() + " (convex hull)");
}

}  // namespace sixdof
