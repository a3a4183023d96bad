// Intervals of penetration depths against closed forms and against the depth of convex bodies, in both orders.

#include <sixdof/oracle/penetration.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/oracle/convex_depth.h>
#include <sixdof/oracle/free_translation.h>

#include "bodies.h"
#include "penetrating.h"

namespace sixdof {
namespace {

using bodies::box;
using bodies::moved;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Of casts, and of the planes of contacts: relative to bodies of size 1.
constexpr double k_of_hi = 1e-9;
/// Of a single cast from far away.
constexpr double k_of_cast = 1e-8;

Pose shift(double x, double y, double z) { return {Matrix3d::Identity(), {x, y, z}}; }

/// Evaluates the pair in both orders, with A moved by a generic motion.
/// @param truth the depth; `direction` that of its translation in the frame in which A is given, if it is unique
/// @param of_hi tolerance of hi: wider where other translations are within the tolerance of the interval
void expect_depth(const Mesh& a, const Mesh& b, const Pose& X_AB, double truth,
                  const std::optional<Vector3d>& direction = std::nullopt, double of_hi = k_of_hi) {
  std::mt19937_64 random(51);
  const Pose X_WA = bodies::random_pose(random, 0.7);
  const Mesh a_there = moved(a, X_WA);
  const Pose X = X_WA * X_AB;
  const PenetrationOracle oracle(a_there, b), exchanged(b, a_there);
  const PenetrationDepth found = oracle.evaluate(X), other = exchanged.evaluate(X.inverse());
  for (const PenetrationDepth& depth : {found, other}) {
    EXPECT_TRUE(depth.closed) << depth.lo << " " << depth.hi;
    EXPECT_LE(depth.lo, truth + k_of_hi);
    EXPECT_GE(depth.lo, truth * (1.0 - PenetrationOptions{}.tolerance) - k_of_hi);
    EXPECT_NEAR(depth.hi, truth, of_hi);
    EXPECT_NEAR(depth.translation.norm(), depth.hi, 1e-11);
  }
  if (!direction) return;
  EXPECT_NEAR(found.translation.normalized().dot(X_WA.R * *direction), 1.0, 1e-9);
  EXPECT_NEAR((X.R * other.translation).normalized().dot(X_WA.R * *direction), -1.0, 1e-9);
}

TEST(Penetration, OfBoxesAlongAFace) {
  expect_depth(box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}), box({-0.2, -0.3, -0.4}, {0.2, 0.3, 0.4}),
               shift(0.6, 0.21, -0.1), 0.1, Vector3d::UnitX());
}

TEST(Penetration, OfABoxInsideOfABox) {
  expect_depth(box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}), box({-0.1, -0.05, -0.02}, {0.1, 0.05, 0.02}),
               shift(0.13, 0.08, 0.1), 0.3 + 0.02 - 0.1, Vector3d::UnitZ());
}

TEST(Penetration, OfAPegInAHole) {
  // The peg is 0.6 wide, the hole 0.8: it overlaps by 0.05 and 0.03 and returns towards the middle.
  expect_depth(penetrating::plate_with_hole(), box({-0.3, -0.3, -1.2}, {0.3, 0.3, 1.2}), shift(0.15, 0.13, 0.04),
               std::hypot(0.05, 0.03), Vector3d(-0.05, -0.03, 0.0).normalized());
}

TEST(Penetration, OfABoxInTheInnerCornerOfAnL) {
  expect_depth(penetrating::l_shape(), box({-0.15, -0.2, -0.1}, {0.15, 0.2, 0.1}), shift(0.35, 0.42, 0.2),
               std::hypot(0.1, 0.08), Vector3d(0.1, 0.08, 0.0).normalized());
}

TEST(Penetration, OfTwoHookedLs) {
  // B is A turned by half a turn about z. Each bar of B meets one of A, 0.1 along x, 0.12 along y and 0.25 along z: a
  // shift along x frees both.
  const Mesh l = penetrating::l_shape();
  const Pose X_AB{Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitZ()).toRotationMatrix(), {1.2, 1.18, 0.15}};
  expect_depth(l, l, X_AB, 0.1, Vector3d::UnitX());
}

