#include <sixdof/configuration/grid.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <sixdof/base/error.h>

#include "shapes.h"

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-15;
constexpr double k_degree = std::numbers::pi / 180.0;

std::size_t distinct(const std::vector<Eigen::Vector4d>& rotations) {
  const auto map = DistinctRotations(rotations).representative;
  return std::set(map.begin(), map.end()).size();
}

Eigen::Matrix3d matrix(const Eigen::Vector4d& q) {
  return Pose::from_quaternion(q[0], q[1], q[2], q[3], Eigen::Vector3d::Zero()).R;
}

TEST(Grid, HasThePapersCounts) {
  const Grid distances = make_grid("paper");
  EXPECT_EQ(distances.directions.size(), 266u);
  EXPECT_EQ(distances.rotations.size(), 7488u);
  EXPECT_EQ(distances.configurations(), 1'991'808u);
  EXPECT_EQ(distinct(distances.rotations), 6384u);

  const Grid volumes = make_grid("paper-volume");
  EXPECT_EQ(volumes.directions.size(), 266u);
  EXPECT_EQ(volumes.rotations.size(), 1008u);
  EXPECT_EQ(volumes.configurations(), 268'128u);
  EXPECT_EQ(distinct(volumes.rotations), 744u);

  EXPECT_EQ(k_paper_distance_buckets * distances.configurations() + k_paper_volume_buckets * volumes.configurations(),
            64'695'456u);
}

TEST(Grid, TakesEveryStepThatDivides180) {
  const Grid coarse = make_grid("45");
  EXPECT_EQ(coarse.directions.size(), 26u);
  EXPECT_EQ(coarse.rotations.size(), 320u);
  EXPECT_EQ(distinct(coarse.rotations), 208u);
  const Grid mixed = make_grid("22.5/60");
  EXPECT_EQ(mixed.directions.size(), 16u * 7u + 2u);
  EXPECT_EQ(mixed.rotations.size(), 6u * 4u * 6u);
  EXPECT_EQ(mixed.direction_step_degrees, 22.5);
  EXPECT_EQ(mixed.rotation_step_degrees, 60.0);
  EXPECT_EQ(make_grid("180").directions.size(), 2u);
  EXPECT_EQ(make_grid("180").rotations.size(), 8u);
  EXPECT_EQ(make_grid("25.714285714286").directions.size(), 14u * 6u + 2u);
  EXPECT_EQ(mixed.spec, "22.5/60");
  EXPECT_EQ(make_grid("45.0/45").spec, "45");
  EXPECT_EQ(make_grid("15").rotations, make_grid("paper").rotations);
}

TEST(Grid, RefusesWhatIsNoGrid) {
  for (const char* spec : {"",
                           "papers",
                           "0",
                           "-15",
                           "7",
                           "200",
                           "nan",
                           "inf",
                           "15/",
                           "/15",
                           "15/7",
                           "15/15/15",
                           "so3:",
                           "so3:0",
                           "so3:-3",
                           "so3:10:",
                           "so3:1e3",
                           "so3:10:0",
                           "0.0001",
                           "1e-300",
                           "1",
                           "so3:20000001",
                           "so3:99999999999999999999",
                           "so3:5:99999999999",
                           " 15"}) {
    EXPECT_THROW(make_grid(spec), BadArgument) << spec;
  }
  EXPECT_THAT([] { make_grid("7"); }, testing::ThrowsMessage<BadArgument>(testing::HasSubstr("grid '7'")));
}

TEST(Grid, DirectionsAreDistinctUnitVectorsAtTheirAngles) {
  const auto directions = make_grid("15").directions;
  EXPECT_EQ(directions.front(), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(directions.back(), Eigen::Vector3d(0, 0, -1));
  std::set<std::array<double, 3>> seen;
  for (const auto& u : directions) {
    EXPECT_NEAR(u.norm(), 1.0, k_rounding);
    seen.insert({u.x(), u.y(), u.z()});
  }
  EXPECT_EQ(seen.size(), directions.size());
  // Parallel 5 (polar angle 75 degrees), longitude 7 (105 degrees).
  const Eigen::Vector3d expected(std::sin(75 * k_degree) * std::cos(105 * k_degree),
                                 std::sin(75 * k_degree) * std::sin(105 * k_degree), std::cos(75 * k_degree));
  EXPECT_TRUE(directions[1 + 4 * 24 + 7].isApprox(expected, k_rounding));
}

TEST(Grid, RotationsAreTheEulerAnglesProduct) {
  const auto rotations = make_grid("15").rotations;
  std::mt19937_64 random(7);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const std::size_t alpha = random() % 24, beta = random() % 13, gamma = random() % 24;
    const auto angle = [](std::size_t k) { return static_cast<double>(k) * 15.0 * k_degree; };
    const Eigen::Matrix3d expected = (Eigen::AngleAxisd(angle(alpha), Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(angle(beta), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(angle(gamma), Eigen::Vector3d::UnitZ()))
                                         .toRotationMatrix();
    EXPECT_TRUE(matrix(rotations[(alpha * 13 + beta) * 24 + gamma]).isApprox(expected, 4 * k_rounding));
  }
}

TEST(Grid, RepresentativesAreTheSameRotationAndNoOtherRotationIs) {
  const auto rotations = make_grid("30").rotations;
  const auto map = DistinctRotations(rotations).representative;
  // Two rotations that differ on this grid do so by an angle of whole degrees, far above this.
  constexpr double k_same = 1e-9;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    ASSERT_LE(map[i], i);
    ASSERT_EQ(map[map[i]], map[i]);
    for (std::size_t j = 0; j < i; ++j) {
      const bool same = std::abs(rotations[i].dot(rotations[j])) > 1.0 - k_same;
      ASSERT_EQ(same, map[i] == map[j]) << i << " " << j;
    }
  }
}

TEST(Grid, RotationsByRightAnglesAreExact) {
  std::size_t exact = 0;
  for (const auto& q : make_grid("15").rotations) {
    const Eigen::Matrix3d R = matrix(q);
    const Eigen::Matrix3d rounded = R.array().round();
    if (!R.isApprox(rounded, 1e-9)) continue;
    ++exact;
    EXPECT_EQ(R, rounded);
  }
  EXPECT_GE(exact, 24u);  // The rotation group of the cube, some of them repeated.
}

/// Angles from random rotations to the nearest of a set.
struct Covering {
  double mean = 0.0, largest = 0.0;
};

Covering covering(const std::vector<Eigen::Vector4d>& rotations) {
  std::mt19937_64 random(99);
  std::normal_distribution<double> normal;
  constexpr int k_probes = 3000;
  Covering result;
  for (int probe = 0; probe < k_probes; ++probe) {
    Eigen::Vector4d q(normal(random), normal(random), normal(random), normal(random));
    q.normalize();
    double closest = 0.0;
    for (const auto& r : rotations) closest = std::max(closest, std::abs(q.dot(r)));
    const double angle = 2.0 * std::acos(std::min(1.0, closest));
    result.mean += angle / k_probes;
    result.largest = std::max(result.largest, angle);
  }
  return result;
}

TEST(Grid, UniformRotationsCoverSO3BetterThanRandomOnesAndThanEulerAngles) {
  const auto euler = make_grid("30").rotations;  // 1,008, of which 744 are distinct
  const auto uniform = make_grid("so3:744:1").rotations;
  std::vector<Eigen::Vector4d> random_rotations;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  while (random_rotations.size() < uniform.size()) {
    random_rotations.push_back(
        Eigen::Vector4d(normal(random), normal(random), normal(random), normal(random)).normalized());
  }
  const Covering of_uniform = covering(uniform);
  const Covering of_random = covering(random_rotations);
  const Covering of_euler = covering(euler);
  // Alexa 2022 reports the largest empty ball of random samples about twice that of the spirals.
  EXPECT_LT(of_uniform.largest, 0.65 * of_random.largest);
  EXPECT_LT(of_uniform.mean, 0.9 * of_random.mean);
  EXPECT_LT(of_uniform.mean, of_euler.mean);

  // A uniform set has E[q q^T] = I / 4; random ones miss it by about 1 / sqrt(n) = 0.04.
  Eigen::Matrix4d moment = Eigen::Matrix4d::Zero();
  for (const auto& q : uniform) {
    EXPECT_NEAR(q.norm(), 1.0, k_rounding);
    moment += q * q.transpose() / static_cast<double>(uniform.size());
  }
  EXPECT_LT((moment - 0.25 * Eigen::Matrix4d::Identity()).norm(), 5e-3);
  EXPECT_EQ(distinct(uniform), uniform.size());
}

TEST(Grid, UniformDirectionsMatchTheRotationsSpacing) {
  const Grid grid = make_grid("so3:6384");
  EXPECT_EQ(grid.rotations.size(), 6384u);
  EXPECT_EQ(grid.directions.size(), 235u);  // cells of 13 degrees in both, close to the paper's 266 at 15 degrees
  EXPECT_EQ(grid.spec, "so3:6384:235");
  EXPECT_EQ(make_grid("so3:6384:1000").directions.size(), 1000u);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  double closest_pair = -1.0;
  for (std::size_t i = 0; i < grid.directions.size(); ++i) {
    const Eigen::Vector3d& u = grid.directions[i];
    EXPECT_NEAR(u.norm(), 1.0, k_rounding);
    mean += u / 235.0;
    moment += u * u.transpose() / 235.0;
    for (std::size_t j = 0; j < i; ++j) closest_pair = std::max(closest_pair, u.dot(grid.directions[j]));
  }
  EXPECT_LT(mean.norm(), 1e-2);
  EXPECT_LT((moment - Eigen::Matrix3d::Identity() / 3.0).norm(), 1e-2);
  // 235 caps of equal area have a radius of 7.5 degrees: neighbours of a good lattice are farther apart than that.
  EXPECT_GT(std::acos(closest_pair), 7.5 * k_degree);
}

TEST(ConfigurationPose, PutsTheCentreOfBsBoxAtDistanceSInDirectionU) {
  const Mesh first = test::tetrahedron_mesh({3.0, -1.0, 0.4}, 1.7);
  const Mesh second = test::tetrahedron_mesh({-0.7, 5.0, 2.2}, 0.9);
  const Grid grid = make_grid("30");
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> translations(0.0, 9.0);
  for (const auto& [a, b] : {std::pair(&first, &second), std::pair(&second, &first)}) {
    for (int repeat = 0; repeat < 50; ++repeat) {
      const Eigen::Vector3d& u = grid.directions[random() % grid.directions.size()];
      const Eigen::Vector4d& q = grid.rotations[random() % grid.rotations.size()];
      const double s = translations(random);
      const Pose X_AB = ConfigurationRay(*a, *b, q, u).pose(s);
      EXPECT_TRUE((X_AB * b->center()).isApprox(a->center() + s * u, 20 * k_rounding));
      EXPECT_NEAR(std::abs(X_AB.quaternion().dot(q)), 1.0, 4 * k_rounding);
      EXPECT_NEAR(X_AB.R.determinant(), 1.0, 8 * k_rounding);
    }
  }
}

}  // namespace
}  // namespace sixdof
