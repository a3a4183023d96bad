#include <sixdof/oracle/crossing.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <sixdof/geometry/predicates.h>

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
int passing(const TriangleCorners& a, int i, const TriangleCorners& b, int j) {
  const auto at = [](const TriangleCorners& t, int k) -> const Eigen::Vector3d& {
    return t[static_cast<std::size_t>(k % 3)];
  };
  return side_of_perturbed_edge(at(a, i), at(a, i + 1), at(b, j), at(b, j + 1));
}

/// The corners of a triangle and the plane of another.
class PlaneSides {
 public:
  /// Keeps references to both.
  /// @param tie multiplies detail::lexicographic_cross() of the plane's sides: the side on which a corner in the plane
  /// lies, 1 if the plane is A's, -1 if it is B's
  PlaneSides(const TriangleCorners& triangle, const TriangleCorners& plane, int tie)
      : triangle_(triangle), other_(plane), plane_(plane[0], plane[1], plane[2]), tie_(tie) {
    for (std::size_t i = 0; i < 3; ++i) {
      filtered_[i] = plane_.filter(triangle[i]);
      is_clear_ = is_clear_ && std::abs(filtered_[i].value) > filtered_[i].bound;
    }
  }

  /// Whether floating point decides all signs.
  bool is_clear() const { return is_clear_; }

  /// Each corner's side of the plane: 1 in front, -1 behind; all 0 if the plane's corners are collinear.
  std::array<int, 3> signs() const {
    if (is_clear_) return {clear_sign(0), clear_sign(1), clear_sign(2)};
    std::array<int, 3> sign;
    for (std::size_t i = 0; i < 3; ++i) sign[i] = plane_.sign(triangle_[i], filtered_[i]);
    if (std::find(sign.begin(), sign.end(), 0) == sign.end()) return sign;
    const auto& [p, q, r] = other_;
    const int in_plane = tie_ * detail::lexicographic_cross(p, q, p, r);
    std::replace(sign.begin(), sign.end(), 0, in_plane);
    return sign;
  }

  /// Proportional to a corner's signed distance from the plane.
  double distance(std::size_t corner) const { return plane_.value(triangle_[corner], filtered_[corner]); }

 private:
  int clear_sign(std::size_t corner) const { return filtered_[corner].value > 0.0 ? 1 : -1; }

  const TriangleCorners& triangle_;
  const TriangleCorners& other_;
  TrianglePlane plane_;
  int tie_;
  std::array<detail::Filtered, 3> filtered_;
  bool is_clear_ = true;
};

/// Both triangles, each with the other's plane.
struct PlaneDistances {
  const TriangleCorners& a;
  const TriangleCorners& b;
  const PlaneSides &of_a, &of_b;

  /// Where a side pierces the other triangle's plane; sides 3, 4, 5 are those of b.
  Eigen::Vector3d point(int side) const {
    const TriangleCorners& edge = side < 3 ? a : b;
    const PlaneSides& sides = side < 3 ? of_a : of_b;
    const auto from = static_cast<std::size_t>(side % 3);
    const std::size_t to = (from + 1) % 3;
    const Eigen::Vector3d& p = edge[from];
    const Eigen::Vector3d& q = edge[to];
    const double at_p = sides.distance(from), at_q = sides.distance(to);
    // From the nearer end: if an end lies on the plane, it is the point. If both are as near, from the one in front:
    // the triangle across the edge gets the same point.
    if (std::abs(at_p) < std::abs(at_q) || (std::abs(at_p) == std::abs(at_q) && at_p > at_q)) {
      return p + (at_p / (at_p - at_q)) * (q - p);
    }
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

bool certainly_apart(const TriangleCorners& a, const TriangleCorners& b) {
  const auto edge_separates = [](const TriangleCorners& t, const TriangleCorners& other) {
    const auto& c = t;
    const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d& from = c[i];
      const Eigen::Vector3d edge = c[(i + 1) % 3] - from;
      const Eigen::Vector3d outwards = edge.cross(normal);
      double highest = std::max({0.0, outwards.dot(edge), outwards.dot(c[(i + 2) % 3] - from)});
      double lowest = std::numeric_limits<double>::infinity();
      double size = edge.cwiseAbs().sum() + (c[(i + 2) % 3] - from).cwiseAbs().sum();
      for (const Eigen::Vector3d& p : other) {
        lowest = std::min(lowest, outwards.dot(p - from));
        size = std::max(size, (p - from).cwiseAbs().sum());
      }
      if (lowest - highest >
          detail::k_projection_rounding * size * outwards.cwiseAbs().sum() + detail::k_underflow_bound) {
        return true;
      }
    }
    return false;
  };
  return edge_separates(a, b) || edge_separates(b, a);
}

std::optional<Segment> cross(const TriangleCorners& a, const TriangleCorners& b) {
  const auto on_one_side = [](const std::array<int, 3>& sign) {
    return sign[0] != 0 && sign[0] == sign[1] && sign[1] == sign[2];
  };
  const PlaneSides sides_of_a(a, b, -1);
  if (!sides_of_a.is_clear() && certainly_apart(a, b)) return std::nullopt;
  const std::array<int, 3> sign_of_a = sides_of_a.signs();
  if (on_one_side(sign_of_a)) return std::nullopt;
  const PlaneSides sides_of_b(b, a, 1);
  if (sides_of_a.is_clear() && !sides_of_b.is_clear() && certainly_apart(a, b)) return std::nullopt;
  const std::array<int, 3> sign_of_b = sides_of_b.signs();
  if (on_one_side(sign_of_b)) return std::nullopt;
  const PlaneDistances distances{a, b, sides_of_a, sides_of_b};
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
