#include <sixdof/oracle/distance_search.h>

#include <Eigen/Geometry>

namespace sixdof::detail {
namespace {

TriangleCorners corners_of_b(const DistanceSearch& search, std::uint32_t triangle) {
  const Tree::Corners& corners = search.b->corners()[triangle];
  return {search.X_AB * corners[0], search.X_AB * corners[1], search.X_AB * corners[2]};
}

}  // namespace

TieWindow TieWindow::of(const Tree& a, const CoplanarPatches& patches_a, const Tree& b,
                        const CoplanarPatches& patches_b, const Pose& X_AB) {
  if (patches_a.empty() || patches_b.empty()) return {};
  // Relative to the radii: n . p of a plane's corners rounds by a dozen units in the last place at most; rotating a
  // normal and transforming a corner, by a dozen more; a triangle's distance by k_triangle_distance_error times its
  // size. Offsets from the origins enter by the transformed corners and the centres alone.
  const Eigen::Vector3d shift = X_AB * b.center() - a.center();
  const double error = 4e-15 * (a.radius() + b.radius() + shift.norm()) +
                       1.5e-15 * (a.center().norm() + b.center().norm() + X_AB.t.norm());
  // A bound between planes is lowered by the error and may be off by as much, so at a tie it comes within twice the
  // error of every distance. Distances of ties differ by less than the error.
  return {.error = error, .margin = 2.0 * error, .width = 3.0 * error};
}

Rank rank_of(const DistanceSearch& search, TrianglePair pair) {
  return {search.a->mesh_triangle()[pair.a], search.b->mesh_triangle()[pair.b]};
}

ClosestPoints distance_of(const DistanceSearch& search, TrianglePair pair) {
  return triangle_triangle_distance(search.a->corners()[pair.a], corners_of_b(search, pair.b));
}

double gap_of(const DistanceSearch& search, TrianglePair pair) {
  return triangle_gap(search.a->corners()[pair.a], corners_of_b(search, pair.b));
}

bool intersects(const DistanceSearch& search, TrianglePair pair) {
  return triangles_intersect(search.a->corners()[pair.a], corners_of_b(search, pair.b));
}

bool try_update(DistanceSearch& search, TrianglePair pair) {
  const ClosestPoints closest = distance_of(search, pair);
  if (closest.distance > search.best + search.ties.width) return false;
  search.measured.push_back({pair, closest.distance});
  if (closest.distance > search.best || (search.found && closest.distance == search.best)) return false;
  const bool closer = closest.distance < search.best;
  search.best = closest.distance;
  search.found = true;
  search.pair = pair;
  search.closest = closest;
  return closer;
}

SeedCorners::SeedCorners(const Tree& tree) {
  for (std::size_t i = 0; i < k_count; ++i) {
    leaf[i] = static_cast<std::uint32_t>((2 * i + 1) * tree.leaves().size() / (2 * k_count));
    for (std::size_t k = 0; k < 3; ++k) point[k][i] = tree.leaves()[leaf[i]].corner[0][k][0];
  }
}

}  // namespace sixdof::detail
