// Cells of translations, and the proof of one.

#include <sixdof/oracle/penetration_cell.h>

#include <gtest/gtest.h>

#include <sixdof/oracle/penetration_cover.h>

#include "bodies.h"

namespace sixdof::detail {
namespace {

using bodies::box;
using Eigen::Vector3d;

TranslationCell narrow_cell(const Vector3d& direction, double r0, double r1) {
  const Vector3d u = direction.normalized(), v = u.unitOrthogonal(), w = u.cross(v);
  return {.u = {(u + 0.1 * v).normalized(), (u - 0.1 * v + 0.1 * w).normalized(), (u - 0.1 * w).normalized()},
          .r0 = r0,
          .r1 = r1};
}

TEST(TranslationCell, HalvesShareTheMiddleOfTheLongestSide) {
  const TranslationCell cell = narrow_cell({0.3, 0.5, 0.7}, 0.1, 0.2);
  const auto [side, k] = cell.longest_side();
  const TranslationCell first = cell.halved(0), second = cell.halved(1);
  EXPECT_EQ(first.u[(k + 1) % 3], second.u[k]);
  EXPECT_EQ(first.u[k], cell.u[k]);
  EXPECT_EQ(second.u[(k + 1) % 3], cell.u[(k + 1) % 3]);
  EXPECT_LT(first.longest_side().first, side);
  const auto solid_angle = [](const TranslationCell& c) { return std::abs(c.u[0].dot(c.u[1].cross(c.u[2]))); };
  EXPECT_NEAR(solid_angle(first) + solid_angle(second), solid_angle(cell), 0.02 * solid_angle(cell));
}

TEST(TranslationCell, KeepsTheNewestSeeds) {
  TranslationCell cell = narrow_cell({0, 0, 1}, 0.0, 0.1);
  for (int i = 1; i <= 5; ++i) cell.add_seed({.translation = Vector3d(i, 0, 0), .point = {}});
  ASSERT_EQ(cell.seed_count, TranslationCell::k_most_seeds);
  for (std::size_t i = 0; i < cell.seed_count; ++i)
    EXPECT_EQ(cell.seeds[i].translation.x(), 5.0 - static_cast<double>(i));
  cell.drop_seeds(2);
  ASSERT_EQ(cell.seed_count, TranslationCell::k_most_seeds - 2);
  EXPECT_EQ(cell.seeds[0].translation.x(), 3.0);
}

class OfBoxes : public ::testing::Test {
 protected:
  std::mt19937_64 random{71};
  Pose X_WA = bodies::random_pose(random, 0.7);
  Mesh a = bodies::moved(box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}), X_WA);
  Mesh b = box({-0.2, -0.3, -0.4}, {0.2, 0.3, 0.4});
  Pose X_AB = X_WA * Pose{Eigen::Matrix3d::Identity(), {0.6, 0.21, -0.1}};  // depth 0.1 along x
  PenetrationOracle oracle{a, b};
  CellProver prover{oracle, X_AB};
  std::vector<PlacedPoint> pool = prover.find_pool();
};

TEST_F(OfBoxes, ThePoolHasCommonPoints) {
  ASSERT_FALSE(pool.empty());
  for (const PlacedPoint& each : pool) {
    EXPECT_GT(each.point.depth(), 0.0);
    EXPECT_LE(each.point.depth(), 0.05 + 1e-12);
  }
  EXPECT_GT(pool.front().point.depth(), 0.04);
}

TEST_F(OfBoxes, ACellIsProvenUpToTheDepthAndNotBeyond) {
  const Vector3d x = X_WA.R.col(0);
  const TranslationCell inner = narrow_cell(x, 0.0, 0.09), outer = narrow_cell(x, 0.05, 0.09);
  EXPECT_EQ(prover.prove(inner, pool, 0.2).next, CellProof::Next::proven);
  EXPECT_EQ(prover.prove(outer, pool, 0.2).next, CellProof::Next::proven);
  const CellProof beyond = prover.prove(narrow_cell(x, 0.05, 0.12), pool, 0.2);
  EXPECT_NE(beyond.next, CellProof::Next::proven);
  ASSERT_TRUE(beyond.free);
  EXPECT_TRUE(prover.translations().is_free(X_AB, *beyond.free));
  // The corners are beyond the depth, all translations of the cell before it: narrower directions would do.
  const CellProof wide = prover.prove(narrow_cell(x, 0.05, 0.0999), pool, 0.1);
  EXPECT_EQ(wide.next, CellProof::Next::halve);
  EXPECT_FALSE(wide.free);
}

TEST_F(OfBoxes, OtherDirectionsReachFarther) {
  // B leaves A along y by 0.49 and along -x by 1.3.
  EXPECT_EQ(prover.prove(narrow_cell(-X_WA.R.col(0), 0.0, 0.7), pool, 2.0).next, CellProof::Next::proven);
  EXPECT_EQ(prover.prove(narrow_cell(X_WA.R.col(1), 0.0, 0.3), pool, 2.0).next, CellProof::Next::proven);
}

}  // namespace
}  // namespace sixdof::detail
