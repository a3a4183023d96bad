#include "bench/study/plane_fit.h"

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof::study {
namespace {

constexpr double k_residual = 0.01;  // of values of order 1, at the samples

/// Exact data leave rounding of the least-squares solution.
constexpr double k_rounding = 1e-9;

using Function = std::function<double(double, double)>;

/// The paper's three resolutions of each body.
std::vector<FitSample> grid(const Function& f) {
  std::vector<FitSample> samples;
  for (const double x : {0.03, 0.008, 0.002}) {
    for (const double y : {700.0, 3000.0, 10000.0}) samples.push_back({x, y, f(x, y)});
  }
  return samples;
}

void expect_recovered(const SurfaceFit& fit, const Function& f) {
  for (const double x : {0.001, 0.0044, 0.05}) {
    for (const double y : {300.0, 5000.0, 22000.0}) EXPECT_NEAR(fit.at(x, y) / f(x, y), 1.0, k_rounding);
  }
  EXPECT_LT(fit.leave_one_out(), k_rounding);
}

TEST(FitPlane, TakesALinearPlaneForLinearData) {
  const Function f = [](double x, double y) { return 40.0 + 900.0 * x + 0.02 * y; };
  const SurfaceFit fit = fit_plane(grid(f));
  EXPECT_EQ(fit.form(), FitForm::plane);
  expect_recovered(fit, f);
  EXPECT_GT(SurfaceFit(FitForm::log_plane, grid(f)).leave_one_out(), 0.01);
}

TEST(FitPlane, TakesALogarithmicPlaneForPowerLaws) {
  const Function f = [](double x, double y) { return 3.0 * std::pow(x, -1.7) * std::pow(y, 0.6); };
  const SurfaceFit fit = fit_plane(grid(f));
  EXPECT_EQ(fit.form(), FitForm::log_plane);
  expect_recovered(fit, f);
  EXPECT_GT(SurfaceFit(FitForm::plane, grid(f)).leave_one_out(), 0.5);
}

TEST(FitPlane, TakesALinearPlaneWhereAValueIsNotPositive) {
  const Function f = [](double x, double y) { return -50.0 + 900.0 * x + 0.02 * y; };
  const SurfaceFit fit = fit_plane(grid(f));
  EXPECT_EQ(fit.form(), FitForm::plane);
  EXPECT_NEAR(fit.at(0.01, 2000.0), f(0.01, 2000.0), k_rounding);
  EXPECT_THROW(SurfaceFit(FitForm::log_plane, grid(f)), BadArgument);
}

TEST(FitSurface, TakesAQuadraticWhereALogarithmicPlaneBends) {
  const Function f = [](double x, double y) {
    const double u = std::log(x), v = std::log(y);
    return std::exp(-3.0 + 0.8 * u - 0.3 * v + 0.1 * u * u + 0.05 * u * v + 0.2 * v * v);
  };
  const SurfaceFit fit = fit_surface(grid(f));
  EXPECT_EQ(fit.form(), FitForm::log_quadratic);
  expect_recovered(fit, f);
}

TEST(FitSurface, TakesAPlaneWhereAQuadraticIsNotDetermined) {
  // Two values of x do not determine a quadratic.
  const Function f = [](double x, double y) { return 2.0 * x * std::sqrt(y) * (1.0 + 0.1 * std::sin(1e4 * x + y)); };
  std::vector<FitSample> samples = grid(f);
  samples.resize(6);
  const SurfaceFit fit = fit_surface(samples);
  EXPECT_EQ(fit.form(), FitForm::log_plane);
  EXPECT_GT(fit.leave_one_out(), 0.001);
}

TEST(SurfaceFit, LeavesOutOneSampleAfterTheOther) {
  // Four corners of a square, one of them raised by d: the plane through the other three misses it by d; the plane
  // through three with the raised one misses the fourth by d, too.
  constexpr double k_raised = 0.5;
  const std::vector<FitSample> samples{{1, 1, 2.0}, {2, 1, 2.0}, {1, 2, 2.0}, {2, 2, 2.0 + k_raised}};
  const double on_flat = k_raised / 2.0, on_raised = k_raised / (2.0 + k_raised);
  const double expected = std::sqrt((3.0 * on_flat * on_flat + on_raised * on_raised) / 4.0);
  EXPECT_NEAR(SurfaceFit(FitForm::plane, samples).leave_one_out(), expected, k_rounding);
}

TEST(SurfaceFit, RefusesSamplesThatDoNotDetermineIt) {
  std::vector<FitSample> line;
  for (const double t : {1.0, 2.0, 3.0, 5.0}) line.push_back({t, 2.0 * t, 3.0});
  EXPECT_THROW(SurfaceFit(FitForm::plane, line), BadArgument);
  EXPECT_THROW(SurfaceFit(FitForm::log_plane, line), BadArgument);
  line.resize(2);
  EXPECT_THROW(SurfaceFit(FitForm::plane, line), BadArgument);
  EXPECT_THROW(fit_plane({}), BadArgument);
}

TEST(SurfaceFit, SaysWhenASampleIsNeeded) {
  const std::vector<FitSample> three{{1, 1, 2.0}, {2, 1, 2.0}, {1, 2, 2.0}};
  EXPECT_EQ(SurfaceFit(FitForm::plane, three).leave_one_out(), std::numeric_limits<double>::infinity());
}

TEST(CorrectedFit, FollowsTheSamplesAndFallsBackToTheFit) {
  const Function f = [](double x, double y) { return std::pow(x, -2.0) * y * (1.0 + 100.0 * x); };
  const std::vector<FitSample> samples = grid(f);
  const SurfaceFit fit(FitForm::log_plane, samples);
  const CorrectedFit corrected(fit, samples);
  for (const FitSample& s : samples) {
    EXPECT_NEAR(corrected.at(s.x, s.y) / s.value, 1.0, k_residual);
    EXPECT_GT(std::abs(fit.at(s.x, s.y) / s.value - 1.0), 0.01);
  }
  EXPECT_NEAR(corrected.at(1e-6, 1e9) / fit.at(1e-6, 1e9), 1.0, k_rounding);
  // Between samples it is nearer to the truth than the plane.
  const double x = 0.005, y = 1500.0;
  EXPECT_LT(std::abs(std::log(corrected.at(x, y) / f(x, y))), 0.5 * std::abs(std::log(fit.at(x, y) / f(x, y))));
}

TEST(CorrectedFit, AddsDifferencesWhereASampleIsNotPositive) {
  const Function f = [](double x, double y) { return std::sin(100.0 * x) - 1e-4 * y; };
  const std::vector<FitSample> samples = grid(f);
  const CorrectedFit corrected(fit_plane(samples), samples);
  for (const FitSample& s : samples) EXPECT_NEAR(corrected.at(s.x, s.y), s.value, k_residual);
}

}  // namespace
}  // namespace sixdof::study