TEST(Penetration, OfLinkedRingsIsASlideWithinTheLink) {
  // Tubes of radius 0.2 about circles of radius 0.5 in the planes z = 0 and y = 0. B's tube passes through A's hole, of
  // radius 0.3, at x = 0.3, and is free up to x = 0.1. From outside the nearest way is to pull the rings apart, by 0.6.
  const Mesh ring = bodies::bumpy_torus(40, 20, 0.0);
  const Pose X_AB{Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX()).toRotationMatrix(), {0.8, 0.01, 0.02}};
  const PenetrationDepth found = PenetrationOracle(ring, ring).evaluate(X_AB, {.tolerance = 1e-2, .budget = 400'000});
  EXPECT_TRUE(found.closed);
  EXPECT_NEAR(found.hi, 0.2, 0.01);
  EXPECT_GT(found.lo, 0.19);
  EXPECT_LT(found.translation.x(), -0.19);
}

TEST(Penetration, OfSpheresAgreesWithTheDepthOfConvexBodies) {
  std::mt19937_64 random(52);
  const Mesh a = bodies::bumpy_sphere(3, 0.0, 0.5), b = bodies::bumpy_sphere(2, 0.0, 0.3);
  for (const double distance : {0.75, 0.6}) {
    Pose X_AB = bodies::random_pose(random, 1.0);
    X_AB.t = distance * X_AB.t.normalized();
    const double truth = convex_depth(a, b, X_AB).depth, of_balls = 0.8 - distance;
    EXPECT_LE(truth, of_balls);  // their corners lie on the balls
    EXPECT_GE(truth, of_balls - 0.02);
    expect_depth(a, b, X_AB, truth, std::nullopt, PenetrationOptions{}.tolerance * of_balls);
  }
}

TEST(Penetration, Of200SmallConvexPairsIsTheWitness) {
  std::mt19937_64 random(53);
  int deep = 0;
  for (int i = 0; i < 200; ++i) {
    const Mesh a = penetrating::hull_of_points(random, 10), b = penetrating::hull_of_points(random, 8);
    Pose X_AB = bodies::random_pose(random, 1.0);
    X_AB.t = 0.1 * (1 + i % 6) * X_AB.t.normalized();
    const ConvexDepth truth = convex_depth(a, b, X_AB);
    const PenetrationDepth found = PenetrationOracle(a, b).evaluate(X_AB, {.tolerance = 1e-4, .budget = 400'000});
    EXPECT_NEAR(found.hi, truth.depth, k_of_hi) << i;
    EXPECT_LE(found.lo, truth.depth + k_of_hi) << i;
    EXPECT_TRUE(found.closed) << i;
    deep += truth.depth > 0.01;
  }
  EXPECT_GE(deep, 150);
}

TEST(Penetration, ClosesAtANarrowTolerance) {
  const Mesh a = box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}), b = box({-0.2, -0.3, -0.4}, {0.2, 0.3, 0.4});
  std::mt19937_64 random(54);
  Pose X_AB = bodies::random_pose(random, 0.1);
  X_AB.t.x() += 0.4;
  const PenetrationDepth found = PenetrationOracle(a, b).evaluate(X_AB, {.tolerance = 1e-7, .budget = 2'000'000});
  const double truth = convex_depth(a, b, X_AB).depth;
  EXPECT_TRUE(found.closed);
  EXPECT_GE(found.lo, truth * (1.0 - 2e-7));
  EXPECT_LE(found.lo, truth + k_of_hi);
}

TEST(Penetration, OfRoughBodiesIsTheSameInBothOrdersAndAfterAMotion) {
  std::mt19937_64 random(55);
  const Mesh a = bodies::bumpy_torus(40, 20), b = bodies::bumpy_sphere(3, 0.15, 0.3);
  const PenetrationOracle oracle(a, b), exchanged(b, a);
  const PenetrationOptions coarse{.tolerance = 1e-2, .budget = 100'000};
  int deep = 0;
  for (int i = 0; i < 4; ++i) {
    Pose X_AB = bodies::random_pose(random, 0.2);
    X_AB.t.x() += 0.5;
    const PenetrationDepth found = oracle.evaluate(X_AB, coarse), other = exchanged.evaluate(X_AB.inverse(), coarse);
    // Both contain the depth.
    EXPECT_LE(std::max(found.lo, other.lo), std::min(found.hi, other.hi));
    EXPECT_GT(found.lo, 0.0);
    deep += found.hi > 0.01;
    // No translation shorter than lo is free, and that of hi is.
    detail::FreeTranslations translations(oracle.distance_oracle());
    EXPECT_TRUE(translations.is_free(X_AB, found.translation));
    for (int k = 0; k < 30; ++k) {
      const Vector3d u = bodies::random_pose(random, 1.0).t.normalized();
      EXPECT_FALSE(translations.is_free(X_AB, found.lo * (1.0 - 1e-6) * u));
      const std::optional<double> along = oracle.directional_depth(X_AB, u);
      ASSERT_TRUE(along);
      EXPECT_GE(*along, found.lo);
    }
  }
  EXPECT_GE(deep, 3);
}

TEST(Penetration, OfDisjointAndTouchingBodies) {
  const Mesh a = box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  const PenetrationOracle oracle(a, a);
  const PenetrationDepth apart = oracle.evaluate(shift(0.2, 1.1, -0.3));
  EXPECT_EQ(apart.lo, 0.0);
  EXPECT_EQ(apart.hi, 0.0);
  EXPECT_TRUE(apart.closed);
  const PenetrationDepth touching = oracle.evaluate(shift(0.2, 1.0, -0.3));
  EXPECT_EQ(touching.lo, 0.0);
  EXPECT_LE(touching.hi, 1e-8);
}

TEST(Penetration, WithoutBudgetIsOpenAndStillContainsTheDepth) {
  const Mesh a = box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}), b = box({-0.2, -0.3, -0.4}, {0.2, 0.3, 0.4});
  const PenetrationOracle oracle(a, b);
  const Pose X_AB = shift(0.6, 0.21, -0.1);
  double width = 1.0;
  for (const std::uint64_t budget : {1u, 3000u, 100000u}) {
    const PenetrationDepth found = oracle.evaluate(X_AB, {.tolerance = 1e-3, .budget = budget});
    EXPECT_LE(found.lo, 0.1);
    EXPECT_GE(found.hi, 0.1);
    EXPECT_LE(found.hi - found.lo, width);
    EXPECT_EQ(found.closed, found.open_cells == 0);
    width = found.hi - found.lo;
  }
  EXPECT_FALSE(oracle.evaluate(X_AB, {.tolerance = 1e-3, .budget = 1}).closed);
}

