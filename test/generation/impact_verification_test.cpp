#include <sixdof/generation/impact_verification.h>

#include <gmock/gmock.h>
#include <Eigen/Geometry>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>
#include <sixdof/generation/motions.h>
#include <sixdof/generation/stored_impacts.h>

#include "../oracle/bodies.h"
#include "../oracle/motions.h"

namespace sixdof {
namespace {

using Kind = ImpactBracket::Kind;
using ::testing::HasSubstr;

Pose pose_of(double w, double x, double y, double z, const Eigen::Vector3d& t) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(w, x, y, z).normalized();
  return Pose::from_quaternion(q.w(), q.x(), q.y(), q.z(), t);
}

/// Motions of two small bodies, all kinds of truths among them.
class Verified : public ::testing::Test {
 protected:
  Verified() {
    const double d = a_.diagonal();
    for (int i = 0; i < 12; ++i) {
      const Pose start = pose_of(0.9 - 0.05 * i, 0.1 + 0.07 * i, 0.3, -0.2, {1.4 * d, 0.09 * d * (i % 4), -0.11 * d});
      const Eigen::Vector3d towards(i % 3 == 2 ? 0.1 * d : -1.3 * d, 0.05 * d, 0.07 * d);
      motions_.push_back(Motion::of(b_, start, towards, {0.3 * i, 1.0 - 0.1 * i, 0.2}));
    }
    motions_.push_back(Motion::of(b_, pose_of(0.9, 0.1, 0.3, -0.2, {0.3 * d, 0.0, 0.1 * d}), {0.2 * d, 0.1 * d, 0.0}));
    truths_ = stored_impacts(a_, b_, motions_);
  }
  ImpactsVerdict verdict() const { return verify_impacts(a_, b_, motions_, truths_, *oracle_); }
  std::size_t first(Kind kind) const {
    return static_cast<std::size_t>(std::ranges::find(truths_, kind, &ImpactBracket::kind) - truths_.begin());
  }

  const Mesh a_ = bodies::bumpy_torus(12, 8), b_ = bodies::bumpy_sphere(1);
  const std::unique_ptr<Algorithm> oracle_ = make_brute_force_algorithm();
  std::vector<Motion> motions_;
  std::vector<ImpactBracket> truths_;
};

TEST_F(Verified, TruthsHaveNoProblem) {
  const ImpactsVerdict found = verdict();
  EXPECT_TRUE(found.ok()) << ::testing::PrintToString(found.problems);
  EXPECT_EQ(found.motions, motions_.size());
  EXPECT_GT(found.hits, 2u);
  EXPECT_GT(found.misses, 2u);
  EXPECT_EQ(found.at_start, 1u);
  EXPECT_LE(found.widest, 1e-8);  // k_bracket_width, or some roundings of poses
}

TEST_F(Verified, ALateTruthIsFound) {
  ImpactBracket& truth = truths_.at(first(Kind::hit));
  truth.t_free += 0.05;
  truth.t_touch += 0.05;
  const ImpactsVerdict found = verdict();
  EXPECT_EQ(found.earlier, 1u);
  EXPECT_EQ(found.changed, 1u);
  EXPECT_THAT(found.problems, ::testing::Contains(HasSubstr("measures contact at t")));
}

TEST_F(Verified, AnEarlyTruthIsFound) {
  ImpactBracket& truth = truths_.at(first(Kind::hit));
  truth.t_free -= 0.05;
  truth.t_touch -= 0.05;
  const ImpactsVerdict found = verdict();
  EXPECT_EQ(found.apart, 1u);
  EXPECT_EQ(found.earlier, 0u);
  EXPECT_THAT(found.problems, ::testing::Contains(HasSubstr("where they touch")));
}

TEST_F(Verified, AMissedContactAndAWideBracketAreFound) {
  ImpactBracket& missed = truths_.at(first(Kind::hit));
  missed.kind = Kind::none;
  EXPECT_EQ(verdict().earlier, 1u);
  missed.kind = Kind::hit;
  missed.t_free -= 1e-4;
  const ImpactsVerdict found = verdict();
  EXPECT_EQ(found.wide, 1u);
  EXPECT_EQ(found.earlier, 0u);
}

TEST_F(Verified, RefusesAnOracleWithoutDistances) {
  EXPECT_THROW(verify_impacts(a_, b_, motions_, truths_, *make_sampled_algorithm()), BadArgument);
}

}  // namespace
}  // namespace sixdof
