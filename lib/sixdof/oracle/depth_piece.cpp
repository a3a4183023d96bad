#include <sixdof/oracle/depth_piece.h>

#include <algorithm>
#include <cmath>

namespace sixdof::detail {
namespace {

/// Of an error with the square of the size: that of the quarters' sum, from its difference to the whole.
constexpr double k_of_difference = 1.0 / 3.0;

/// Part of what a Lipschitz constant of 1 allows that is counted where A's surface may pass through a piece.
constexpr double k_of_bound = 0.1;

/// The whole triangle, all inside.
DepthSums integrate_inside(const DepthValue& a, const DepthValue& b, const DepthValue& c, double area) {
  const Eigen::Vector3d f = a.f + b.f + c.f;
  const Eigen::Vector3d r = a.r + b.r + c.r;
  // Integral of x y over a triangle of linear x and y: area / 12 * (sum of x_i y_i + sum of x * sum of y).
  const Eigen::Vector3d moments = a.r.cross(a.f) + b.r.cross(b.f) + c.r.cross(c.f) + r.cross(f);
  return {area / 3.0 * f, area / 12.0 * moments, -area / 3.0 * (a.s + b.s + c.s), area};
}

/// Where the signed distance is 0 between two values of opposite sign.
DepthValue cut(const DepthValue& a, const DepthValue& b, double t) {
  return {a.r + t * (b.r - a.r), a.f + t * (b.f - a.f), 0.0};
}

}  // namespace

DepthSums integrate_linear(const std::array<DepthValue, 3>& corners, double area) {
  const auto is_inside = [&](std::size_t k) { return corners[k].s < 0.0; };
  const int inside = is_inside(0) + is_inside(1) + is_inside(2);
  if (inside == 0) return {};
  if (inside == 3) return integrate_inside(corners[0], corners[1], corners[2], area);
  // The corner that is alone on its side, and the two others.
  std::size_t k = 0;
  while (is_inside(k) != (inside == 1)) ++k;
  const DepthValue &a = corners[k], &b = corners[(k + 1) % 3], &c = corners[(k + 2) % 3];
  const double t_b = a.s / (a.s - b.s), t_c = a.s / (a.s - c.s);
  const DepthValue ab = cut(a, b, t_b), ac = cut(a, c, t_c);
  if (inside == 1) return integrate_inside(a, ab, ac, area * t_b * t_c);
  DepthSums sums = integrate_inside(ab, b, c, area * (1.0 - t_b));
  return sums += integrate_inside(ab, c, ac, area * t_b * (1.0 - t_c));
}

void integrate_piece(DepthPiece& piece, const std::array<const DepthNode*, 6>& nodes, const DepthLaw& law, double area,
                     const Eigen::Vector3d& normal) {
  double nearest = std::abs(nodes[0]->s);
  int inside = 0;
  for (const DepthNode* node : nodes) {
    nearest = std::min(nearest, std::abs(node->s));
    inside += node->s < 0.0;
  }
  // The quarters' sides are half as long.
  const double reach = 0.5 * k_reach_of_corners * piece.longest;
  const bool crossed = nearest <= reach || (inside > 0 && inside < 6);
  piece.outside = !crossed && inside == 0;
  if (piece.outside) return;

  std::array<DepthValue, 6> v;
  for (std::size_t k = 0; k < 6; ++k) v[k] = law.at(*nodes[k], normal);
  const DepthSums whole = integrate_linear({v[0], v[1], v[2]}, area);
  DepthSums quarters = integrate_linear({v[0], v[3], v[5]}, 0.25 * area);
  quarters += integrate_linear({v[3], v[1], v[4]}, 0.25 * area);
  quarters += integrate_linear({v[5], v[4], v[2]}, 0.25 * area);
  quarters += integrate_linear({v[3], v[4], v[5]}, 0.25 * area);
  const DepthSums difference = quarters.plus(whole, -1.0);
  piece.sums = crossed ? quarters : quarters.plus(difference, k_of_difference);
  piece.force_error = k_of_difference * difference.force.norm();
  piece.torque_error = k_of_difference * difference.torque.norm();
  if (!crossed) return;
  const double lever = std::max({v[0].r.norm(), v[1].r.norm(), v[2].r.norm()});
  const double bound = k_of_bound * area * std::max(0.0, reach - nearest);
  piece.force_error = std::max(piece.force_error, bound);
  piece.torque_error = std::max(piece.torque_error, bound * lever);
}

}  // namespace sixdof::detail
