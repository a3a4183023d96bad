#include <sixdof/generation/impact_truth.h>

#include <gtest/gtest.h>

#include <sixdof/configuration/grid.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/generation/motions.h>
#include <sixdof/generation/stored_impacts.h>
#include <sixdof/oracle/cast_search.h>
#include <sixdof/oracle/impact_verdict.h>

#include "../oracle/bodies.h"
#include "../oracle/motions.h"

namespace sixdof {
namespace {

using Kind = ImpactBracket::Kind;

/// Poses of contact as a set has them.
std::vector<Pose> contacts_of(const Mesh& a, const Mesh& b, const char* grid_name) {
  const Grid grid = make_grid(grid_name);
  const double percents[] = {0.0};
  const Generated generated = generate_distances(*make_ray_cast(), a, b, grid, percents);
  std::vector<Pose> poses;
  for (std::size_t r = 0; r < grid.rotations.size(); ++r) {
    for (std::size_t u = 0; u < grid.directions.size(); ++u) {
      const double s = generated.buckets[0].translations[r * grid.directions.size() + u];
      if (!std::isnan(s)) poses.push_back(ConfigurationRay(a, b, grid.rotations[r], grid.directions[u]).pose(s));
    }
  }
  return poses;
}

class OfASet : public ::testing::Test {
 protected:
  const Mesh a_ = bodies::bumpy_torus(24, 12), b_ = bodies::bumpy_sphere(3);
  const std::vector<Pose> contacts_ = contacts_of(a_, b_, "so3:6:8");
  ImpactTruth truth_{a_, b_};
};

TEST_F(OfASet, TranslationsEndWhereTheRayCastDoes) {
  std::size_t by_ray_cast = 0, hits = 0;
  for (const double percent : k_motion_steps) {
    const auto motions = motions_of(contacts_, a_, b_, MotionKind::translation, percent, 3);
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const TrueImpact impact = truth_.find(motions[i]);
      by_ray_cast += impact.by_ray_cast ? 1 : 0;
      hits += impact.bracket.kind == Kind::hit ? 1 : 0;
      if (i % 4 == 3) continue;  // passes A
      ASSERT_EQ(impact.bracket.kind, Kind::hit) << percent << ' ' << i;
      // The pose of contact lies on the way.
      const double t = (contacts_[i].t - motions[i].start.t).norm() / motions[i].translation.norm();
      EXPECT_NEAR(impact.bracket.t_touch, t, 1e-9 + 1e-10 / percent * 100.0);
      EXPECT_LE(impact.bracket.t_touch - impact.bracket.t_free, bracket_width(motions[i], b_.box()));
    }
  }
  EXPECT_GT(by_ray_cast, contacts_.size()) << "of four times as many";
  EXPECT_GE(hits, contacts_.size() * 3);
}

TEST_F(OfASet, RayCastAndAdvancementAgree) {
  DistanceOracle oracle(a_, b_);
  DistanceQuery query(oracle);
  for (const auto& motion : motions_of(contacts_, a_, b_, MotionKind::translation, 30.0, 4)) {
    const ImpactBracket by_ray = truth_.find(motion).bracket, alone = advance(query, b_.box(), motion);
    ASSERT_EQ(by_ray.kind, alone.kind);
    EXPECT_NEAR(by_ray.t_touch, alone.t_touch, k_bracket_width);
  }
}

TEST_F(OfASet, ExactIsNeverWrong) {
  const DistanceOracle oracle(a_, b_);
  DistanceQuery query(oracle);
  CastSearch search(oracle.tree_a(), oracle.tree_b());
  std::size_t hits = 0, misses = 0, grazing = 0;
  for (const MotionKind kind : k_motion_kinds) {
    for (const double percent : k_motion_steps) {
      for (const Motion& motion : motions_of(contacts_, a_, b_, kind, percent, 5)) {
        const ImpactBracket truth = truth_.find(motion).bracket;
        const Outcome<Impact> answer =
            query.collide(motion.start) ? Outcome<Impact>(Impact{.hit = true}) : search.find(motion);
        const JudgedImpact judged = judge_impact(truth, answer, impact_tolerance(motion, b_.box(), a_.diagonal()));
        hits += truth.kind == Kind::hit ? 1 : 0;
        misses += truth.kind == Kind::none ? 1 : 0;
        grazing += truth.kind == Kind::grazing ? 1 : 0;
        EXPECT_TRUE(judged.verdict == ImpactVerdict::right || judged.verdict == ImpactVerdict::not_judged)
            << to_string(judged.verdict) << ", " << to_string(kind) << ' ' << percent;
      }
    }
  }
  EXPECT_GT(hits, 200u);
  EXPECT_GT(misses, 50u);
  EXPECT_LE(grazing, (hits + misses) / 100);
}

TEST(ImpactTruth, BehindAHitFromOutsideItAdvances) {
  const Mesh a = bodies::bumpy_torus(24, 12), b = shapes::bumpy_sphere(1, 0.1, 0.1);
  ImpactTruth truth(a, b);
  // From the hole of the torus outwards to its inner side: towards A's centre from beyond it, as the ray cast sees it.
  const Motion motion = Motion::of(b, {.t = {0.05, 0.0, 0.0}}, {-0.5, 0.0, 0.0});
  const TrueImpact impact = truth.find(motion);
  EXPECT_FALSE(impact.by_ray_cast);
  EXPECT_EQ(impact.bracket.kind, Kind::hit);
}

TEST(StoredImpacts, AreThoseOfTheTruth) {
  const Mesh a = bodies::bumpy_torus(16, 8), b = bodies::bumpy_sphere(2);
  shapes::Generator generator(9);
  std::vector<Motion> motions;
  for (int i = 0; i < 12; ++i) motions.push_back(motions::random_motion(a, b, generator, i % 3));
  const auto made = stored_impacts(a, b, motions), read = stored_impacts(a, b, motions);
  ImpactTruth truth(a, b);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const ImpactBracket bracket = truth.find(motions[i]).bracket;
    for (const ImpactBracket& stored : {made[i], read[i]}) {
      EXPECT_EQ(stored.kind, bracket.kind);
      EXPECT_EQ(stored.t_free, bracket.t_free);
      EXPECT_EQ(stored.closest.distance, bracket.closest.distance);
      EXPECT_EQ(stored.closest.witness_b, bracket.closest.witness_b);
    }
  }
  // Every bit of a motion is part of the key.
  const std::string key = impact_key(a, b, motions);
  motions[7].reference.y() = std::nextafter(motions[7].reference.y(), 9.0);
  EXPECT_NE(impact_key(a, b, motions), key);
}

TEST(Motions, AreTheSameForTheSameSeed) {
  const Mesh a = shapes::box({0.5, 0.4, 0.3}), b = shapes::box({0.2, 0.3, 0.4});
  shapes::Generator generator(3);
  const std::vector<Pose> poses{shapes::random_pose(generator, 1.0), shapes::random_pose(generator, 1.0)};
  for (const MotionKind kind : k_motion_kinds) {
    const auto one = motions_of(poses, a, b, kind, 10.0, 7), same = motions_of(poses, a, b, kind, 10.0, 7);
    const auto other = motions_of(poses, a, b, kind, 10.0, 8);
    EXPECT_EQ(one[1].start.t, same[1].start.t);
    EXPECT_EQ(one[1].rotation, same[1].rotation);
    EXPECT_NE(one[1].start.t, other[1].start.t);
    const double length = 0.1 * a.diagonal();
    EXPECT_NEAR(one[0].translation.norm(), kind == MotionKind::rotation ? 0.0 : length, 1e-12);
    EXPECT_NEAR(one[0].rotation.norm(), kind == MotionKind::translation ? 0.0 : length / (0.5 * b.diagonal()), 1e-12);
  }
}

}  // namespace
}  // namespace sixdof
