#include <sixdof/oracle/cast_search.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "motions.h"

namespace sixdof {
namespace {

using Eigen::Vector3d;
using motions::Bodies;
using shapes::Generator;
using Kind = ImpactBracket::Kind;

/// Of closed forms in coordinates of a few units.
constexpr double k_rounding = 1e-13;

void expect_time(const Outcome<Impact>& answer, double t) {
  ASSERT_TRUE(answer.ok());
  ASSERT_TRUE(answer.value.hit);
  EXPECT_LE(answer.value.t, t + k_rounding) << "late";
  EXPECT_GE(answer.value.t, t - CastSearch::k_resolution - k_rounding) << "early";
}

TEST(CastSearch, BoxMeetsBox) {
  const Mesh a = shapes::box({0.5, 0.4, 0.3}), b = shapes::box({0.2, 0.3, 0.4}, {0.1, 0.0, -0.2});
  Bodies bodies(a, b);
  const Outcome<Impact> answer = bodies.cast(Motion::of(b, {.t = {1.9, 0.1, 0.25}}, {-3.0, 0.2, 0.0}));
  expect_time(answer, 1.3 / 3.0);
  EXPECT_NEAR(answer.value.normal.x(), 1.0, 1e-6) << "from A to B";
  EXPECT_NEAR(answer.value.witness_a.x(), 0.5, 1e-9);
  EXPECT_NEAR(answer.value.witness_b.x(), 0.5, 1e-9);
}

TEST(CastSearch, RodSwingsIntoAFloor) {
  constexpr double k_length = 1.5, k_half = 0.05, k_height = 0.9;
  const Mesh floor = shapes::box({4.0, 0.5, 4.0}, {0.0, -0.5, 0.0});
  const Mesh rod = shapes::box({0.5 * k_length, k_half, k_half}, {0.5 * k_length, 0.0, 0.0});
  Bodies bodies(floor, rod);
  Motion motion{.start = {.t = {0.0, k_height, 0.0}}, .rotation = {0.0, 0.0, -1.4}};
  const double angle = std::asin(k_height / std::hypot(k_length, k_half)) - std::atan2(k_half, k_length);
  expect_time(bodies.cast(motion), angle / 1.4);
  // The other way round it comes down on the other side.
  motion.rotation.z() = 2.0 * std::numbers::pi;
  expect_time(bodies.cast(motion), 0.5 + angle / (2.0 * std::numbers::pi));
  motion.rotation.z() = -0.99 * angle;
  EXPECT_FALSE(bodies.cast(motion).value.hit);
}

TEST(CastSearch, SpinningSphereMeetsSphere) {
  const Mesh a = shapes::bumpy_sphere(4, 0.0, 1.0), b = shapes::bumpy_sphere(4, 0.0, 0.7, {0.3, 0.1, 0.0});
  Bodies bodies(a, b);
  // The triangles lie inside of the spheres, by less than this: half the square of their circumradius.
  constexpr double k_sagitta = 1.5e-3;
  for (const double spin : {0.0, 1.0, 25.0}) {
    const Motion motion = Motion::of(b, {.t = {2.7, 0.4, 0.2}}, {-4.0, 0.0, 0.0}, spin * Vector3d(0.6, 0.0, 0.8));
    // Centres: (3, 0.5, 0.2) - (4 t, 0, 0), at a distance of 1.7.
    const double x = std::sqrt(1.7 * 1.7 - 0.5 * 0.5 - 0.2 * 0.2);
    const double t = (3.0 - x) / 4.0, steepness = x / 1.7;
    const Outcome<Impact> answer = bodies.cast(motion);
    ASSERT_TRUE(answer.ok() && answer.value.hit);
    EXPECT_GE(answer.value.t, t - 1e-9);
    EXPECT_LE(answer.value.t, t + 2.0 * k_sagitta / (4.0 * steepness));
  }
}

/// The truth is another method's.
TEST(CastSearch, AgreesWithAdvancement) {
  Generator generator(11);
  const Mesh meshes[] = {shapes::bumpy_sphere(2, 0.3), shapes::rod(9, 0.1), shapes::soup(generator, 60, 0.8, 0.3),
                         shapes::box({0.9, 0.01, 0.6})};
  int hits = 0, misses = 0, grazing = 0;
  for (int i = 0; i < 600; ++i) {
    const Mesh &a = meshes[i % 4], &b = meshes[(i / 4) % 4];
    Bodies bodies(a, b);
    Motion motion = motions::random_motion(a, b, generator, i % 3);
    if (i % 7 == 0) motion.start.R *= 1.0 + 1e-10;
    const ImpactBracket truth = bodies.bracket(motion);
    const Outcome<Impact> answer = bodies.cast(motion);
    ASSERT_TRUE(answer.ok()) << i;
    if (truth.kind == Kind::grazing) {
      ++grazing;
      continue;
    }
    EXPECT_EQ(answer.value.hit, truth.kind != Kind::none) << i;
    EXPECT_EQ(answer.value.at_start(), truth.kind == Kind::at_start) << i;
    if (truth.kind == Kind::hit) {
      EXPECT_LE(answer.value.t, truth.t_touch) << i;
      EXPECT_GE(answer.value.t, truth.t_free - CastSearch::k_resolution) << i;
      EXPECT_NEAR(answer.value.normal.norm(), 1.0, 1e-12) << i;
    }
    hits += truth.kind == Kind::hit ? 1 : 0;
    misses += truth.kind == Kind::none ? 1 : 0;
  }
  EXPECT_GT(hits, 200);
  EXPECT_GT(misses, 30);
  EXPECT_LT(grazing, 3);
}

/// A moves against B with the inverse motion.
TEST(CastSearch, BothOrdersAgree) {
  Generator generator(12);
  const Mesh a = shapes::bumpy_sphere(2, 0.3), b = shapes::rod(9, 0.1);
  Bodies forward(a, b), backward(b, a);
  for (int i = 0; i < 100; ++i) {
    Motion motion = motions::random_motion(a, b, generator, i % 3);
    if (i % 3 == 2) motion.translation = 0.3 * motion.rotation;  // a screw
    const auto inverse = motion.inverse();
    ASSERT_TRUE(inverse) << i;
    const Outcome<Impact> one = forward.cast(motion), other = backward.cast(*inverse);
    ASSERT_TRUE(one.ok() && other.ok()) << i;
    EXPECT_EQ(one.value.hit, other.value.hit) << i;
    EXPECT_NEAR(one.value.t, other.value.t, 2.0 * CastSearch::k_resolution) << i;
  }
}

TEST(CastSearch, ScaleAndARigidMotionOfTheWholeChangeNothing) {
  Generator generator(13);
  const Mesh a = shapes::bumpy_sphere(2, 0.3), b = shapes::rod(9, 0.1);
  Bodies bodies(a, b);
  for (const double scale : {1e-6, 1e6}) {
    const Pose X = shapes::random_pose(generator, 3.0);
    const auto transformed = [&](const Mesh& mesh, const Pose& by) {
      std::vector<Vector3d> v = mesh.vertices();
      for (Vector3d& p : v) p = scale * (by * p);
      return Mesh::build(std::move(v), mesh.triangles(), mesh.name());
    };
    const Mesh other_a = transformed(a, X), other_b = transformed(b, {});
    Bodies other(other_a, other_b);
    for (int i = 0; i < 60; ++i) {
      const Motion motion = motions::random_motion(a, b, generator, i % 3);
      Motion same{X * motion.start, scale * (X.R * motion.translation), X.R * motion.rotation,
                  scale * motion.reference};
      same.start.t *= scale;
      const Outcome<Impact> one = bodies.cast(motion), two = other.cast(same);
      ASSERT_TRUE(one.ok() && two.ok());
      EXPECT_EQ(one.value.hit, two.value.hit) << i;
      EXPECT_NEAR(one.value.t, two.value.t, 2.0 * CastSearch::k_resolution) << i;
    }
  }
}

TEST(CastSearch, ExtremeMotions) {
  const Mesh a = shapes::bumpy_sphere(1, 0.2), b = shapes::rod(7, 0.3);
  Bodies bodies(a, b);
  const Pose away{.t = {3.0, 0.2, 0.1}};
  EXPECT_FALSE(bodies.cast(Motion::of(b, away, Vector3d::Zero())).value.hit) << "no motion";
  EXPECT_TRUE(bodies.cast(Motion::of(b, {}, Vector3d::Zero())).value.at_start()) << "no motion, inside";
  EXPECT_FALSE(bodies.cast(Motion::of(b, away, {1e6, 0.0, 0.0})).value.hit);
  EXPECT_FALSE(bodies.cast(Motion::of(b, away, {-1e-9, 0.0, 0.0})).value.hit);
  EXPECT_FALSE(bodies.cast(Motion::of(b, away, Vector3d::Zero(), {0.0, 0.0, 3000.0})).value.hit) << "spins, apart";
  for (const Motion& motion :
       {Motion::of(b, away, {-1e6, 0.0, 0.0}), Motion::of(b, {.t = {1e6, 0.2, 0.1}}, {-2e6, 0, 0}),
        Motion::of(b, away, {-6.0, 0.0, 0.0}, {0.0, 0.0, 300.0})}) {
    const ImpactBracket truth = bodies.bracket(motion);
    const Outcome<Impact> answer = bodies.cast(motion);
    ASSERT_EQ(truth.kind, Kind::hit);
    ASSERT_TRUE(answer.ok() && answer.value.hit);
    EXPECT_LE(answer.value.t, truth.t_touch);
    EXPECT_GE(answer.value.t, truth.t_free - 2e-9);
  }
}

TEST(CastSearch, NeedlePassesARing) {
  const Mesh needle = shapes::rod(12, 0.05);
  std::vector<Vector3d> v;
  std::vector<Triangle> t;
  constexpr std::uint32_t k_around = 40, k_across = 12;
  for (std::uint32_t i = 0; i < k_around; ++i) {
    for (std::uint32_t j = 0; j < k_across; ++j) {
      const double around = 2.0 * std::numbers::pi * i / k_around, across = 2.0 * std::numbers::pi * j / k_across;
      const double r = 0.2 + 0.1 * std::cos(across);
      v.emplace_back(r * std::cos(around), r * std::sin(around), 0.1 * std::sin(across));
      const std::uint32_t p = i * k_across + j, q = (i + 1) % k_around * k_across + j;
      const std::uint32_t r2 = (i + 1) % k_around * k_across + (j + 1) % k_across,
                          s = i * k_across + (j + 1) % k_across;
      t.insert(t.end(), {{p, q, r2}, {p, r2, s}});
    }
  }
  const Mesh ring = Mesh::build(std::move(v), std::move(t), "ring");
  Bodies bodies(ring, needle);
  const Motion through = Motion::of(needle, {.t = {0.01, 0.02, 3.0}}, {0.0, 0.0, -6.0}, {0.0, 0.0, 9.0});
  EXPECT_FALSE(bodies.cast(through).value.hit);
  const Motion beside = Motion::of(needle, {.t = {0.12, 0.02, 3.0}}, {0.0, 0.0, -6.0}, {0.0, 0.0, 9.0});
  EXPECT_TRUE(bodies.cast(beside).value.hit);
}

TEST(CastSearch, DenseSamplingFindsNoEarlierContact) {
  Generator generator(17);
  const Mesh a = shapes::bumpy_sphere(1, 0.3), b = shapes::rod(5, 0.2);
  Bodies bodies(a, b);
  for (int i = 0; i < 40; ++i) {
    const Motion motion = motions::random_motion(a, b, generator, i % 3);
    const Outcome<Impact> answer = bodies.cast(motion);
    const auto sample = motions::first_touching_sample(a, b, motion, 150);
    ASSERT_TRUE(answer.ok());
    if (!answer.value.hit) {
      EXPECT_FALSE(sample) << i;
    }
    if (sample && answer.value.hit) {
      EXPECT_GE(*sample, answer.value.t) << i;
    }
  }
}

TEST(CastSearch, AnUnsafeBoundIsCaught) {
  Generator generator(11);
  const Mesh a = shapes::bumpy_sphere(2, 0.3), b = shapes::rod(9, 0.1);
  Bodies bodies(a, b);
  bodies.search.speed_factor = 0.5;
  int wrong = 0;
  for (int i = 0; i < 60; ++i) {
    const Motion motion = motions::random_motion(a, b, generator, 1 + i % 2);
    const ImpactBracket truth = bodies.bracket(motion);
    const Outcome<Impact> answer = bodies.cast(motion);
    if (truth.kind == Kind::hit && (!answer.value.hit || answer.value.t > truth.t_touch)) ++wrong;
  }
  EXPECT_GT(wrong, 5);
}

}  // namespace
}  // namespace sixdof
