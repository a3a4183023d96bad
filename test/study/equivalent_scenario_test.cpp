#include "bench/study/equivalent_scenario.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof::study {
namespace {

constexpr double k_rounding = 1e-9;  // of a mean along the path

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// In scenario II: works for a + b steps, and pushes along the ideal direction turned by 1/a + 4/b radians.
class BusyQuery final : public Query {
 public:
  BusyQuery(const Mesh&, const Mesh&, const Settings& settings)
      : a_(settings.number("a")), b_(settings.number("b")), fails_(settings.choice("fail") == "on") {}

  Outcome<Response> respond(const Pose& X_AB) override {
    if (fails_) return fail(Status::failed, "as asked");
    double x = 1.0;
    for (double step = 0.0; step < a_ + b_; ++step) x = std::sqrt(x + step);
    const Eigen::Vector3d radial(X_AB.t.x(), X_AB.t.y(), 0.0);
    const double angle = 1.0 / a_ + 4.0 / b_ + 0.0 * x;
    const Eigen::AngleAxisd turn(angle, Eigen::Vector3d::UnitZ());
    return Response{.penalty = 1.0, .force = turn * radial.normalized()};
  }

  Footprint footprint() const override { return {.bytes = static_cast<std::size_t>(a_ + b_)}; }

 private:
  double a_, b_;
  bool fails_;
};

Traits busy_traits() {
  const std::vector<std::string> sweep{"500", "1000", "2000", "4000", "8000"};
  return {.name = "busy",
          .version = "1",
          .summary = "works for a + b steps",
          .answers = {.respond = true},
          .law = ResponseLaw::depth,
          .parameters = {Parameter::count("a", "steps", "1000", 300, 20000).swept(sweep),
                         Parameter::count("b", "steps", "1000", 1, 20000).swept(sweep),
                         Parameter::choice("fail", "whether all queries fail", "off", {"off", "on"})}};
}

class EquivalentInAScenario : public ::testing::Test {
 protected:
  EquivalentInAScenario() {
    Settings shape = scenario_settings("II");
    shape.set("facets", "8");
    scenario_ = make_scenario("II", shape);
    algorithm_ = make_algorithm<BusyQuery>(busy_traits());
    axes_ = resolution_axes(algorithm_->traits(), {}, 2.0);
  }

  ScenarioStudy study(std::size_t steps) const {
    return {.scenario = *scenario_,
            .algorithm = *algorithm_,
            .settings = algorithm_->settings(),
            .law = IdealLaw::depth,
            .weights = {},
            .steps = steps};
  }

