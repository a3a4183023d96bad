#include <sixdof/generation/overlap_bound.h>

#include <numbers>
#include <random>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <sixdof/models/boxes.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/oracle/solid.h>

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-12;  // relative

Eigen::Matrix3d random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

/// The overlap of two crossing plates is a bar as long as the shorter edge, with a rhombus for a section.
TEST(OverlapBound, IsTightForPlatesThatCross) {
  const Eigen::Vector3d size_a(2.0, 1.6, 0.01), size_b(1.8, 1.2, 0.02);
  for (const double degrees : {90.0, 60.0, 30.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    // About x: B's edge of 1.8 lies along A's of 2.
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix();
    const double expected = 1.8 * 0.01 * 0.02 / std::sin(angle);
    EXPECT_NEAR(overlap_upper_bound(size_a, size_b, R), expected, 1e-9 * expected) << degrees;
    EXPECT_NEAR(overlap_upper_bound(size_b, size_a, R.transpose()), expected, 1e-9 * expected) << degrees;
  }
}

TEST(OverlapBound, IsTheSmallerBoxWithoutARotation) {
  const Eigen::Vector3d size_a(2.0, 1.6, 1.2), size_b(1.0, 0.5, 0.25);
  EXPECT_NEAR(overlap_upper_bound(size_a, size_b, Eigen::Matrix3d::Identity()), size_b.prod(), k_rounding);
}

TEST(OverlapBound, IsNeverBelowAnOverlap) {
  const Mesh plate = make_box({.size = {2.0, 1.6, 0.05}}, 12), knot = load_model("torus-knot-600");
  std::mt19937_64 random(20);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  double closest = 0.0;
  for (const auto& [a, b] : {std::pair{&plate, &plate}, {&plate, &knot}, {&knot, &plate}}) {
    const Tree tree_a(*a), tree_b(*b);
    const Solid solid_a(*a, tree_a), solid_b(*b, tree_b);
    OverlapQuery query(solid_a, solid_b);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Matrix3d R = random_rotation(random);
      const double x = shift(random), y = shift(random), z = shift(random);
      const double volume = query.evaluate({R, {x, y, z}}).volume;
      const double bound = overlap_upper_bound(a->box().sizes(), b->box().sizes(), R);
      EXPECT_LE(volume, bound * (1.0 + k_rounding));
      closest = std::max(closest, volume / bound);
    }
  }
  EXPECT_GT(closest, 0.5);
}

}  // namespace
}  // namespace sixdof
