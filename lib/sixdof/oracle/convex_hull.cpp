#include <sixdof/oracle/convex_hull.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <sixdof/base/error.h>
#include <sixdof/geometry/predicates.h>

namespace sixdof {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// A triangle of the hull so far.
struct Facet {
  Triangle corners{};
  std::array<std::uint32_t, 3> across{};  ///< The facets behind the edges corners[i], corners[i + 1].
  std::vector<std::uint32_t> above{};     ///< Points strictly above its plane; each point is in one list at most.
  bool removed = false;
};

/// An edge between a facet that a new point sees and one that it does not see, in the direction of the first.
struct HorizonEdge {
  std::uint32_t from = 0, to = 0, behind = 0;
};

class Hull {
 public:
  Hull(const Points& points, const std::array<std::uint32_t, 4>& tetrahedron)
      : points_(points), facet_from_(points.size()) {
    const auto [a, b, c, d] = tetrahedron;  // d is below a, b, c
    facets_.push_back({.corners = {a, b, c}, .across = {1, 2, 3}});
    facets_.push_back({.corners = {b, a, d}, .across = {0, 3, 2}});
    facets_.push_back({.corners = {c, b, d}, .across = {0, 1, 3}});
    facets_.push_back({.corners = {a, c, d}, .across = {0, 2, 1}});
    std::vector<std::uint32_t> all(points.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    distribute(all, 0);
    // Grows while it runs.
    for (std::size_t i = 0; i < facets_.size(); ++i) {
      while (!facets_[i].removed && !facets_[i].above.empty()) add(farthest(facets_[i]), static_cast<std::uint32_t>(i));
    }
  }

  std::vector<Triangle> triangles() const {
    std::vector<Triangle> list;
    for (const Facet& facet : facets_) {
      if (!facet.removed) list.push_back(facet.corners);
    }
    return list;
  }

 private:
  /// Six times the volume over a facet; positive exactly for points strictly above its plane, 0 or below for others.
  double height(const Facet& facet, std::uint32_t point) const {
    const auto& [a, b, c] = facet.corners;
    const auto f = detail::orient3d_filter(points_[a], points_[b], points_[c], points_[point]);
    if (std::abs(f.value) > f.bound) return f.value;
    return detail::orient3d_exact_sign(points_[a], points_[b], points_[c], points_[point]) *
           std::numeric_limits<double>::min();
  }

  std::uint32_t farthest(const Facet& facet) const {
    std::uint32_t best = facet.above.front();
    double most = 0.0;
    for (const std::uint32_t point : facet.above) {
      const double h = height(facet, point);
      if (!(h > most)) continue;
      most = h;
      best = point;
    }
    return best;
  }

  /// Gives each point to the first facet from `first` on that it is above, if there is one.
  void distribute(std::span<const std::uint32_t> points, std::size_t first) {
    for (const std::uint32_t point : points) {
      for (std::size_t i = first; i < facets_.size(); ++i) {
        if (!(height(facets_[i], point) > 0.0)) continue;
        facets_[i].above.push_back(point);
        break;
      }
    }
  }

  /// Puts cones over the horizon in the place of all facets that the point is above. @param first one of these
  void add(std::uint32_t point, std::uint32_t first) {
    const std::vector<HorizonEdge> horizon = remove_seen(point, first);
    const std::size_t begin = facets_.size();
    for (const auto& [from, to, behind] : horizon) {
      const auto number = static_cast<std::uint32_t>(facets_.size());
      facets_.push_back({.corners = {from, to, point}, .across = {behind, 0, 0}});
      facet_from_[from] = number;
      Facet& other = facets_[behind];
      for (std::size_t i = 0; i < 3; ++i) {
        if (other.corners[i] == to && other.corners[(i + 1) % 3] == from) other.across[i] = number;
      }
    }
    // The horizon is a simple cycle: one edge begins at each of its corners.
    for (std::size_t i = begin; i < facets_.size(); ++i) {
      const std::uint32_t next = facet_from_[facets_[i].corners[1]];
      facets_[i].across[1] = next;
      facets_[next].across[2] = static_cast<std::uint32_t>(i);
    }
    distribute(orphans_, begin);
  }

  /// Removes the facets that the point is above, which are connected; their points become orphans_.
  std::vector<HorizonEdge> remove_seen(std::uint32_t point, std::uint32_t first) {
    orphans_.clear();
    std::vector<HorizonEdge> horizon;
    std::vector<std::uint32_t> open{first};
    facets_[first].removed = true;
    while (!open.empty()) {
      Facet& facet = facets_[open.back()];
      open.pop_back();
      for (const std::uint32_t other : facet.above) {
        if (other != point) orphans_.push_back(other);
      }
      facet.above = {};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t behind = facet.across[i];
        if (facets_[behind].removed) continue;
        if (height(facets_[behind], point) > 0.0) {
          facets_[behind].removed = true;
          open.push_back(behind);
        } else {
          horizon.push_back({facet.corners[i], facet.corners[(i + 1) % 3], behind});
        }
      }
    }
    return horizon;
  }

  const Points& points_;
  std::vector<Facet> facets_;
  std::vector<std::uint32_t> facet_from_;  ///< By corner: the new facet whose edge 0 begins there.
  std::vector<std::uint32_t> orphans_;
};

/// The index of the point with the greatest value.
template <class Value>
std::uint32_t greatest(const Points& points, Value value) {
  std::size_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double v = value(points[i]);
    if (!(v > most)) continue;
    most = v;
    best = i;
  }
  return static_cast<std::uint32_t>(best);
}

/// Four points that span a volume, large where the body is; the last below the plane of the others.
std::array<std::uint32_t, 4> tetrahedron_of(const Mesh& mesh) {
  const Points& points = mesh.vertices();
  const std::uint32_t a = greatest(points, [](const Eigen::Vector3d& p) { return p.x(); });
  std::uint32_t b = greatest(points, [&](const Eigen::Vector3d& p) { return (p - points[a]).squaredNorm(); });
  std::uint32_t c = greatest(
      points, [&](const Eigen::Vector3d& p) { return (points[b] - points[a]).cross(p - points[a]).squaredNorm(); });
  const std::uint32_t d = greatest(
      points, [&](const Eigen::Vector3d& p) { return std::abs(orient3d_value(points[a], points[b], points[c], p)); });
  const int side = orient3d(points[a], points[b], points[c], points[d]);
  if (side == 0) throw BadMesh(mesh.name() + ": no convex hull: the vertices lie in a plane");
  if (side > 0) std::swap(b, c);
  return {a, b, c, d};
}

}  // namespace

Mesh convex_hull(const Mesh& mesh) {
  const Hull hull(mesh.vertices(), tetrahedron_of(mesh));
  return Mesh::build(mesh.vertices(), hull.triangles(), mesh.name() + " (convex hull)");
}

}  // namespace sixdof
