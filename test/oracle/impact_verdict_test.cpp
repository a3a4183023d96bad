#include <sixdof/oracle/impact_verdict.h>

#include <gtest/gtest.h>

#include "../geometry/shapes.h"

namespace sixdof {
namespace {

using Kind = ImpactBracket::Kind;

constexpr double k_tolerance = 1e-6;

ImpactVerdict verdict(const ImpactBracket& truth, const Outcome<Impact>& answer) {
  return judge_impact(truth, answer, k_tolerance).verdict;
}

const ImpactBracket k_hit{.kind = Kind::hit, .t_free = 0.5, .t_touch = 0.5 + 1e-9};
const ImpactBracket k_none{.kind = Kind::none, .t_free = 1.0, .t_touch = 1.0};
const ImpactBracket k_start{.kind = Kind::at_start};

TEST(ImpactVerdict, OfAHit) {
  EXPECT_EQ(verdict(k_hit, Impact{.hit = true, .t = 0.5}), ImpactVerdict::right);
  EXPECT_EQ(verdict(k_hit, Impact{.hit = true, .t = 0.5 + 0.5e-6}), ImpactVerdict::right);
  EXPECT_EQ(verdict(k_hit, Impact{.hit = true, .t = 0.4}), ImpactVerdict::early);
  EXPECT_EQ(verdict(k_hit, Impact{.hit = true, .t = 0.6}), ImpactVerdict::late);
  EXPECT_EQ(verdict(k_hit, Impact{}), ImpactVerdict::missed);
  EXPECT_EQ(verdict(k_hit, Status::failed), ImpactVerdict::failed);
  EXPECT_NEAR(judge_impact(k_hit, Impact{.hit = true, .t = 0.4}, k_tolerance).early, 0.1, 1e-15);
  EXPECT_NEAR(judge_impact(k_hit, Impact{.hit = true, .t = 0.6}, k_tolerance).late, 0.1, 2e-9);
}

/// Otherwise the cheapest conservative answer would have no fault.
TEST(ImpactVerdict, AConstantContactAtTheStartIsAFault) {
  const Impact constant{.hit = true, .t = 0.0};
  EXPECT_TRUE(is_fault(verdict(k_hit, constant)));
  EXPECT_TRUE(is_fault(verdict(k_none, constant)));
  EXPECT_EQ(verdict(k_start, constant), ImpactVerdict::right);
}

TEST(ImpactVerdict, OfNoHitAndOfContactAtTheStart) {
  EXPECT_EQ(verdict(k_none, Impact{}), ImpactVerdict::right);
  EXPECT_EQ(verdict(k_none, Impact{.hit = true, .t = 0.3}), ImpactVerdict::phantom);
  EXPECT_EQ(judge_impact(k_none, Impact{.hit = true, .t = 0.3}, k_tolerance, 1e-12, 1e-9).verdict,
            ImpactVerdict::right);
  EXPECT_EQ(judge_impact(k_none, Impact{.hit = true, .t = 0.3}, k_tolerance, 1e-6, 1e-9).verdict,
            ImpactVerdict::phantom);
  EXPECT_EQ(verdict(k_start, Impact{.hit = true, .t = 0.2}), ImpactVerdict::late);
  EXPECT_EQ(verdict(k_start, Impact{}), ImpactVerdict::missed);
}

TEST(ImpactVerdict, AGrazingTruthIsNotJudged) {
  const ImpactBracket grazing{.kind = Kind::grazing, .t_free = 0.5};
  EXPECT_EQ(verdict(grazing, Impact{}), ImpactVerdict::not_judged);
  EXPECT_EQ(verdict(grazing, Impact{.hit = true}), ImpactVerdict::not_judged);
  EXPECT_EQ(verdict(grazing, Status::failed), ImpactVerdict::failed);
}

TEST(ImpactVerdict, AngleOfNormals) {
  ImpactBracket truth = k_hit;
  EXPECT_LT(judge_impact(truth, Impact{.hit = true, .t = 0.5}, k_tolerance).normal_angle, 0.0);
  truth.closest = {.has_witnesses = true, .witness_a = {1.0, 0.0, 0.0}, .witness_b = {1.0 + 1e-9, 0.0, 0.0}};
  const Impact answer{.hit = true, .t = 0.5, .normal = {0.0, 1.0, 0.0}};
  EXPECT_NEAR(judge_impact(truth, answer, k_tolerance).normal_angle, 90.0, 1e-6);
}

TEST(ImpactVerdict, TolerancesAreLengths) {
  const Mesh b = shapes::box({0.3, 0.4, 0.5});
  const auto tolerance = [&](double length) {
    return impact_tolerance(Motion::of(b, {}, {length, 0.0, 0.0}), b.box(), 2.0);
  };
  EXPECT_NEAR(tolerance(1e-3), 2e-6, 1e-12) << "1e-9 of a diagonal of 2";
  EXPECT_EQ(tolerance(1e6), k_bracket_width);
  EXPECT_EQ(tolerance(1e-12), 1.0);
  EXPECT_EQ(tolerance(0.0), k_bracket_width);
}

}  // namespace
}  // namespace sixdof
