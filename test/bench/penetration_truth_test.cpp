#include "bench/harness/penetration_truth.h"

#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/oracle/convex_depth.h>
#include <sixdof/oracle/convex_hull.h>

#include "own_truths.h"

namespace sixdof::bench {
namespace {

struct OwnPenetration : OwnTruths {
  OwnPenetration() : OwnTruths("penetration_truth_cache") {}
};

TEST_F(OwnPenetration, IsTheIntervalOfTheOracleAndIsKept) {
  const std::vector<Pose> at = poses(2);
  PenetrationTruths truths(a, b);
  const std::span<const PenetrationDepth> found = truths.at(at);
  ASSERT_EQ(found.size(), at.size());
  EXPECT_FALSE(std::filesystem::is_empty(cache));
  PenetrationTruths again(a, b);
  const std::span<const PenetrationDepth> kept = again.at(at);
  const PenetrationOracle oracle(a, b);
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_GT(found[i].hi, 0.0);
    EXPECT_LE(found[i].lo, found[i].hi);
    EXPECT_EQ(kept[i].lo, found[i].lo);
    EXPECT_EQ(kept[i].hi, found[i].hi);
    EXPECT_EQ(kept[i].closed, found[i].closed);
    const PenetrationDepth other = oracle.evaluate(at[i], {.tolerance = 0.1});
    EXPECT_LE(std::max(other.lo, found[i].lo), std::min(other.hi, found[i].hi));
  }
}

TEST_F(OwnPenetration, OfHullsIsTheDepthOfConvexBodies) {
  const std::vector<Pose> at = poses(3);
  PenetrationTruths truths = PenetrationTruths::of_hulls(a, b);
  const std::span<const PenetrationDepth> found = truths.at(at);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double depth = convex_depth(convex_hull(a), convex_hull(b), at[i]).depth;
    EXPECT_TRUE(found[i].closed);
    EXPECT_NEAR(found[i].lo, depth, 1e-12);
    EXPECT_NEAR(found[i].hi, depth, 1e-12);
    // The hulls contain the bodies.
    EXPECT_GE(found[i].hi, PenetrationTruths(a, b).at(at)[i].lo);
  }
}

TEST_F(OwnPenetration, TakesAFewPosesOnly) {
  PenetrationTruths truths = PenetrationTruths::of_hulls(a, b);
  EXPECT_EQ(truths.at(poses(PenetrationTruths::k_most + 5)).size(), PenetrationTruths::k_most);
}

}  // namespace
}  // namespace sixdof::bench