TEST(Penetration, HasTheSameBitsForEveryNumberOfThreads) {
  const Mesh a = bodies::bumpy_torus(30, 15), b = bodies::bumpy_sphere(2, 0.15, 0.3);
  const PenetrationOracle oracle(a, b);
  std::mt19937_64 random(56);
  Pose X_AB = bodies::random_pose(random, 0.1);
  X_AB.t.x() += 0.5;
  const auto with = [&](unsigned threads) {
    PenetrationDepth found;
    parallel::with_threads(threads, [&] { found = oracle.evaluate(X_AB, {.tolerance = 1e-2, .budget = 100'000}); });
    return found;
  };
  const PenetrationDepth one = with(1), two = with(2);
  EXPECT_EQ(one.lo, two.lo);
  EXPECT_EQ(one.hi, two.hi);
  EXPECT_EQ(one.translation, two.translation);
  EXPECT_EQ(one.measurements, two.measurements);
  EXPECT_EQ(one.cells, two.cells);
}

TEST(Penetration, RefusesWhatItCannotTake) {
  const Mesh a = box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  const Mesh open = Mesh::build(a.vertices(), {a.triangles()[0], a.triangles()[1]}, "open");
  EXPECT_THROW(PenetrationOracle(a, open), BadMesh);
  const PenetrationOracle oracle(a, a);
  EXPECT_THROW(oracle.evaluate(shift(std::numeric_limits<double>::quiet_NaN(), 0, 0)), BadArgument);
  EXPECT_THROW(oracle.evaluate({2.0 * Matrix3d::Identity(), Vector3d::Zero()}), BadArgument);
  EXPECT_THROW(oracle.evaluate(shift(0, 0, 0), {.tolerance = 0.0}), BadArgument);
  EXPECT_THROW(oracle.evaluate(shift(0, 0, 0), {.budget = 0}), BadArgument);
}

TEST(DirectionalDepth, IsTheWayBackToTheFirstContactOfARay) {
  const Mesh a = bodies::bumpy_torus(40, 20), b = bodies::bumpy_sphere(3, 0.15, 0.3);
  const PenetrationOracle oracle(a, b);
  const auto solver = make_ray_cast()->prepare(a, b);
  std::mt19937_64 random(57);
  for (int i = 0; i < 12; ++i) {
    const Pose turned = bodies::random_pose(random, 1.0);
    const Vector3d u = bodies::random_pose(random, 1.0).t.normalized();
    solver->set_rotation(turned.quaternion());
    const std::array<double, 1> target{1e-10};
    std::array<double, 1> contact{}, residual{};
    solver->solve(u, target, contact, residual);
    if (!(contact[0] > 0.1)) continue;  // the ray passes by, or B is nearly in the hole
    const double depth = 0.01 * (1 + i % 5);
    const Pose X_AB{turned.R, a.center() + (contact[0] - depth) * u - turned.R * b.center()};
    const std::optional<double> found = oracle.directional_depth(X_AB, u);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, depth, 10.0 * k_of_cast) << i;  // the target, over the slope at which the ray meets it
    EXPECT_LE(oracle.evaluate(X_AB, {.tolerance = 0.3, .budget = 20'000}).lo, depth + k_of_hi);
  }
}

TEST(DirectionalDepth, IsThatOfBoxes) {
  const Mesh a = box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}), b = box({-0.2, -0.3, -0.4}, {0.2, 0.3, 0.4});
  const PenetrationOracle oracle(a, b);
  const Pose X_AB = shift(0.6, 0.21, -0.1);
  EXPECT_NEAR(*oracle.directional_depth(X_AB, Vector3d::UnitX()), 0.1, k_of_cast);
  EXPECT_NEAR(*oracle.directional_depth(X_AB, -Vector3d::UnitX()), 0.7 + 0.6, k_of_cast);
  const Vector3d u = Vector3d(1.0, 0.2, -0.1).normalized();
  EXPECT_NEAR(*oracle.directional_depth(X_AB, u), 0.1 / u.x(), k_of_cast);
  EXPECT_EQ(*oracle.directional_depth(shift(2.0, 0.1, 0.0), Vector3d::UnitX()), 0.0);
}

}  // namespace
}  // namespace sixdof
