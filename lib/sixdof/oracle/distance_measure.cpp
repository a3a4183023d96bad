#include <sixdof/oracle/distance_search.h>

#include <algorithm>

#include <sixdof/oracle/winding.h>

namespace sixdof::detail {

Eigen::Vector3d transform_point_of_b(const Pose& X_AB, const Eigen::Vector3d& p) { return X_AB * p; }

TriangleCorners corners_of_b(const DistanceSearch& search, std::uint32_t triangle) {
  const Tree::Corners& corners = search.b.tree.corners()[triangle];
  return {transform_point_of_b(search.X_AB, corners[0]), transform_point_of_b(search.X_AB, corners[1]),
          transform_point_of_b(search.X_AB, corners[2])};
}

ClosestPoints distance_of(const DistanceSearch& search, TrianglePair pair) {
  return triangle_triangle_distance(search.a.tree.corners()[pair.a], corners_of_b(search, pair.b));
}

double gap_of(const DistanceSearch& search, TrianglePair pair) {
  return triangle_gap(search.a.tree.corners()[pair.a], corners_of_b(search, pair.b));
}

bool intersects(const DistanceSearch& search, TrianglePair pair) {
  return triangles_intersect(search.a.tree.corners()[pair.a], corners_of_b(search, pair.b));
}

bool try_update(DistanceSearch& search, TrianglePair pair, double distance) {
  if (distance > search.best + search.ties.width) return false;
  search.measured.push_back({pair, distance});
  if (distance > search.best || (search.found && distance == search.best)) return false;
  const bool closer = distance < search.best;
  search.best = distance;
  search.found = true;
  search.pair = pair;
  search.closest.reset();
  return closer;
}

bool try_update(DistanceSearch& search, TrianglePair pair) {
  const ClosestPoints closest = distance_of(search, pair);
  if (!try_update(search, pair, closest.distance)) return false;
  search.closest = closest;
  search.direction = closest.on_b - closest.on_a;
  return true;
}

bool has_corner_inside(DistanceSearch& search, TrianglePair pair, std::size_t turn) {
  const DistanceBody &a = search.a, &b = search.b;
  const auto is_in_a = [&](const Eigen::Vector3d& p) { return winding_of_a(a.tree, p, search.triangles) > 0; };
  const auto is_in_b = [&](const Eigen::Vector3d& p) {
    return winding_of_b(b.tree, search.X_AB, transform_point_of_b, p, search.triangles) > 0;
  };
  const auto is_inside = [&](TrianglePair x) {
    const TriangleCorners of_b = corners_of_b(search, x.b);
    const Tree::Corners& of_a = a.tree.corners()[x.a];
    return std::any_of(of_b.begin(), of_b.end(), is_in_a) || std::any_of(of_a.begin(), of_a.end(), is_in_b);
  };
  if (is_inside(pair)) return true;
  constexpr std::size_t k_seeds = 4;
  for (std::size_t i = k_seeds * turn; i < k_seeds * (turn + 1); ++i) {
    const auto seed = [&](const DistanceBody& body) {
      return body.tree.leaves()[body.seeds.leaf[i % SeedCorners::k_count]].child.first();
    };
    if (is_inside({seed(a), seed(b)})) return true;
  }
  return false;
}

const ClosestPoints& points_of(DistanceSearch& search) {
  if (!search.closest) search.closest = distance_of(search, search.pair);
  return *search.closest;
}

float smallest_leaf_of(const Tree& tree) {
  float smallest = std::numeric_limits<float>::infinity();
  for (const Tree::Leaf& leaf : tree.leaves()) {
    smallest = std::min(smallest, leaf.volume.squared_diagonal());
  }
  return smallest;
}

}  // namespace sixdof::detail
