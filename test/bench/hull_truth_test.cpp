#include "bench/harness/hull_truth.h"

#include <vector>

#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/scenario/solids.h>

namespace sixdof::bench {
namespace {

constexpr double k_rounding = 1e-12;  // of lengths and volumes of about 1

Pose at(double x, double y, double z) { return {Eigen::Matrix3d::Identity(), {x, y, z}}; }

/// Edges of 2; two copies lie face to face, `gap` apart.
struct Cubes : ::testing::Test {
  const Mesh cube = box_solid({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}, "cube");
  HullTruth hulls{cube, cube};
  KnownAnswer known(double gap, const BucketSample& bucket = {.key = {BucketKind::distance, 5}}) {
    return hulls.at(bucket, at(0.1, 0.2, 2.0 + gap));
  }
};

TEST_F(Cubes, HaveDistancesAndVolumes) {
  const KnownAnswer apart = known(0.1);
  EXPECT_EQ(apart.key.kind, BucketKind::distance);
  EXPECT_NEAR(apart.target, 0.1, k_rounding);
  EXPECT_FALSE(judge(apart, false).wrong);
  EXPECT_TRUE(judge(apart, true).wrong);
  EXPECT_TRUE(judge(apart, Separation{.distance = 0.11}).wrong);
  const KnownAnswer overlapping = known(-0.1);
  EXPECT_EQ(overlapping.key.kind, BucketKind::volume);
  EXPECT_NEAR(overlapping.target, 0.1 * 1.9 * 1.8, k_rounding);
  EXPECT_TRUE(judge(overlapping, false).wrong);
  EXPECT_FALSE(judge(overlapping, Separation{.distance = 0.0}).wrong);
  EXPECT_TRUE(judge(overlapping, Separation{.distance = 0.1}).wrong);
  EXPECT_TRUE(judge(overlapping, Response{}).missed);
}

TEST_F(Cubes, AreNotJudgedNearContact) {
  const double slack = k_distance_slack * cube.diagonal();
  for (const double gap : {0.1 * slack, -0.1 * slack}) {
    for (const bool answer : {false, true}) EXPECT_FALSE(judge(known(gap), answer).judged) << gap;
  }
  for (const double gap : {10.0 * slack, -10.0 * slack}) {
    EXPECT_TRUE(judge(known(gap), gap > 0.0).wrong) << gap;
    EXPECT_FALSE(judge(known(gap), gap < 0.0).wrong) << gap;
  }
}

TEST_F(Cubes, AreNotJudgedWhereMeshesTouch) {
  const BucketSample contact{.key = {BucketKind::distance, 0}, .target = 1e-5};
  for (const double gap : {0.9e-5, -0.9e-5}) EXPECT_FALSE(judge(known(gap, contact), true).judged) << gap;
  EXPECT_TRUE(judge(known(0.9e-5), true).wrong) << "of another bucket";
  EXPECT_TRUE(judge(known(-0.1, contact), false).wrong) << "hulls that overlap where the meshes touch";
}

TEST_F(Cubes, HaveResponses) {
  const std::vector<Pose> poses{at(0.1, 0.2, 1.9), at(0.0, 0.0, 5.0)};
  const std::vector<Response> responses = hulls.responses(poses);
  ASSERT_EQ(responses.size(), 2u);
  EXPECT_GT(responses[0].force.z(), 0.0);
  EXPECT_TRUE(responses[1].force.isZero(0.0));
}

TEST(HullTruth, OfTwoConvexBodiesIsTheirOwn) {
  const Mesh a = box_solid({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}, "a");
  const Mesh b = box_solid({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, "b");
  HullTruth hulls(a, b);
  const BucketSample bucket{.key = {BucketKind::distance, 5}};
  const KnownAnswer apart = hulls.at(bucket, at(2.0, 0.1, 0.2));
  EXPECT_EQ(apart.key.kind, BucketKind::distance);
  EXPECT_NEAR(apart.target, 0.5, k_rounding);
  EXPECT_EQ(apart.diagonal, a.diagonal());
  const KnownAnswer overlap = hulls.at(bucket, at(1.4, 0.1, 0.2));
  EXPECT_EQ(overlap.key.kind, BucketKind::volume);
  EXPECT_NEAR(overlap.target, 0.1, k_rounding);
  const std::vector<Pose> poses{at(1.4, 0.1, 0.2)};
  EXPECT_NEAR(hulls.responses(poses).at(0).volume, 0.1, k_rounding);
}

TEST(HullTruth, IsNotThatOfTheMeshes) {
  const Mesh torus = load_model("torus-1k"), ball = sphere_solid(0.2, 12, RoundParts::inscribed, "ball");
  const Pose in_the_hole = at(0.05, 0.03, 0.02);
  const auto exact = make_exact_algorithm();
  ASSERT_FALSE(exact->prepare(torus, ball, exact->settings())->collide(in_the_hole).value);
  HullTruth hulls(torus, ball);
  const KnownAnswer known = hulls.at({.key = {BucketKind::distance, 5}}, in_the_hole);
  EXPECT_EQ(known.key.kind, BucketKind::volume);
  EXPECT_GT(known.target, 0.0);
  EXPECT_TRUE(judge(known, false).wrong);
}

}  // namespace
}  // namespace sixdof::bench
