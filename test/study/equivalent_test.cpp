#include "bench/study/equivalent.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof::study {
namespace {

constexpr double k_allowed = 0.1;  // relative: difference that the search accepts
constexpr double k_plane = 1e-6;   // relative: a plane is met exactly
constexpr double k_search = 0.01;  // relative: where the search has converged
constexpr double k_whole = 1.0;    // one sphere

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

using Function = std::function<double(double, double)>;

/// An algorithm whose time and error are known functions of its two resolutions.
struct Fake {
  Function time;
  Function eta;
  std::size_t calls = 0;

  Measure measure() {
    return [this](const Resolution& at) -> Measurement {
      ++calls;
      return {.at = at, .time_ns = time(at[0], at[1]), .eta = eta(at[0], at[1]), .bytes = at[0] * at[1]};
    };
  }
};

/// Counts, such as spheres: more is finer.
std::array<ResolutionAxis, 2> counts() {
  const ResolutionAxis axis{.parameter = "n", .grid = {100, 1000, 10000}, .low = 50, .high = 20000, .integer = true};
  return {axis, axis};
}

/// Lengths, such as voxel sizes: less is finer.
std::array<ResolutionAxis, 2> lengths() {
  const ResolutionAxis axis{.parameter = "s", .grid = {0.03, 0.01, 0.003}, .low = 0.0015, .high = 0.06};
  return {axis, axis};
}

/// What the search may lose against the optimum in eta. At an optimum eta is flat: 20 % off in the place costs 2 %.
constexpr double k_margin = 1.03;

TEST(SearchEquivalent, FindsTheOptimumOfBusyWorkAndItsInverseError) {
  // a + b steps of 10 ns, error 1/a + 4/b: on a + b = n the least error is at b = 2 a, 9/n.
  Fake fake{[](double a, double b) { return 10.0 * (a + b); }, [](double a, double b) { return 1.0 / a + 4.0 / b; }};
  for (const double n : {600.0, 3000.0, 9000.0}) {
    const SearchResult result = search_equivalent(counts(), {.target = 10.0 * n}, fake.measure());
    const SearchStep& answer = result.answer();
    EXPECT_TRUE(result.converged) << n;
    EXPECT_EQ(answer.reach, Reach::on_line);
    EXPECT_EQ(result.first().time_form, FitForm::plane);
    EXPECT_NEAR(answer.measured.time_ns, 10.0 * n, k_allowed * 10.0 * n);
    const double on_its_line = 9.0 / (answer.measured.at[0] + answer.measured.at[1]);
    EXPECT_LT(answer.measured.eta, 1.1 * on_its_line) << n;
    EXPECT_NEAR(answer.eta_predicted, answer.measured.eta, k_allowed * answer.measured.eta);
  }
}

TEST(SearchEquivalent, FindsTheOptimumOfPowerLaws) {
  // Time k / (x y^2), error x + y: on x y^2 = c the least error is at y = 2 x, x = (c/4)^(1/3).
  Fake fake{[](double x, double y) { return 1.0 / (x * y * y); }, [](double x, double y) { return x + y; }};
  for (const double x : {0.003, 0.006, 0.012}) {
    const double tau = 1.0 / (x * 4.0 * x * x);
    const SearchResult result = search_equivalent(lengths(), {.target = tau}, fake.measure());
    EXPECT_EQ(result.first().time_form, FitForm::log_plane);
    EXPECT_NEAR(result.first().time_predicted_ns, result.first().measured.time_ns, k_plane * tau);
    EXPECT_NEAR(result.answer().measured.time_ns, tau, k_search * tau);
    EXPECT_LT(result.answer().measured.eta, k_margin * 3.0 * x);
  }
}

TEST(SearchEquivalent, FindsTheLeastTimeOfAnError) {
  Fake fake{[](double x, double y) { return 1.0 / (x * y * y); }, [](double x, double y) { return x * y; }};
  // On x y = e the time is 1 / (e y): least at the largest y.
  constexpr double k_eta = 2e-4;
  const SearchResult result = search_equivalent(lengths(), {.goal = Goal::eta, .target = k_eta}, fake.measure());
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.answer().measured.at[1], 0.06, 0.06 * 0.03);
  EXPECT_NEAR(result.answer().measured.eta, k_eta, 0.01 * k_eta);
}

TEST(SearchEquivalent, RefinesAPredictionThatIsOff) {
  // A constant cost hides the power law of the grid's coarse points, so no plane fits well.
  Fake fake{[](double x, double y) { return 5e3 + 1.0 / (x * y * y); }, [](double x, double y) { return x + y; }};
  constexpr double k_tau = 2e4;
  const SearchResult result = search_equivalent(lengths(), {.target = k_tau}, fake.measure());
  EXPECT_GT(result.steps.size(), 1u);
  EXPECT_GT(std::abs(result.first().measured.time_ns - k_tau), 0.1 * k_tau);
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.answer().measured.time_ns, k_tau, 0.1 * k_tau);
  const double x = std::cbrt(1.0 / (4.0 * (result.answer().measured.time_ns - 5e3)));
  EXPECT_LT(result.answer().measured.eta, 1.1 * 3.0 * x);
}

