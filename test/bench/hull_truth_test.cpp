#include "bench/harness/hull_truth.h"

#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/models/model_catalogue.h>

#include "../geometry/shapes.h"

namespace sixdof::bench {
namespace {

constexpr double k_rounding = 1e-12;  // of lengths and volumes of about one

Pose at(double x, double y, double z) {
  Pose X_AB;
  X_AB.t = Eigen::Vector3d(x, y, z);
  return X_AB;
}

TEST(HullTruth, OfConvexBodiesIsTheirOwn) {
  const Mesh a = shapes::box({1.0, 1.0, 1.0}), b = shapes::box({0.5, 0.5, 0.5});
  HullTruth truth(a, b);
  const auto apart = truth.at(at(2.0, 0.1, 0.2));
  ASSERT_TRUE(apart);
  EXPECT_EQ(apart->key.kind, BucketKind::distance);
  EXPECT_NEAR(apart->target, 0.5, k_rounding);
  EXPECT_NEAR(apart->key.percent, 50.0 / a.diagonal(), 1e3 * k_rounding);
  EXPECT_EQ(apart->diagonal, a.diagonal());
  const auto overlap = truth.at(at(1.4, 0.1, 0.2));
  ASSERT_TRUE(overlap);
  EXPECT_EQ(overlap->key.kind, BucketKind::volume);
  EXPECT_NEAR(overlap->target, 0.1, k_rounding);
  EXPECT_TRUE(judge(*overlap, false).wrong);
  EXPECT_FALSE(judge(*overlap, true).wrong);
  EXPECT_TRUE(judge(*apart, true).wrong);
  const std::vector<Pose> poses{at(1.4, 0.1, 0.2)};
  EXPECT_NEAR(truth.responses(poses).at(0).volume, 0.1, k_rounding);
}

TEST(HullTruth, JudgesNothingNearContact) {
  const Mesh a = shapes::box({1.0, 1.0, 1.0}), b = shapes::box({0.5, 0.5, 0.5});
  HullTruth truth(a, b);
  EXPECT_FALSE(truth.at(at(1.5 + 1e-8, 0.1, 0.2)));
  EXPECT_FALSE(truth.at(at(1.5 - 1e-8, 0.1, 0.2)));
  EXPECT_TRUE(truth.at(at(1.5 + 1e-4, 0.1, 0.2)));
  EXPECT_TRUE(truth.at(at(1.5 - 1e-4, 0.1, 0.2)));
}

TEST(HullTruth, FillsTheHoleOfATorus) {
  const Mesh torus = load_model("torus-1k"), box = shapes::box({0.1, 0.1, 0.1});
  const Pose in_the_hole = at(0.05, 0.03, 0.02);
  const auto exact = make_exact_algorithm();
  EXPECT_FALSE(exact->prepare(torus, box, exact->settings())->collide(in_the_hole).value);
  const auto known = HullTruth(torus, box).at(in_the_hole);
  ASSERT_TRUE(known);
  EXPECT_EQ(known->key.kind, BucketKind::volume);
}

}  // namespace
}  // namespace sixdof::bench
