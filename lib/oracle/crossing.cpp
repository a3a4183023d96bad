#include <sixdof/oracle/crossing.h>

#include <cmath>

namespace sixdof {
namespace {

/// Sides of a triangle that cross a plane, from the sides on which its corners lie: one from the front to the back, one
/// from the back to the front. Both exist or none does.
struct PlaneCrossing {
  int down = -1, up = -1;

  explicit PlaneCrossing(const std::array<int, 3>& at) {
    for (int i = 0; i < 3; ++i) {
      const int from = at[static_cast<std::size_t>(i)];
      const int to = at[static_cast<std::size_t>((i + 1) % 3)];
      if (from > to) down = i;
      if (from < to) up = i;
    }
  }
  bool none() const { return down < 0; }
};

bool same(const std::array<int, 3>& s) { return s[0] == s[1] && s[1] == s[2]; }

/// How side i of `a` passes side j of the moved `b`.
int passing(const OrderedTriangle& a, int i, const OrderedTriangle& b, int j) {
  const auto at = [](const OrderedTriangle& t, int k) -> const Eigen::Vector3d& {
    return t.corner[static_cast<std::size_t>(k % 3)];
  };
  return passing_of_moved_edge(at(a, i), at(a, i + 1), at(b, j), at(b, j + 1));
}

/// One of the triangles is degenerate (collinear corners): only the other can be pierced, by two sides at one point.
std::optional<Segment> cross_degenerate(const OrderedTriangle& a, const PlaneCrossing& in_a, const OrderedTriangle& b,
                                        const PlaneCrossing& in_b) {
  if (in_a.none() == in_b.none()) return std::nullopt;
  if (in_b.none()) {
    for (int j = 0; j < 3; ++j) {
      if (passing(a, in_a.down, b, j) != -1) return std::nullopt;
    }
    return Segment{piercing_point(a, in_a.up, b), piercing_point(a, in_a.down, b), in_a.up, in_a.down};
  }
  for (int i = 0; i < 3; ++i) {
    if (passing(a, i, b, in_b.down) != -1) return std::nullopt;
  }
  return Segment{piercing_point(b, in_b.down, a), piercing_point(b, in_b.up, a), 3 + in_b.down, 3 + in_b.up};
}

}  // namespace

Eigen::Vector3d piercing_point(const OrderedTriangle& edge, int side, const OrderedTriangle& plane) {
  const Eigen::Vector3d& p = edge.corner[static_cast<std::size_t>(edge.low(side))];
  const Eigen::Vector3d& q = edge.corner[static_cast<std::size_t>(edge.high(side))];
  const double at_p = orient3d_value(plane.corner[0], plane.corner[1], plane.corner[2], p);
  const double at_q = orient3d_value(plane.corner[0], plane.corner[1], plane.corner[2], q);
  // From the nearer end, so that an end on the plane is met exactly.
  if (std::abs(at_p) <= std::abs(at_q)) return p + (at_p / (at_p - at_q)) * (q - p);
  return q + (at_q / (at_q - at_p)) * (p - q);
}

std::optional<Segment> cross(const OrderedTriangle& a, const OrderedTriangle& b) {
  std::array<int, 3> side_of_a, side_of_b;
  for (std::size_t i = 0; i < 3; ++i)
    side_of_a[i] = side_of_moved_plane(b.corner[0], b.corner[1], b.corner[2], a.corner[i]);
  if (side_of_a[0] != 0 && same(side_of_a)) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i)
    side_of_b[i] = side_of_moved_point(a.corner[0], a.corner[1], a.corner[2], b.corner[i]);
  if (side_of_b[0] != 0 && same(side_of_b)) return std::nullopt;
  const PlaneCrossing in_a(side_of_a);
  const PlaneCrossing in_b(side_of_b);
  if (in_a.none() || in_b.none()) return cross_degenerate(a, in_a, b, in_b);

  // Both triangles meet the line of intersection of their planes, in intervals [a.up, a.down] and [b.down, b.up] along
  // (normal of a) x (normal of b). How two sides pass each other says which of their points comes first.
  if (passing(a, in_a.up, b, in_b.up) < 0 || passing(a, in_a.down, b, in_b.down) > 0) return std::nullopt;
  const bool starts_on_a = passing(a, in_a.up, b, in_b.down) > 0;
  const bool ends_on_a = passing(a, in_a.down, b, in_b.up) < 0;
  Segment s;
  s.start_side = starts_on_a ? in_a.up : 3 + in_b.down;
  s.end_side = ends_on_a ? in_a.down : 3 + in_b.up;
  s.start = starts_on_a ? piercing_point(a, in_a.up, b) : piercing_point(b, in_b.down, a);
  s.end = ends_on_a ? piercing_point(a, in_a.down, b) : piercing_point(b, in_b.up, a);
  return s;
}

int pierce_moved_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                          const std::array<Eigen::Vector3d, 3>& triangle) {
  const int at_p = side_of_moved_plane(triangle[0], triangle[1], triangle[2], p);
  const int at_q = side_of_moved_plane(triangle[0], triangle[1], triangle[2], q);
  if (at_p == at_q) return 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (passing_of_moved_edge(p, q, triangle[k], triangle[(k + 1) % 3]) != -at_p) return 0;
  }
  return at_p;
}

int moved_edge_pierces(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                       const std::array<Eigen::Vector3d, 3>& triangle) {
  const int at_p = side_of_moved_point(triangle[0], triangle[1], triangle[2], p);
  const int at_q = side_of_moved_point(triangle[0], triangle[1], triangle[2], q);
  if (at_p == at_q) return 0;
  for (std::size_t k = 0; k < 3; ++k) {
    // The determinant is the same whichever edge comes first.
    if (passing_of_moved_edge(triangle[k], triangle[(k + 1) % 3], p, q) != -at_p) return 0;
  }
  return at_p;
}

}  // namespace sixdof
