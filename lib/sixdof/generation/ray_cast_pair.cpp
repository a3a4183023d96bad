#include <sixdof/generation/ray_cast_pair.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

// Loops over pairs of edges and over corners are plain, without branches, so that the compiler treats two at once.
// Where edges are nearly parallel the place of the closest points along them is uncertain, but not the distance there:
// any two points of the edges that are used are points of the triangles.

namespace sixdof::ray_cast {
namespace {

using Eigen::Vector3d;

/// Triangles whose edges meet at a smaller sine than this are left to triangle_triangle_distance(): rounding would turn
/// the normal by more than 1e-10.
constexpr double k_least_sine = 1e-6;
/// Error of a corner's height over a face that its triangle may pierce, in units of the longest edge: ten times that.
constexpr double k_blur = 1e-9;

double inverse(double x) { return x > 0.0 ? 1.0 / x : 0.0; }
double clamp(double x) {
  x = x > 0.0 ? x : 0.0;
  return x < 1.0 ? x : 1.0;
}

}  // namespace

MovingPair::MovingPair(const TriangleCorners& a, const TriangleCorners& b, const Vector3d& direction)
    : a_(a), b_(b), direction_(direction) {
  const TriangleCorners edge_a{a[1] - a[0], a[2] - a[1], a[0] - a[2]};
  const TriangleCorners edge_b{b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  for (std::size_t n = 0; n < k_edges; ++n) {
    const std::size_t i = n < 9 ? n / 3 : 2;
    const std::size_t j = n % 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      from_[k][n] = b[j][axis] - a[i][axis];
      u_[k][n] = edge_a[i][axis];
      v_[k][n] = edge_b[j][axis];
    }
  }
  for (std::size_t n = 0; n < k_edges; ++n) {
    uu_[n] = u_[0][n] * u_[0][n] + u_[1][n] * u_[1][n] + u_[2][n] * u_[2][n];
    vv_[n] = v_[0][n] * v_[0][n] + v_[1][n] * v_[1][n] + v_[2][n] * v_[2][n];
    uv_[n] = u_[0][n] * v_[0][n] + u_[1][n] * v_[1][n] + u_[2][n] * v_[2][n];
    per_uu_[n] = inverse(uu_[n]);
    per_vv_[n] = inverse(vv_[n]);
    per_nn_[n] = inverse(uu_[n] * vv_[n] - uv_[n] * uv_[n]);
  }
  blur_ = k_blur * std::sqrt(std::max(*std::max_element(uu_, uu_ + k_edges), *std::max_element(vv_, vv_ + k_edges)));
  for (std::size_t n = 0; n < k_corners; ++n) {
    const bool of_a = n < 3;
    const TriangleCorners& face = of_a ? b : a;
    const Vector3d& corner = of_a ? a[n] : b[n - 3];
    const Vector3d first = face[1] - face[0];
    const Vector3d second = face[2] - face[0];
    const Vector3d normal = first.cross(second);
    const double length2 = normal.squaredNorm();
    thin_ = thin_ || length2 <= k_least_sine * k_least_sine * first.squaredNorm() * second.squaredNorm();
    const double per_length2 = inverse(length2);
    const Vector3d unit = normal * std::sqrt(per_length2);
    const Vector3d to_first = second.cross(normal) * per_length2;
    const Vector3d to_second = normal.cross(first) * per_length2;
    const Vector3d over = corner - face[0];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      over_[k][n] = over[axis];
      normal_[k][n] = unit[axis];
      first_[k][n] = to_first[axis];
      second_[k][n] = to_second[axis];
      drift_[k][n] = of_a ? -direction[axis] : direction[axis];
    }
  }
}

MovingPair::Sample MovingPair::at(double t) const {
  const double shift[3] = {t * direction_[0], t * direction_[1], t * direction_[2]};
  double squared[k_edges];
  double w[3][k_edges];
  for (std::size_t n = 0; n < k_edges; ++n) {
    const double x = from_[0][n] + shift[0];
    const double y = from_[1][n] + shift[1];
    const double z = from_[2][n] + shift[2];
    const double c = u_[0][n] * x + u_[1][n] * y + u_[2][n] * z;
    const double f = v_[0][n] * x + v_[1][n] * y + v_[2][n] * z;
    // Closest points of two lines, then of each segment to the other's point.
    double s = clamp((c * vv_[n] - uv_[n] * f) * per_nn_[n]);
    const double r = clamp((uv_[n] * s - f) * per_vv_[n]);
    s = clamp((c + uv_[n] * r) * per_uu_[n]);
    w[0][n] = x + r * v_[0][n] - s * u_[0][n];
    w[1][n] = y + r * v_[1][n] - s * u_[1][n];
    w[2][n] = z + r * v_[2][n] - s * u_[2][n];
    squared[n] = w[0][n] * w[0][n] + w[1][n] * w[1][n] + w[2][n] * w[2][n];
  }
  double height[k_corners];
  double outside[k_corners];  // at most 0 over the face
  for (std::size_t n = 0; n < k_corners; ++n) {
    const double x = over_[0][n] + t * drift_[0][n];
    const double y = over_[1][n] + t * drift_[1][n];
    const double z = over_[2][n] + t * drift_[2][n];
    height[n] = normal_[0][n] * x + normal_[1][n] * y + normal_[2][n] * z;
    const double first = first_[0][n] * x + first_[1][n] * y + first_[2][n] * z;
    const double second = second_[0][n] * x + second_[1][n] * y + second_[2][n] * z;
    outside[n] = std::max(std::max(-first, -second), first + second - 1.0);
  }

  Sample sample{.distance = 0.0, .axis = Vector3d::Zero(), .slope = 0.0};
  const auto split = [&](std::size_t n) {
    const auto [low, high] = std::minmax({height[n], height[n + 1], height[n + 2]});
    return low <= blur_ && high >= -blur_;
  };
  if (thin_ || (split(0) && split(3))) {  // they may intersect
    const Vector3d move = t * direction_;
    const ClosestPoints closest = triangle_triangle_distance(a_, {b_[0] + move, b_[1] + move, b_[2] + move});
    sample.distance = closest.distance;
    sample.axis = closest.on_b - closest.on_a;
  } else {
    std::size_t best = 0;
    for (std::size_t n = 1; n < k_edges; ++n) best = squared[n] < squared[best] ? n : best;
    sample.axis = Vector3d(w[0][best], w[1][best], w[2][best]);
    sample.distance = std::sqrt(squared[best]);
    for (std::size_t n = 0; n < k_corners; ++n) {
      const double over = std::abs(height[n]);
      if (outside[n] > 0.0 || !(over < sample.distance)) continue;
      const double sign = n < 3 ? -height[n] : height[n];
      const Vector3d normal(normal_[0][n], normal_[1][n], normal_[2][n]);
      sample.distance = over;
      sample.axis = sign * normal;
    }
  }
  const double length = sample.axis.norm();
  if (length > 0.0) sample.axis /= length;
  sample.slope = sample.axis.dot(direction_);
  return sample;
}

}  // namespace sixdof::ray_cast
