#include "bench/harness/cast_check.h"

#include <gtest/gtest.h>

#include <sixdof/models/model_catalogue.h>

namespace sixdof::bench {
namespace {

/// Two unit spheres on the x axis: B comes from x = 5 and moves by -4, so it touches at x = 2, t = 0.75. Facets make
/// the contact a little later.
struct TwoSpheres : ::testing::Test {
  const Mesh a = load_model("sphere-1k"), b = load_model("sphere-1k");
  const double r = 0.5 * a.box().sizes().x();
  const Motion motion =
      Motion::of(b, Pose{.R = Eigen::Matrix3d::Identity(), .t = {5.0 * r, 0.07 * r, 0.03 * r}}, {-4.0 * r, 0.0, 0.0});
  const ImpactBracket hit{.kind = ImpactBracket::Kind::hit, .t_free = 0.75, .t_touch = 0.75 + 1e-10};
  const ImpactBracket none{.kind = ImpactBracket::Kind::none, .t_free = 1.0};
  CastJudge judge{a, b};

  ImpactVerdict verdict(const ImpactBracket& truth, const Impact& answer) {
    return judge.judge(motion, truth, answer).verdict;
  }
};

TEST_F(TwoSpheres, EachKindOfAnswerHasItsVerdict) {
  EXPECT_EQ(verdict(hit, {.hit = true, .t = 0.75}), ImpactVerdict::right);
  EXPECT_EQ(verdict(hit, {.hit = true, .t = 0.7}), ImpactVerdict::early);
  EXPECT_EQ(verdict(hit, {.hit = true, .t = 0.8}), ImpactVerdict::late);
  EXPECT_EQ(verdict(hit, {}), ImpactVerdict::missed);
  EXPECT_EQ(verdict(hit, {.hit = true, .t = 0.0}), ImpactVerdict::false_contact);
  EXPECT_EQ(verdict(none, {}), ImpactVerdict::right);
  EXPECT_EQ(verdict(none, {.hit = true, .t = 0.25}), ImpactVerdict::phantom) << "far apart then";
  EXPECT_EQ(verdict(none, {.hit = true, .t = 1.0}), ImpactVerdict::right)
      << "they overlap then, whatever the truth says";
}

TEST_F(TwoSpheres, CountsAreThoseOfTheTableOfMetrics) {
  CastCounts counts;
  const auto add = [&](const ImpactBracket& truth, const Outcome<Impact>& answer, const std::string& words = "") {
    counts.add(truth, answer, judge.judge(motion, truth, answer), words);
  };
  add(hit, Impact{.hit = true, .t = 0.75});
  add(hit, Impact{.hit = true, .t = 0.875});
  add(hit, Impact{});
  add(none, Impact{});
  add(none, Status::crashed, "ended by signal 11");
  CastCounts twice = counts;
  twice.add(counts);
  const auto values = twice.values();
  EXPECT_EQ(values.at("configurations"), 10.0);
  EXPECT_EQ(values.at("hits"), 6.0);
  EXPECT_EQ(values.at("judged"), 8.0);
  EXPECT_EQ(values.at("mismatch"), 4.0);
  EXPECT_EQ(values.at("missed_hits"), 2.0);
  EXPECT_EQ(values.at("late_hits"), 2.0);
  EXPECT_NEAR(values.at("late_max"), 0.125, 1e-9);  // the width of the bracket
  EXPECT_EQ(values.at("failed"), 2.0);
  EXPECT_EQ(values.at("crashed"), 2.0);
  EXPECT_EQ(counts.first_failure, "ended by signal 11");
  EXPECT_FALSE(values.contains("normal_max_deg")) << "no answer has a normal";
}

}  // namespace
}  // namespace sixdof::bench
