#include <sixdof/oracle/inner_balls.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include <sixdof/geometry/closest_point.h>
#include <sixdof/oracle/signed_depth.h>

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;

/// A ball shrinks until no point of the surface is nearer to its centre than its radius less this part of it.
constexpr double k_touching = 1e-3;
constexpr int k_most_shrinks = 16;
/// A centre nearer to that of a larger ball than this part of its radius adds little.
constexpr double k_close = 0.3;

struct Ball {
  Vector3d center;
  double radius;
  std::uint32_t triangle;
};

/// The largest ball inside that touches the surface at the middle of the triangle; none of a triangle without area.
std::optional<Ball> grow(const Tree& tree, SignedDepth& depth, std::uint32_t triangle) {
  const Tree::Corners& c = tree.corners()[triangle];
  const Vector3d x = (c[0] + c[1] + c[2]) / 3.0, area = (c[1] - c[0]).cross(c[2] - c[0]);
  if (area.isZero(0.0)) return std::nullopt;
  const Vector3d normal = area.normalized();
  double radius = tree.radius();
  Vector3d center = x - radius * normal;
  for (int i = 0; i < k_most_shrinks; ++i) {
    const std::optional<SurfacePoint> nearest = closest_point(tree, center);
    if (!nearest || nearest->distance >= (1.0 - k_touching) * radius) break;
    // The ball through x with this normal and through the nearest point.
    const Vector3d way = x - nearest->point;
    const double along = 2.0 * normal.dot(way);
    if (!(along > 0.0)) break;
    radius = std::min(way.squaredNorm() / along, (1.0 - k_touching) * radius);
    center = x - radius * normal;
  }
  const DepthNode node = depth.at(center, tree.mesh_triangle()[triangle]);
  if (!(node.s < 0.0)) return std::nullopt;
  return Ball{center, -node.s, node.triangle};
}

}  // namespace

InnerBalls InnerBalls::moved(const Pose& X) const {
  InnerBalls result = *this;
  for (std::size_t i = 0; i < size(); ++i) {
    const Vector3d p = X * center(i);
    result.x[i] = p.x();
    result.y[i] = p.y();
    result.z[i] = p.z();
  }
  return result;
}

InnerBalls find_inner_balls(const Mesh& mesh, const Tree& tree) {
  SignedDepth depth(mesh, tree);
  std::vector<Ball> found;
  const std::size_t n = tree.corners().size(), count = std::min(n, InnerBalls::k_samples);
  for (std::size_t i = 0; i < count; ++i) {
    if (const auto ball = grow(tree, depth, static_cast<std::uint32_t>(i * n / count))) found.push_back(*ball);
  }
  std::ranges::stable_sort(found, [](const Ball& a, const Ball& b) { return a.radius > b.radius; });
  InnerBalls balls;
  for (const Ball& ball : found) {
    bool is_new = balls.size() < InnerBalls::k_most;
    for (std::size_t i = 0; i < balls.size() && is_new; ++i) {
      is_new = (balls.center(i) - ball.center).norm() > k_close * balls.radius[i];
    }
    if (!is_new) continue;
    balls.x.push_back(ball.center.x());
    balls.y.push_back(ball.center.y());
    balls.z.push_back(ball.center.z());
    balls.radius.push_back(ball.radius);
    balls.triangle.push_back(ball.triangle);
  }
  return balls;
}

BallPair deepest_pair(const InnerBalls& a, const InnerBalls& b, const Vector3d& translation) {
  BallPair best{.overlap = -std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = a.x[i] - translation.x(), y = a.y[i] - translation.y(), z = a.z[i] - translation.z();
    for (std::size_t j = 0; j < b.size(); ++j) {
      const double dx = b.x[j] - x, dy = b.y[j] - y, dz = b.z[j] - z;
      const double overlap = a.radius[i] + b.radius[j] - std::sqrt(dx * dx + dy * dy + dz * dz);
      if (overlap <= best.overlap) continue;
      best.overlap = overlap;
      best.a = i;
      best.b = j;
    }
  }
  const Vector3d center = a.center(best.a), way = b.center(best.b) + translation - center;
  const double length = way.norm();
  const double part = std::clamp(0.5 * (length + a.radius[best.a] - b.radius[best.b]), 0.0, length);
  best.p = length > 0.0 ? Vector3d(center + part / length * way) : center;
  return best;
}

}  // namespace sixdof::detail
