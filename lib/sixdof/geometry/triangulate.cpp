#include <sixdof/geometry/triangulate.h>

#include <cmath>

#include <sixdof/geometry/predicates.h>

namespace sixdof {
namespace {

using Points = std::vector<Eigen::Vector2d>;

struct Projection {
  Points points;          ///< Empty if the polygon has no area.
  bool flat = true;       ///< Within k_flatness.
  bool crossing = false;  ///< Parts of the polygon have opposite areas that add up to zero.
};

/// Area below which a polygon's normal is not known to k_flatness, and above the rounding of a zero area, for
/// coordinates scaled to magnitude 1.
constexpr double k_least_area = 1e-9;

/// The polygon projected against its Newell normal, along the coordinate axis nearest to it.
Projection project(std::span<const std::uint32_t> corners, const std::vector<Eigen::Vector3d>& vertices) {
  const std::size_t n = corners.size();
  double largest = 0.0;
  for (const std::uint32_t c : corners) largest = std::max(largest, vertices[c].cwiseAbs().maxCoeff());
  if (largest == 0.0) return {};
  // Scaling by a power of two is exact and keeps products of lengths from underflow and overflow.
  const int exponent = -std::ilogb(largest);
  std::vector<Eigen::Vector3d> scaled(n);
  for (std::size_t i = 0; i < n; ++i) {
    scaled[i] = vertices[corners[i]].unaryExpr([exponent](double x) { return std::ldexp(x, exponent); });
  }
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double largest_part = 0.0;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Eigen::Vector3d part = (scaled[i] - scaled[0]).cross(scaled[i + 1] - scaled[0]);
    normal += part;
    largest_part = std::max(largest_part, part.norm());
  }
  Eigen::Index axis = 0;
  if (normal.cwiseAbs().maxCoeff(&axis) == 0.0) return {.points = {}, .crossing = largest_part > k_least_area};
  const bool towards = normal[axis] > 0.0;
  const Eigen::Index u = (axis + (towards ? 1 : 2)) % 3;
  const Eigen::Index v = (axis + (towards ? 2 : 1)) % 3;
  Projection result{.points = Points(n)};
  for (std::size_t i = 0; i < n; ++i) result.points[i] = {scaled[i][u], scaled[i][v]};
  if (normal.norm() > k_least_area) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : scaled) mean += p / static_cast<double>(n);
    const double tolerance = k_flatness * std::ldexp(largest, exponent) * normal.norm();
    for (const Eigen::Vector3d& p : scaled) {
      if (std::abs((p - mean).dot(normal)) > tolerance) result.flat = false;
    }
  }
  return result;
}

bool strictly_convex(const Points& p) {
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!(orient2d(p[i], p[(i + 1) % n], p[(i + 2) % n]) > 0)) return false;
  }
  // A star turns left everywhere as well, but its fan folds.
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (!(orient2d(p[0], p[i], p[i + 1]) > 0)) return false;
  }
  return true;
}

/// Clips ears off a ring of corners. Whether a corner is an ear is stored, and updated only for the neighbours of a
/// clipped corner.
class EarClipper {
 public:
  explicit EarClipper(const Points& points) : p_(points), left_(points.size()) {
    const std::size_t n = points.size();
    before_.resize(n);
    after_.resize(n);
    ear_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      before_[i] = (i + n - 1) % n;
      after_[i] = (i + 1) % n;
    }
    find_ears(0);
  }

  /// Appends the corner numbers of the n - 2 triangles; false if the polygon crosses itself.
  bool clip(std::vector<std::array<std::size_t, 3>>& triangles) {
    bool crosses = false;
    std::size_t at = 0;
    while (left_ > 3) {
      if (!next_ear(at) && !crosses) {
        find_ears(at);
        crosses = !next_ear(at) && !next_flat(at);
      }
      triangles.push_back({before_[at], at, after_[at]});
      const std::size_t previous = before_[at];
      const std::size_t following = after_[at];
      after_[previous] = following;
      before_[following] = previous;
      --left_;
      ear_[previous] = is_ear(previous);
      ear_[following] = is_ear(following);
      at = following;
    }
    triangles.push_back({before_[at], at, after_[at]});
    return !crosses && orient2d(p_[before_[at]], p_[at], p_[after_[at]]) >= 0;
  }

 private:
  void find_ears(std::size_t from) {
    for (std::size_t i = 0, at = from; i < left_; ++i, at = after_[at]) ear_[at] = is_ear(at);
  }

  bool next_ear(std::size_t& at) const {
    for (std::size_t i = 0; i < left_; ++i, at = after_[at]) {
      if (ear_[at]) return true;
    }
    return false;
  }

  /// A corner on a straight line or one that repeats its neighbour: a triangle without area.
  bool next_flat(std::size_t& at) const {
    for (std::size_t i = 0; i < left_; ++i, at = after_[at]) {
      if (orient2d(p_[before_[at]], p_[at], p_[after_[at]]) == 0) return true;
    }
    return false;
  }

  bool is_ear(std::size_t at) const {
    const auto& a = p_[before_[at]];
    const auto& b = p_[at];
    const auto& c = p_[after_[at]];
    if (!(orient2d(a, b, c) > 0)) return false;
    for (std::size_t i = after_[after_[at]]; i != before_[at]; i = after_[i]) {
      const auto& q = p_[i];
      if (q == a || q == b || q == c) continue;
      if (orient2d(a, b, q) >= 0 && orient2d(b, c, q) >= 0 && orient2d(c, a, q) >= 0) return false;
    }
    return true;
  }

  const Points& p_;
  std::size_t left_;
  std::vector<std::size_t> before_, after_;
  std::vector<bool> ear_;
};

}  // namespace

PolygonShape triangulate(std::span<const std::uint32_t> corners, const std::vector<Eigen::Vector3d>& vertices,
                         std::vector<Triangle>& triangles) {
  const auto add_fan = [&] {
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      triangles.push_back({corners[0], corners[i], corners[i + 1]});
    }
  };
  if (corners.size() == 3) {
    add_fan();
    return PolygonShape::simple;
  }
  const Projection polygon = project(corners, vertices);
  bool crossing = polygon.crossing;
  if (polygon.points.empty() || strictly_convex(polygon.points)) {
    add_fan();
  } else {
    if (corners.size() > k_most_corners_of_a_concave_polygon) return PolygonShape::too_large;
    std::vector<std::array<std::size_t, 3>> ears;
    crossing = !EarClipper(polygon.points).clip(ears);
    for (const auto& [a, b, c] : ears) triangles.push_back({corners[a], corners[b], corners[c]});
  }
  if (crossing) return PolygonShape::crossing;
  return polygon.flat ? PolygonShape::simple : PolygonShape::not_flat;
}

}  // namespace sixdof
