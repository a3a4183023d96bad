#include <sixdof/oracle/crossing.h>

#include <cmath>

namespace sixdof {
namespace {

/// The sides of a triangle that cross a plane: `down` from its front to its back, `up` from its back to its front. Both
/// exist or none does.
struct PlaneCrossing {
  int down = -1, up = -1;

  /// @param sign of each corner: 1 in front of the plane, -1 behind it
  explicit PlaneCrossing(const std::array<int, 3>& sign) {
    for (int i = 0; i < 3; ++i) {
      const int from = sign[static_cast<std::size_t>(i)];
      const int to = sign[static_cast<std::size_t>((i + 1) % 3)];
      if (from > to) down = i;
      if (from < to) up = i;
    }
  }
  bool none() const { return down < 0; }
};

/// On which side the line of side i of `a` passes that of side j of `b`: side_of_perturbed_edge().
int passing(const OrderedTriangle& a, int i, const OrderedTriangle& b, int j) {
  const auto at = [](const OrderedTriangle& t, int k) -> const Eigen::Vector3d& {
    return t.corner[static_cast<std::size_t>(k % 3)];
  };
  return side_of_perturbed_edge(at(a, i), at(a, i + 1), at(b, j), at(b, j + 1));
}

/// Both triangles, with orient3d() of each one's corners and the other triangle: proportional to the corner's signed
/// distance from the other's plane.
struct PlaneDistances {
  const OrderedTriangle& a;
  const OrderedTriangle& b;
  std::array<double, 3> of_a, of_b;

  /// Where a side pierces the other triangle's plane; sides 3, 4, 5 are those of b.
  Eigen::Vector3d point(int side) const {
    const OrderedTriangle& edge = side < 3 ? a : b;
    const std::array<double, 3>& distance = side < 3 ? of_a : of_b;
    const auto low = static_cast<std::size_t>(edge.low(side % 3));
    const auto high = static_cast<std::size_t>(edge.high(side % 3));
    const Eigen::Vector3d& p = edge.corner[low];
    const Eigen::Vector3d& q = edge.corner[high];
    const double at_p = distance[low], at_q = distance[high];
    // From the nearer end: if an end lies on the plane, it is the point.
    if (std::abs(at_p) <= std::abs(at_q)) return p + (at_p / (at_p - at_q)) * (q - p);
    return q + (at_q / (at_q - at_p)) * (p - q);
  }

  Segment segment(int start_side, int end_side) const {
    return {point(start_side), point(end_side), start_side, end_side};
  }
};

/// For a triangle with collinear corners: only the other triangle can be pierced, by two sides at one point.
std::optional<Segment> cross_degenerate(const PlaneDistances& distances, const PlaneCrossing& in_a,
                                        const PlaneCrossing& in_b) {
  if (in_a.none() == in_b.none()) return std::nullopt;
  for (int k = 0; k < 3; ++k) {
    const int pass =
        in_b.none() ? passing(distances.a, in_a.down, distances.b, k) : passing(distances.a, k, distances.b, in_b.down);
    if (pass != -1) return std::nullopt;
  }
  return in_b.none() ? distances.segment(in_a.up, in_a.down) : distances.segment(3 + in_b.down, 3 + in_b.up);
}

}  // namespace

std::optional<Segment> cross(const OrderedTriangle& a, const OrderedTriangle& b) {
  PlaneDistances distances{a, b, {}, {}};
  // The sides on which corners lie of the other triangle's plane; false if all lie on one side.
  const auto crosses_plane = [](const OrderedTriangle& of, const OrderedTriangle& plane, auto perturbed,
                                std::array<int, 3>& sign, std::array<double, 3>& distance) {
    const auto& [p, q, r] = plane.corner;
    const TrianglePlane exact(p, q, r);
    for (std::size_t i = 0; i < 3; ++i) {
      const TrianglePlane::Orientation h = exact.orientation(of.corner[i]);
      sign[i] = h.sign != 0 ? h.sign : perturbed(p, q, r, of.corner[i]);
      distance[i] = h.value;
    }
    return sign[0] == 0 || sign[0] != sign[1] || sign[1] != sign[2];
  };
  std::array<int, 3> sign_of_a, sign_of_b;
  if (!crosses_plane(a, b, side_of_perturbed_plane, sign_of_a, distances.of_a)) return std::nullopt;
  if (!crosses_plane(b, a, side_of_perturbed_point, sign_of_b, distances.of_b)) return std::nullopt;
  const PlaneCrossing in_a(sign_of_a);
  const PlaneCrossing in_b(sign_of_b);
  if (in_a.none() || in_b.none()) return cross_degenerate(distances, in_a, in_b);

  // Both triangles meet the line of intersection of their planes, in intervals [a.up, a.down] and [b.down, b.up] along
  // (normal of a) x (normal of b). passing() of two sides orders their end points.
  if (passing(a, in_a.up, b, in_b.up) < 0 || passing(a, in_a.down, b, in_b.down) > 0) return std::nullopt;
  const bool starts_on_a = passing(a, in_a.up, b, in_b.down) > 0;
  const bool ends_on_a = passing(a, in_a.down, b, in_b.up) < 0;
  return distances.segment(starts_on_a ? in_a.up : 3 + in_b.down, ends_on_a ? in_a.down : 3 + in_b.up);
}

int pierce(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const std::array<Eigen::Vector3d, 3>& triangle,
           Perturbed perturbed) {
  const auto side = [&](const Eigen::Vector3d& point) {
    return perturbed == Perturbed::triangle ? side_of_perturbed_plane(triangle[0], triangle[1], triangle[2], point)
                                            : side_of_perturbed_point(triangle[0], triangle[1], triangle[2], point);
  };
  const int at_p = side(p);
  if (at_p == side(q)) return 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d &r = triangle[k], &s = triangle[(k + 1) % 3];
    // The determinant does not depend on the order of the edges.
    const int pass =
        perturbed == Perturbed::triangle ? side_of_perturbed_edge(p, q, r, s) : side_of_perturbed_edge(r, s, p, q);
    if (pass != -at_p) return 0;
  }
  return at_p;
}

}  // namespace sixdof
