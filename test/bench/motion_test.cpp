#include "bench/harness/motion.h"

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "../oracle/bodies.h"

namespace sixdof::bench {
namespace {

constexpr double k_rounding = 1e-9;  // relative to a step: of poses that are products of many

TEST(Motion, BeginsAtTheFirstConfigurationsAndMovesInSmallSteps) {
  const Mesh a = bodies::bumpy_torus(31, 17), b = bodies::bumpy_torus(21, 13, 0.2, 0.7);
  std::mt19937_64 random(3);
  std::vector<Pose> starts;
  for (int i = 0; i < 3; ++i) starts.push_back(bodies::random_pose(random, 1.0));
  constexpr std::size_t k_length = 70;
  const std::vector<Pose> poses = poses_of_motions(starts, k_length, a, b, 1);
  ASSERT_EQ(poses.size(), starts.size() * k_length);
  const double step = Motion::k_step * a.diagonal();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto [start, place] = std::pair(i / k_length, i % k_length);
    EXPECT_TRUE((poses[i].R * poses[i].R.transpose()).isIdentity(1e-14));
    if (place == 0) {
      EXPECT_EQ(poses[i].R, starts[start].R);
      EXPECT_EQ(poses[i].t, starts[start].t);
      continue;
    }
    double most = 0.0;
    for (const Eigen::Vector3d& p : b.vertices()) most = std::max(most, (poses[i] * p - poses[i - 1] * p).norm());
    EXPECT_LE(most, 1.0001 * step);
    EXPECT_GT(most, 0.4 * step);
    EXPECT_NEAR((poses[i] * b.center() - poses[i - 1] * b.center()).norm(), 0.5 * step, k_rounding * step);
  }
  const auto direction_of = [&](std::size_t i) -> Eigen::Vector3d {
    return (poses[i + 1] * b.center() - poses[i] * b.center()).normalized();
  };
  EXPECT_LT(direction_of(0).dot(direction_of(k_length)), 0.99) << "each has its own";
  EXPECT_NEAR(direction_of(0).dot(direction_of(k_length - 2)), 1.0, k_rounding) << "and keeps it";
}

TEST(Motion, IsTheSameForTheSameSeed) {
  const Mesh mesh = bodies::bumpy_torus(31, 17);
  const std::vector<Pose> starts(20);
  const std::vector<Pose> first = poses_of_motions(starts, 3, mesh, mesh, 5),
                          other = poses_of_motions(starts, 3, mesh, mesh, 6);
  EXPECT_EQ(first.back().t, poses_of_motions(starts, 3, mesh, mesh, 5).back().t);
  EXPECT_NE(first.back().t, other.back().t);
  EXPECT_TRUE(poses_of_motions({}, 3, mesh, mesh, 5).empty());
}

}  // namespace
}  // namespace sixdof::bench