TEST(SearchEquivalent, TakesAFasterResolutionThatIsBetter) {
  // The error grows again beyond 1,000, as where finer voxels do not pay: all points at tau are bad.
  const auto off = [](double n) { return std::pow(std::log(n / 1000.0), 2); };
  Fake fake{[](double a, double b) { return 10.0 * (a + b); },
            [&](double a, double b) { return 0.1 + off(a) + off(b); }};
  const SearchResult result = search_equivalent(counts(), {.target = 2e5}, fake.measure());
  EXPECT_EQ(result.answer().reach, Reach::inside);
  EXPECT_LT(result.answer().measured.time_ns, 1e5);
  EXPECT_LT(result.answer().measured.eta, 1.0);  // at tau it is 10.7 or more
}

TEST(SearchEquivalent, SaysThatAllIsFasterOrSlower) {
  Fake fake{[](double a, double b) { return 10.0 * (a + b); }, [](double a, double b) { return 1.0 / a + 4.0 / b; }};
  const SearchResult faster = search_equivalent(counts(), {.target = 1e9}, fake.measure());
  EXPECT_EQ(faster.answer().reach, Reach::below);
  EXPECT_NEAR(faster.answer().measured.at[0], 20000, k_whole);
  EXPECT_NEAR(faster.answer().measured.at[1], 20000, k_whole);
  const SearchResult slower = search_equivalent(counts(), {.target = 10.0}, fake.measure());
  EXPECT_EQ(slower.answer().reach, Reach::above);
  EXPECT_EQ(slower.answer().measured.at, (Resolution{50, 50}));
}

TEST(SearchEquivalent, StaysWithinTheLimitOfMemory) {
  Fake fake{[](double a, double b) { return 10.0 * (a + b); }, [](double a, double b) { return 1.0 / a + 4.0 / b; }};
  const SearchResult result = search_equivalent(counts(), {.target = 1e9, .largest_bytes = 1e6}, fake.measure());
  EXPECT_EQ(result.answer().reach, Reach::below);
  EXPECT_LE(result.answer().measured.bytes, 1.01e6);
}

TEST(SearchEquivalent, EndsWhereThePredictionsNeverComeTrue) {
  // A time that changes by half at every call, as on a machine with other work.
  Fake fake{{}, [](double x, double y) { return x + y; }};
  fake.time = [&](double x, double y) { return (fake.calls % 2 == 0 ? 1.0 : 0.5) / (x * y * y); };
  const SearchOptions options{.target = 1e6, .tolerance = 0.001, .refinements = 3};
  const SearchResult result = search_equivalent(lengths(), options, fake.measure());
  EXPECT_FALSE(result.converged);
  EXPECT_LE(result.steps.size(), 4u);
  EXPECT_EQ(fake.calls, 9 + result.steps.size());
}

TEST(SearchEquivalent, LeavesOutResolutionsWithoutAnError) {
  // No force with the coarsest resolution of A.
  Fake fake{[](double x, double y) { return 1.0 / (x * y * y); },
            [](double x, double y) { return x > 0.02 ? std::numeric_limits<double>::quiet_NaN() : x + y; }};
  const double tau = 1.0 / (0.006 * 0.012 * 0.012);
  const SearchResult result = search_equivalent(lengths(), {.target = tau}, fake.measure());
  EXPECT_TRUE(result.converged);
  EXPECT_LT(result.answer().measured.eta, 1.1 * 0.018);
  fake.eta = [](double, double) { return std::numeric_limits<double>::quiet_NaN(); };
  EXPECT_THAT([&] { search_equivalent(lengths(), {.target = tau}, fake.measure()); },
              ThrowsMessage<BadArgument>(HasSubstr("defined at 0 of 9")));
}

TEST(SearchEquivalent, RefusesAxesThatCannotBeSearched) {
  Fake fake{[](double, double) { return 1.0; }, [](double, double) { return 1.0; }};
  const auto refused = [&](const std::function<void(ResolutionAxis&)>& spoil, const char* words) {
    std::array<ResolutionAxis, 2> axes = lengths();
    spoil(axes[1]);
    EXPECT_THAT([&] { search_equivalent(axes, {.target = 1.0}, fake.measure()); },
                ThrowsMessage<BadArgument>(HasSubstr(words)));
  };
  refused([](ResolutionAxis& axis) { axis.grid = {0.01, 0.03}; }, "at least 3");
  refused([](ResolutionAxis& axis) { axis.grid = {0.01, 0.03, 0.01}; }, "at least 3 different");
  refused([](ResolutionAxis& axis) { axis.high = 0.02; }, "must lie between");
  EXPECT_THAT([&] { search_equivalent(lengths(), {.target = 0.0}, fake.measure()); },
              ThrowsMessage<BadArgument>(HasSubstr("above zero")));
  EXPECT_EQ(fake.calls, 0u);
}

TEST(RoundedValue, HasFourDigitsAndKeepsTheRules) {
  const ResolutionAxis length{.parameter = "s", .grid = {}, .low = 0.0005, .high = 0.1};
  EXPECT_EQ(rounded_value(length, 0.00123456), 0.001235);
  EXPECT_EQ(rounded_value(length, 0.4), 0.1);
  EXPECT_EQ(rounded_value(length, 1e-9), 0.0005);
  const ResolutionAxis count{.parameter = "n", .grid = {}, .low = 1, .high = 5e6, .integer = true};
  EXPECT_EQ(rounded_value(count, 3.4), 3.0);
  EXPECT_EQ(rounded_value(count, 123456.7), 123500.0);
}

}  // namespace
}  // namespace sixdof::study
