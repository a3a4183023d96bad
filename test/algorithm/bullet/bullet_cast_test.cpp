#include <sixdof/algorithm/bullet/bullet_cast.h>

#include <gtest/gtest.h>

#include <sixdof/generation/impact_truth.h>
#include <sixdof/oracle/convex_hull.h>
#include <sixdof/oracle/impact_verdict.h>

#include "../contact_checks.h"

namespace sixdof {
namespace {

/// Bullet ends where a gap is below 1e-3 length units (btContinuousConvexCollision.cpp), of bodies of size 1.
constexpr double k_bullet_gap = 5e-3;

/// A box above another, turned about the vertical axis: faces stay parallel whatever it turns about that.
struct BoxAbove : ::testing::Test {
  const Mesh a = box_solid({-1.0, -0.8, -0.6}, {1.0, 0.8, 0.6}, "a"),
             b = box_solid({-1.0, -0.8, -0.6}, {1.0, 0.8, 0.6}, "b");
  const Pose start{Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {0.1, -0.2, 1.57}};  // gap 0.37

  Outcome<Impact> cast(const Motion& motion, const std::vector<std::string>& settings = {}) {
    return test::prepare(*make_bullet_hull_algorithm(), a, b, settings)->cast(motion);
  }
};

TEST_F(BoxAbove, HitsWhereTheGapEnds) {
  for (const std::string caster : {"caster=continuous", "caster=gjk", "caster=subsimplex"}) {
    std::vector<std::string> settings{caster};
    if (caster == "caster=gjk") settings.emplace_back("margin=0.001");  // it misses without one
    const Outcome<Impact> hit = cast(Motion::of(b, start, {0.02, 0.05, -1.0}), settings);
    ASSERT_TRUE(hit.ok() && hit.value.hit) << caster;
    EXPECT_NEAR(hit.value.t, 0.37, k_bullet_gap) << caster;
    EXPECT_GT(std::abs(hit.value.normal.z()), 0.99) << caster;
    EXPECT_FALSE(cast(Motion::of(b, start, {0.02, 0.05, 1.0}), settings).value.hit) << caster;
    EXPECT_FALSE(cast(Motion::of(b, start, {0.02, 0.05, -0.3}), settings).value.hit) << caster;
  }
}

TEST_F(BoxAbove, TheNormalLeadsFromAToB) {
  EXPECT_GT(cast(Motion::of(b, start, {0.02, 0.05, -1.0})).value.normal.z(), 0.99);
}

TEST_F(BoxAbove, TurnsAboutTheReferencePoint) {
  for (const double angle : {1.3, -4.0}) {
    const Outcome<Impact> hit = cast(Motion::of(b, start, {0.02, 0.05, -1.0}, {0.0, 0.0, angle}));
    ASSERT_TRUE(hit.ok() && hit.value.hit) << angle;
    EXPECT_NEAR(hit.value.t, 0.37, k_bullet_gap) << angle;
  }
  // Turned about a corner, the body swings down without its centre moving straight.
  Motion swing = Motion::of(b, start, Eigen::Vector3d::Zero(), {0.9, 0.0, 0.0});
  swing.reference = {1.0, 0.8, 0.6};
  const TrueImpact truth = ImpactTruth(a, b).find(swing);
  const Outcome<Impact> answer = cast(swing);
  ASSERT_TRUE(answer.ok());
  const bool hit = truth.bracket.kind == ImpactBracket::Kind::hit;
  ASSERT_EQ(answer.value.hit, hit);
  if (hit) {
    EXPECT_NEAR(answer.value.t, truth.bracket.t_touch, k_bullet_gap);
  }
}

TEST_F(BoxAbove, ThickensByTheMarginAndRefusesWhatIsNotFinite) {
  const Motion motion = Motion::of(b, start, {0.02, 0.05, -1.0});
  const double thin = cast(motion).value.t, thick = cast(motion, {"margin=0.04"}).value.t;
  EXPECT_LT(thick, thin) << "Bullet's own default hits earlier";
  Motion wrong = motion;
  wrong.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(cast(wrong).status, Status::non_finite);
  EXPECT_EQ(make_bullet_hull_algorithm()->traits().body, Body::convex_hull);
}

}  // namespace
}  // namespace sixdof
