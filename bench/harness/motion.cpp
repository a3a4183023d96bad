#include "bench/harness/motion.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>

namespace sixdof::bench {
namespace {

/// 0 <= x < 1, the same with every standard library.
double fraction(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

Eigen::Vector3d direction_of(std::mt19937_64& random) {
  const double z = 2.0 * fraction(random) - 1.0, r = std::sqrt(1.0 - z * z);
  const double phi = 2.0 * std::numbers::pi * fraction(random);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace

Motion::Motion(const Mesh& a, const Mesh& b, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  axis = direction_of(random);
  direction = direction_of(random);
  length = 0.5 * k_step * a.diagonal();
  angle = length / (0.5 * b.diagonal());
}

Pose Motion::pose(const Pose& start, const Eigen::Vector3d& center, std::size_t step) const {
  if (step == 0) return start;
  const auto steps = static_cast<double>(step);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(steps * angle, axis).toRotationMatrix() * start.R;
  return {R, start * center + steps * length * direction - R * center};
}

std::vector<Pose> poses_of_motions(std::span<const Pose> starts, std::size_t length, const Mesh& a, const Mesh& b,
                                   std::uint64_t seed) {
  std::vector<Pose> poses;
  poses.reserve(starts.size() * length);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const Motion motion(a, b, seed + i);
    for (std::size_t step = 0; step < length; ++step) poses.push_back(motion.pose(starts[i], b.center(), step));
  }
  return poses;
}

}  // namespace sixdof::bench
