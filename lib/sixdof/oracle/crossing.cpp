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

/// Both triangles, with the heights of each one's corners above the other's plane.
struct Heights {
  const OrderedTriangle& a;
  const OrderedTriangle& b;
  std::array<double, 3> of_a, of_b;

  /// Where a side pierces the other triangle's plane; sides 3, 4, 5 are those of b.
  Eigen::Vector3d point(int side) const {
    const OrderedTriangle& edge = side < 3 ? a : b;
    const std::array<double, 3>& height = side < 3 ? of_a : of_b;
    const auto low = static_cast<std::size_t>(edge.low(side % 3));
    const auto high = static_cast<std::size_t>(edge.high(side % 3));
    const Eigen::Vector3d& p = edge.corner[low];
    const Eigen::Vector3d& q = edge.corner[high];
    const double at_p = height[low], at_q = height[high];
    // From the nearer end, so that an end on the plane is met exactly.
    if (std::abs(at_p) <= std::abs(at_q)) return p + (at_p / (at_p - at_q)) * (q - p);
    return q + (at_q / (at_q - at_p)) * (p - q);
  }

  Segment segment(int start_side, int end_side) const {
    return {point(start_side), point(end_side), start_side, end_side};
  }
};

/// One of the triangles is degenerate (collinear corners): only the other can be pierced, by two sides at one point.
std::optional<Segment> cross_degenerate(const Heights& heights, const PlaneCrossing& in_a, const PlaneCrossing& in_b) {
  if (in_a.none() == in_b.none()) return std::nullopt;
  for (int k = 0; k < 3; ++k) {
    const int pass =
        in_b.none() ? passing(heights.a, in_a.down, heights.b, k) : passing(heights.a, k, heights.b, in_b.down);
    if (pass != -1) return std::nullopt;
  }
  return in_b.none() ? heights.segment(in_a.up, in_a.down) : heights.segment(3 + in_b.down, 3 + in_b.up);
}

}  // namespace

std::optional<Segment> cross(const OrderedTriangle& a, const OrderedTriangle& b) {
  Heights heights{a, b, {}, {}};
  std::array<int, 3> side_of_a, side_of_b;
  const ComparedPlane plane_b(b.corner[0], b.corner[1], b.corner[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    const ComparedPlane::Height h = plane_b.height(a.corner[i]);
    side_of_a[i] = h.sign != 0 ? h.sign : side_of_moved_plane(b.corner[0], b.corner[1], b.corner[2], a.corner[i]);
    heights.of_a[i] = h.value;
  }
  if (side_of_a[0] != 0 && same(side_of_a)) return std::nullopt;
  const ComparedPlane plane_a(a.corner[0], a.corner[1], a.corner[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    const ComparedPlane::Height h = plane_a.height(b.corner[i]);
    side_of_b[i] = h.sign != 0 ? h.sign : side_of_moved_point(a.corner[0], a.corner[1], a.corner[2], b.corner[i]);
    heights.of_b[i] = h.value;
  }
  if (side_of_b[0] != 0 && same(side_of_b)) return std::nullopt;
  const PlaneCrossing in_a(side_of_a);
  const PlaneCrossing in_b(side_of_b);
  if (in_a.none() || in_b.none()) return cross_degenerate(heights, in_a, in_b);

  // Both triangles meet the line of intersection of their planes, in intervals [a.up, a.down] and [b.down, b.up] along
  // (normal of a) x (normal of b). How two sides pass each other says which of their points comes first.
  if (passing(a, in_a.up, b, in_b.up) < 0 || passing(a, in_a.down, b, in_b.down) > 0) return std::nullopt;
  const bool starts_on_a = passing(a, in_a.up, b, in_b.down) > 0;
  const bool ends_on_a = passing(a, in_a.down, b, in_b.up) < 0;
  return heights.segment(starts_on_a ? in_a.up : 3 + in_b.down, ends_on_a ? in_a.down : 3 + in_b.up);
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
