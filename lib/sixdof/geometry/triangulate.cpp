#include <sixdof/geometry/triangulate.h>

#include <cmath>

#include <fmt/format.h>

#include <sixdof/geometry/predicates.h>

namespace sixdof {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// The polygon seen against its Newell normal, along the coordinate axis nearest to it; empty if it has no area.
Points project(std::span<const std::uint32_t> corners, const std::vector<Eigen::Vector3d>& vertices) {
  const std::size_t n = corners.size();
  double largest = 0.0;
  for (const std::uint32_t c : corners) largest = std::max(largest, vertices[c].cwiseAbs().maxCoeff());
  if (largest == 0.0) return {};
  // Scaled by a power of two, which is exact, or products of tiny lengths would vanish and of huge ones overflow.
  const int exponent = -std::ilogb(largest);
  std::vector<Eigen::Vector3d> scaled(n);
  for (std::size_t i = 0; i < n; ++i) {
    scaled[i] = vertices[corners[i]].unaryExpr([exponent](double x) { return std::ldexp(x, exponent); });
  }
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < n; ++i) normal += (scaled[i] - scaled[0]).cross(scaled[i + 1] - scaled[0]);
  Eigen::Index axis = 0;
  if (normal.cwiseAbs().maxCoeff(&axis) == 0.0) return {};
  const bool towards = normal[axis] > 0.0;
  const Eigen::Index u = (axis + (towards ? 1 : 2)) % 3;
  const Eigen::Index v = (axis + (towards ? 2 : 1)) % 3;
  Points points(n);
  for (std::size_t i = 0; i < n; ++i) points[i] = {scaled[i][u], scaled[i][v]};
  return points;
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

/// Cuts ears off a ring of corners. Whether a corner is an ear is kept, and found anew only for the neighbours of a
/// cut.
class EarCutter {
 public:
  explicit EarCutter(const Points& points) : p_(points), left_(points.size()) {
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

  /// Corner numbers of the triangles; false if the polygon crosses itself.
  bool cut(std::vector<std::array<std::size_t, 3>>& triangles) {
    std::size_t at = 0;
    while (left_ > 3) {
      if (!next_ear(at)) {
        find_ears(at);
        if (!next_ear(at) && !next_flat(at)) return false;
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
    if (orient2d(p_[before_[at]], p_[at], p_[after_[at]]) < 0) return false;
    triangles.push_back({before_[at], at, after_[at]});
    return true;
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

  /// What is left may be corners on a line, or a corner that repeats its neighbour: triangles without area.
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

std::string triangulate(std::span<const std::uint32_t> corners, const std::vector<Eigen::Vector3d>& vertices,
                        std::vector<Triangle>& triangles) {
  const auto fan = [&] {
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      triangles.push_back({corners[0], corners[i], corners[i + 1]});
    }
    return std::string();
  };
  if (corners.size() == 3) return fan();
  const Points points = project(corners, vertices);
  if (points.empty() || strictly_convex(points)) return fan();
  if (corners.size() > k_most_corners_of_a_concave_polygon) {
    return fmt::format("a concave polygon of {} corners, more than the {} this can triangulate", corners.size(),
                       k_most_corners_of_a_concave_polygon);
  }
  std::vector<std::array<std::size_t, 3>> ears;
  if (!EarCutter(points).cut(ears)) return fmt::format("a polygon of {} corners that crosses itself", corners.size());
  for (const auto& [a, b, c] : ears) triangles.push_back({corners[a], corners[b], corners[c]});
  return {};
}

}  // namespace sixdof
