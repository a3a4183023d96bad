#include <sixdof/oracle/translation_cast.h>

#include <cmath>

#include <gtest/gtest.h>

#include "motions.h"

namespace sixdof {
namespace {

using Eigen::Vector3d;
using motions::Bodies;
using shapes::Generator;

/// The same with its start so far back that nothing touches there, over the same end.
Motion from_outside(const Motion& motion, double size) {
  const double back = 4.0 * size / motion.translation.norm() + 1.0;
  Motion longer = motion;
  longer.start.t -= back * motion.translation;
  longer.translation *= 1.0 + back;
  return longer;
}

TEST(TranslationCast, IsApartUpToTheFirstContactAndNamesAPairThatTouches) {
  Generator generator(5);
  const Mesh meshes[] = {shapes::bumpy_sphere(2, 0.3), shapes::rod(9, 0.1), shapes::soup(generator, 60, 0.8, 0.3),
                         shapes::box({0.9, 0.01, 0.6}), shapes::box({0.5, 0.5, 0.5})};
  int hits = 0, misses = 0, behind = 0;
  for (int i = 0; i < 1000; ++i) {
    const Mesh &a = meshes[i % 5], &b = meshes[(i / 5) % 5];
    Bodies bodies(a, b);
    Motion motion = motions::random_motion(a, b, generator, 0);
    // Every third begins near A, often behind what it would have met on its way.
    if (i % 3 == 0) motion.start.t += shapes::uniform(generator, 0.2, 0.8) * motion.translation;
    const double size = a.diagonal() + b.diagonal();
    const auto apart = bodies.translations.find(motion);
    const Outcome<Impact> other = bodies.search.find(motion);
    ASSERT_TRUE(other.ok()) << i;
    if (!apart) {
      ++behind;
      const Motion longer = from_outside(motion, size);
      const double start = 1.0 - motion.translation.norm() / longer.translation.norm();
      const Outcome<Impact> before = bodies.search.find(longer);
      ASSERT_TRUE(before.ok() && before.value.hit) << i;
      EXPECT_LE(before.value.t, start + 1e-9) << i;
      continue;
    }
    EXPECT_FALSE(bodies.query.collide(motion.start)) << i;
    ASSERT_EQ(apart->next.has_value(), other.value.hit) << i;
    if (!apart->next) {
      ++misses;
      EXPECT_EQ(apart->t, 1.0);
      continue;
    }
    ++hits;
    EXPECT_GT(bodies.query.distance(motion.pose_at(apart->t)).distance, 0.0) << i;
    const Outcome<Impact> found = bodies.search.find_after(motion, apart->t, *apart->next);
    ASSERT_TRUE(found.ok() && found.value.hit) << i;
    EXPECT_GE(found.value.t, apart->t) << i;
    EXPECT_NEAR(found.value.t, other.value.t, 2.0 * CastSearch::k_resolution) << i;
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(misses, 50);
  EXPECT_GT(behind, 100);
}

TEST(TranslationCast, ClosedForms) {
  const Mesh a = shapes::box({0.5, 0.4, 0.3}), b = shapes::box({0.2, 0.3, 0.4}, {0.1, 0.0, -0.2});
  Bodies bodies(a, b);
  // Faces of x = 0.5 and x = 1.8 - 3 t, past the centre of A's box and through it.
  for (const Vector3d& to : {Vector3d(1.9, 0.1, 0.25), Vector3d(1.9, 0.0, 0.2), Vector3d(1.9, -0.5, 0.7)}) {
    const auto apart = bodies.translations.find(Motion::of(b, {.t = to}, {-3.0, 0.0, 0.0}));
    ASSERT_TRUE(apart && apart->next);
    EXPECT_LE(apart->t, 1.3 / 3.0 + 1e-15);
    EXPECT_GE(apart->t, 1.3 / 3.0 - 1e-12);
  }
  // Past A's face at y = 0.4 by a hair.
  EXPECT_EQ(bodies.translations.find(Motion::of(b, {.t = {1.9, 0.7 + 1e-9, 0.2}}, {-3.0, 0.0, 0.0}))->next,
            std::nullopt);
  EXPECT_TRUE(bodies.translations.find(Motion::of(b, {.t = {1.9, 0.7 - 1e-9, 0.2}}, {-3.0, 0.0, 0.0}))->next);
  // Ends just before contact, passes far away, ends far away.
  for (const Motion& motion : {Motion::of(b, {.t = {1.9, 0.1, 0.2}}, {-1.3 + 1e-9, 0.0, 0.0}),
                               Motion::of(b, {.t = {1.9, 5.0, 0.2}}, {-3.0, 0.0, 0.0}),
                               Motion::of(b, {.t = {19.0, 0.0, 0.2}}, {-3.0, 0.0, 0.0})}) {
    const auto apart = bodies.translations.find(motion);
    ASSERT_TRUE(apart);
    EXPECT_EQ(apart->t, 1.0);
    EXPECT_FALSE(apart->next);
  }
}

TEST(TranslationCast, LeavesToOthersWhatItCannotTell) {
  const Mesh a = shapes::box({0.5, 0.4, 0.3}), b = shapes::box({0.2, 0.3, 0.4});
  Bodies bodies(a, b);
  const Pose away{.t = {1.9, 0.1, 0.25}};
  EXPECT_FALSE(bodies.translations.find(Motion::of(b, away, {-3.0, 0.0, 0.0}, {0.0, 0.0, 1e-6}))) << "rotates";
  EXPECT_FALSE(bodies.translations.find(Motion::of(b, away, Vector3d::Zero()))) << "does not move";
  EXPECT_FALSE(bodies.translations.find(Motion::of(b, {}, {-3.0, 0.0, 0.0}))) << "begins inside";
  EXPECT_FALSE(bodies.translations.find(Motion::of(b, {.t = {-1.9, 0.1, 0.25}}, {-3.0, 0.0, 0.0}))) << "begins behind";
  EXPECT_FALSE(bodies.translations.find(Motion::of(b, away, {3.0, 0.0, 0.0}))) << "recedes: it came from behind";
  Motion stretched = Motion::of(b, away, {-3.0, 0.0, 0.0});
  stretched.start.R *= 1.0 + 1e-10;
  EXPECT_FALSE(bodies.translations.find(stretched)) << "no rotation";
  EXPECT_FALSE(bodies.translations.find(Motion::of(b, {.t = {1e9, 0.0, 0.0}}, {-2e9, 0.0, 0.0}))) << "too far";
}

/// A body in a cavity: what it would have met from outside is behind it.
TEST(TranslationCast, InACavityTheOtherSearchAnswers) {
  const Mesh outer = shapes::box({1.0, 1.0, 1.0}), ball = shapes::bumpy_sphere(2, 0.0, 0.3);
  Bodies bodies(outer, ball);
  const Motion motion = Motion::of(ball, {}, {2.0, 0.0, 0.0});
  EXPECT_FALSE(bodies.translations.find(motion));
  const Outcome<Impact> found = bodies.search.find(motion);
  ASSERT_TRUE(found.ok() && found.value.hit);
  EXPECT_NEAR(found.value.t, 0.35, 2e-3);
}

TEST(CastSearch, AfterATimeFindsWhatIsFirstWhateverPairIsGuessed) {
  Generator generator(6);
  const Mesh a = shapes::bumpy_sphere(2, 0.3), b = shapes::rod(9, 0.1);
  Bodies bodies(a, b);
  int hits = 0;
  for (int i = 0; i < 60; ++i) {
    const Motion motion = motions::random_motion(a, b, generator, i % 3);
    if (bodies.query.collide(motion.start)) continue;
    const Outcome<Impact> first = bodies.search.find(motion);
    if (!first.value.hit) continue;
    ++hits;
    for (const std::uint32_t guess : {0u, 17u}) {
      const Outcome<Impact> found = bodies.search.find_after(motion, 0.5 * first.value.t, {guess, guess});
      ASSERT_TRUE(found.ok() && found.value.hit) << i;
      EXPECT_NEAR(found.value.t, first.value.t, 2.0 * CastSearch::k_resolution) << i;
    }
  }
  EXPECT_GT(hits, 20);
}

}  // namespace
}  // namespace sixdof
