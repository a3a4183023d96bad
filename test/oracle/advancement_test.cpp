#include <sixdof/oracle/advancement.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "motions.h"

namespace sixdof {
namespace {

using Eigen::Vector3d;
using motions::Bodies;
using shapes::Generator;
using Kind = ImpactBracket::Kind;

/// Of closed forms in coordinates of a few units.
constexpr double k_rounding = 1e-13;

TEST(Advancement, BoxMeetsBox) {
  const Mesh a = shapes::box({0.5, 0.4, 0.3}), b = shapes::box({0.2, 0.3, 0.4}, {0.1, 0.0, -0.2});
  Bodies bodies(a, b);
  // From x = 2 at the centre's place; contact where it is 0.5 + 0.2.
  const Motion motion = Motion::of(b, {.t = {1.9, 0.1, 0.25}}, {-3.0, 0.2, 0.0});
  const ImpactBracket bracket = bodies.bracket(motion);
  ASSERT_EQ(bracket.kind, Kind::hit);
  EXPECT_LE(bracket.t_free, 1.3 / 3.0 + k_rounding);
  EXPECT_GE(bracket.t_touch, 1.3 / 3.0 - k_rounding);
  EXPECT_LE(bracket.t_touch - bracket.t_free, k_bracket_width + k_rounding);
}

/// A rod with square ends swings about a point on its axis down to a floor.
TEST(Advancement, RodSwingsIntoAFloor) {
  constexpr double k_length = 1.5, k_half = 0.05, k_height = 0.9;
  const Mesh floor = shapes::box({4.0, 0.5, 4.0}, {0.0, -0.5, 0.0});
  const Mesh rod = shapes::box({0.5 * k_length, k_half, k_half}, {0.5 * k_length, 0.0, 0.0});
  Bodies bodies(floor, rod);
  Motion motion{.start = {.t = {0.0, k_height, 0.0}}, .rotation = {0.0, 0.0, -1.4}};
  motion.reference.setZero();
  // The lower corner of the end is at height h - L sin x - w cos x.
  const double angle = std::asin(k_height / std::hypot(k_length, k_half)) - std::atan2(k_half, k_length);
  const ImpactBracket bracket = bodies.bracket(motion);
  ASSERT_EQ(bracket.kind, Kind::hit);
  EXPECT_LE(bracket.t_free, angle / 1.4 + k_rounding);
  EXPECT_GE(bracket.t_touch, angle / 1.4 - k_rounding);
  motion.rotation.z() = -0.99 * angle;
  EXPECT_EQ(bodies.bracket(motion).kind, Kind::none);
}

TEST(Advancement, SpeedBoundIsReachedAndNeverExceeded) {
  Generator generator(3);
  const Mesh b = shapes::box({0.5, 0.2, 0.3}, {1.0, 2.0, -3.0});
  for (int i = 0; i < 100; ++i) {
    Motion motion = motions::random_motion(b, b, generator, i % 3);
    if (i % 2 == 0) motion.start.R *= 1.0 + 1e-3;  // a stretch counts
    const double bound = speed_bound(motion, b.box());
    double fastest = 0.0;
    constexpr double k_step = 1e-5;
    constexpr double k_difference = 1e-8;  // rounding of two poses, some 1e-14, over the step
    for (double t = 0.0; t < 1.0; t += 0.01) {
      for (const Vector3d& p : b.vertices()) {
        fastest = std::max(fastest, (motion.pose_at(t + k_step) * p - motion.pose_at(t) * p).norm() / k_step);
      }
    }
    EXPECT_LE(fastest, bound * (1.0 + 1e-9) + k_difference);
    if (motion.is_translation()) {
      EXPECT_GE(fastest, bound * (1.0 - 1e-9) - k_difference);
    }
    if (motion.translation.isZero()) {
      EXPECT_GE(fastest, bound * (1.0 - 1e-4)) << "a corner of the box is a vertex here";
    }
  }
}

TEST(Advancement, ExtremeMotions) {
  const Mesh a = shapes::bumpy_sphere(1, 0.2), b = shapes::rod(7, 0.3);
  Bodies bodies(a, b);
  const double size = a.diagonal();
  const Pose away{.t = {3.0, 0.2, 0.1}};
  EXPECT_EQ(bodies.bracket(Motion::of(b, away, Vector3d::Zero())).kind, Kind::none) << "no motion";
  EXPECT_EQ(bodies.bracket(Motion::of(b, {}, Vector3d::Zero())).kind, Kind::at_start) << "no motion, inside";
  EXPECT_EQ(bodies.bracket(Motion::of(b, {.t = {0.9, 0.0, 0.0}}, {1.0, 0.0, 0.0})).kind, Kind::at_start);
  EXPECT_EQ(bodies.bracket(Motion::of(b, away, {1e6 * size, 0.0, 0.0})).kind, Kind::none);
  EXPECT_EQ(bodies.bracket(Motion::of(b, away, {-1e6 * size, 0.0, 0.0})).kind, Kind::hit);
  EXPECT_EQ(bodies.bracket(Motion::of(b, {.t = {1e6, 0.2, 0.1}}, {-2e6, 0.0, 0.0})).kind, Kind::hit) << "from afar";
  EXPECT_EQ(bodies.bracket(Motion::of(b, away, {-1e-9 * size, 0.0, 0.0})).kind, Kind::none);
  EXPECT_EQ(bodies.bracket(Motion::of(b, away, Vector3d::Zero(), {0.0, 0.0, 30.0})).kind, Kind::none) << "spins, apart";
  Motion swing = Motion::of(b, away, Vector3d::Zero(), {0.0, 0.0, 2.9 * std::numbers::pi});
  swing.reference = {0.0, 3.0, 0.0};
  EXPECT_EQ(bodies.bracket(swing).kind, Kind::none);
  EXPECT_EQ(bodies.bracket(Motion::of(b, away, {-6.0, 0.0, 0.0}, {0.0, 0.0, 300.0})).kind, Kind::hit);
}

TEST(Advancement, TinyMotionIntoContact) {
  const Mesh a = shapes::box({0.5, 0.4, 0.3}), b = shapes::box({0.2, 0.3, 0.4});
  Bodies bodies(a, b);
  const Motion motion = Motion::of(b, {.t = {0.7 + 0.5e-9, 0.01, 0.02}}, {-1e-9, 0.0, 0.0});
  const ImpactBracket bracket = bodies.bracket(motion);
  ASSERT_EQ(bracket.kind, Kind::hit);
  const double width = bracket_width(motion, b.box());
  EXPECT_NEAR(bracket.t_touch, 0.5, width);
  EXPECT_LT(width, 1e-3) << "eight roundings of poses of size 1, in units of a motion of 1e-9";
}

TEST(Advancement, FacesThatSlideOnEachOtherAreGrazing) {
  const Mesh a = shapes::box({0.5, 0.4, 0.3}), b = shapes::box({0.2, 0.3, 0.4});
  Bodies bodies(a, b);
  const double above = std::nextafter(0.7, 1.0) + 1e-16;
  const Motion motion = Motion::of(b, {.t = {above, 0.01, 0.02}}, {0.0, 0.5, 0.0});
  const Kind kind = bodies.bracket(motion).kind;
  EXPECT_TRUE(kind == Kind::grazing || kind == Kind::at_start);
}

TEST(Advancement, DenseSamplingFindsNoEarlierContact) {
  Generator generator(7);
  const Mesh a = shapes::bumpy_sphere(1, 0.3), b = shapes::rod(5, 0.2);
  Bodies bodies(a, b);
  int hits = 0, misses = 0, grazing = 0;
  constexpr int k_samples = 200;
  for (int i = 0; i < 60; ++i) {
    const Motion motion = motions::random_motion(a, b, generator, i % 3);
    const ImpactBracket bracket = bodies.bracket(motion);
    const auto sample = motions::first_touching_sample(a, b, motion, k_samples);
    if (bracket.kind == Kind::grazing) ++grazing;
    if (bracket.kind == Kind::none) {
      EXPECT_FALSE(sample) << i;
    }
    if (bracket.kind == Kind::at_start) {
      EXPECT_TRUE(motions::touches(a, b, motion.start)) << i;
    }
    if (sample) {
      EXPECT_GT(*sample, bracket.kind == Kind::at_start ? -1.0 : bracket.t_free) << i;
    }
    if (bracket.kind == Kind::hit) {
      EXPECT_TRUE(motions::touches(a, b, motion.pose_at(bracket.t_touch))) << i;
    }
    hits += bracket.kind == Kind::hit ? 1 : 0;
    misses += bracket.kind == Kind::none ? 1 : 0;
  }
  EXPECT_GT(hits, 20);
  EXPECT_GT(misses, 3);
  EXPECT_EQ(grazing, 0);
}

TEST(Advancement, AnUnsafeBoundIsCaught) {
  Generator generator(7);
  const Mesh a = shapes::bumpy_sphere(1, 0.3), b = shapes::rod(5, 0.2);
  Bodies bodies(a, b);
  int late = 0;
  for (int i = 0; i < 60; ++i) {
    const Motion motion = motions::random_motion(a, b, generator, i % 3);
    const ImpactBracket safe = bodies.bracket(motion);
    const ImpactBracket unsafe = advance(bodies.query, b.box(), motion, {.speed_factor = 0.3});
    if (safe.kind == Kind::hit && unsafe.t_free > safe.t_touch) ++late;
  }
  EXPECT_GT(late, 5);
}

TEST(Advancement, RefusesWhatIsNoMotion) {
  const Mesh a = shapes::box({0.5, 0.4, 0.3});
  Bodies bodies(a, a);
  EXPECT_THROW(bodies.bracket(Motion{.rotation = {std::nan(""), 0.0, 0.0}}), BadArgument);
}

}  // namespace
}  // namespace sixdof