  std::unique_ptr<Scenario> scenario_;
  std::unique_ptr<Algorithm> algorithm_;
  std::array<ResolutionAxis, 2> axes_;
};

TEST_F(EquivalentInAScenario, TakesThreeValuesOfASweepAndTheLimitsOfAParameter) {
  EXPECT_THAT(axes_[0].grid, ElementsAre(500, 2000, 8000));
  EXPECT_EQ(axes_[0].low, 300);  // of the parameter
  EXPECT_EQ(axes_[1].low, 250);  // half the least value of the grid
  EXPECT_EQ(axes_[1].high, 16000);
  EXPECT_TRUE(axes_[1].integer);
  const auto given = resolution_axes(algorithm_->traits(), {{"b", {7, 70, 700, 7000}}}, 1.0);
  EXPECT_THAT(given[1].grid, ElementsAre(7, 70, 700, 7000));
  EXPECT_EQ(given[1].high, 7000);
  EXPECT_THAT(
      [&] {
        resolution_axes(algorithm_->traits(), {{"b", {7, 70, 7.5}}}, 1.0);
      },
      ThrowsMessage<BadArgument>(HasSubstr("whole number")));
}

TEST_F(EquivalentInAScenario, NeedsTwoSweptParameters) {
  Traits traits = busy_traits();
  traits.parameters[1].sweep.clear();
  EXPECT_THAT([&] { resolution_axes(traits, {}, 2.0); },
              ThrowsMessage<BadArgument>(HasSubstr("busy has 1 swept parameter instead of two")));
}

TEST_F(EquivalentInAScenario, MeasuresTheErrorInRadiansAndProcessorTime) {
  const Measurement coarse = measure_scenario(study(40), axes_, {500, 500});
  EXPECT_NEAR(coarse.eta, 5.0 / 500, k_rounding);  // sigma is 0: the magnitude is constant
  EXPECT_EQ(coarse.bytes, 1000);
  const Measurement fine = measure_scenario(study(40), axes_, {16000, 16000});
  EXPECT_NEAR(fine.eta, 5.0 / 16000, k_rounding);
  EXPECT_GT(fine.time_ns, 5.0 * coarse.time_ns) << "of 32 times the work";
  ScenarioStudy doubled = study(40);
  doubled.weights = {.sigma = 1.0, .gamma = 3.0};
  EXPECT_NEAR(measure_scenario(doubled, axes_, {500, 500}).eta, 3.0 * coarse.eta, k_rounding);
}

TEST_F(EquivalentInAScenario, HasEveryReadingOfTheMeasuresThatThePaperPrints) {
  const Measurement measured = measure_scenario(study(40), axes_, {500, 500});
  const std::map<std::string, double> values(measured.counters.begin(), measured.counters.end());
  const auto query =
      algorithm_->prepare(scenario_->a(), scenario_->b(), with_resolution(algorithm_->settings(), axes_, {500, 500}));
  const Recording recording = record(*scenario_, *query, 40);
  const auto expect = [&](IdealLaw law, const std::string& measure, const std::string& name) {
    const Measures measures = evaluate(*scenario_, recording, law);
    const auto found = std::ranges::find(measures, measure, &Measures::value_type::first);
    ASSERT_TRUE(found != measures.end()) << measure;
    ASSERT_TRUE(values.contains(name)) << name;
    EXPECT_EQ(values.at(name), found->second) << name;
  };
  expect(IdealLaw::depth, "sigma_F", "sigma_F");
  expect(IdealLaw::depth, "gamma_F_deg", "gamma_F_deg");
  // In II all of the path is in the window.
  expect(IdealLaw::paper_depth, "sigma_paper_F", "sigma_paper_F_all_by_paper");
  expect(IdealLaw::paper_depth, "gamma_F_deg", "gamma_F_deg_all_by_paper");
  EXPECT_FALSE(values.contains("sigma_F_all"));
  EXPECT_EQ(values.at("misses"), 0.0);
}

TEST_F(EquivalentInAScenario, FindsTheBestShareOfTheWork) {
  const auto measure = [&](const Resolution& at) { return measure_scenario(study(200), axes_, at); };
  const double tau = measure({2000, 4000}).time_ns;
  const SearchResult result = search_equivalent(axes_, {.target = tau}, measure);
  const SearchStep& answer = result.answer();
  // On a + b = n the least error is 9/n, at b = 2 a. Other work on the machine moves n, not the share by much.
  const double n = answer.measured.at[0] + answer.measured.at[1];
  EXPECT_LT(answer.measured.eta, 1.25 * 9.0 / n);
  EXPECT_NEAR(n, 6000, 0.5 * 6000);
  EXPECT_EQ(answer.reach, Reach::on_line);
}

TEST_F(EquivalentInAScenario, NamesAStepWithoutAnAnswer) {
  ScenarioStudy failing = study(10);
  failing.settings.set("fail", "on");
  EXPECT_THAT(
      [&] {
        measure_scenario(failing, axes_, {500, 500});
      },
      ThrowsMessage<Error>(HasSubstr("busy in II with a=500,b=500,fail=on: failed: as asked")));
}

TEST(RatedWrench, IsTheTorqueWhereTheIdealForceIsZero) {
  for (const std::string& name : scenario_names()) {
    const auto scenario = make_scenario(name);
    double force = 0.0;
    for (const double progress : scenario->steps(8)) force += scenario->ideal(IdealLaw::depth, progress)->force.norm();
    EXPECT_EQ(rated_wrench(name), force > 0.0 ? "F" : "T") << name;
  }
}

}  // namespace
}  // namespace sixdof::study
