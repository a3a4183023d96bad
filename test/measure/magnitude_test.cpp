#include <sixdof/measure/magnitude.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

constexpr double k_rounding = 8 * std::numeric_limits<double>::epsilon();

// Magnitudes 5, 3, 0 in three different directions; normalised 1, 0.6, 0.
const std::vector<Eigen::Vector3d> k_ideal{{3, 4, 0}, {0, -1.8, 2.4}, {0, 0, 0}};
// Magnitudes 2, 4, 3; normalised 0.5, 1, 0.75. Differences 0.5, -0.4, -0.75.
const std::vector<Eigen::Vector3d> k_measured{{0, 0, -2}, {4, 0, 0}, {1, 2, 2}};

TEST(Magnitude, SigmaIsTheRootMeanSquareOfNormalisedDifferences) {
  const double mean_square = (0.25 + 0.16 + 0.5625) / 3.0;
  EXPECT_NEAR(*sigma(k_ideal, k_measured), std::sqrt(mean_square), k_rounding);
}

TEST(Magnitude, PrintedFormulaDependsOnTheNumberOfSteps) {
  EXPECT_NEAR(*sigma_paper(k_ideal, k_measured), std::sqrt(0.25 + 0.16 + 0.5625) / 3.0, k_rounding);
  std::vector<Eigen::Vector3d> ideal_twice;
  std::vector<Eigen::Vector3d> measured_twice;
  for (std::size_t k = 0; k < k_ideal.size(); ++k) {
    ideal_twice.insert(ideal_twice.end(), 2, k_ideal[k]);
    measured_twice.insert(measured_twice.end(), 2, k_measured[k]);
  }
  EXPECT_NEAR(*sigma(ideal_twice, measured_twice), *sigma(k_ideal, k_measured), k_rounding);
  EXPECT_NEAR(*sigma_paper(ideal_twice, measured_twice) * std::sqrt(2.0), *sigma_paper(k_ideal, k_measured),
              k_rounding);
}

TEST(Magnitude, AGainShowsInTheFitButNotInSigma) {
  std::vector<Eigen::Vector3d> louder = k_ideal;
  for (Eigen::Vector3d& v : louder) v *= -1.7;
  EXPECT_NEAR(*sigma(k_ideal, louder), 0.0, k_rounding);
  EXPECT_NEAR(fit_gain(k_ideal, louder)->gain, 1.7, 2 * k_rounding);
  EXPECT_NEAR(fit_gain(k_ideal, louder)->sigma, 0.0, k_rounding);
}

TEST(Magnitude, FitLeavesTheResidualOfLeastSquares) {
  // Ideal magnitudes (5, 3, 0), measured (2, 4, 3): gain (10 + 12) / 34, residuals 2 - 5g, 4 - 3g, 3.
  const double gain = 22.0 / 34.0;
  const double squares = std::pow(2 - 5 * gain, 2) + std::pow(4 - 3 * gain, 2) + 9.0;
  EXPECT_NEAR(fit_gain(k_ideal, k_measured)->gain, gain, k_rounding);
  EXPECT_NEAR(fit_gain(k_ideal, k_measured)->sigma, std::sqrt(squares / 3.0) / (5.0 * gain), k_rounding);
}

TEST(Magnitude, ZeroSeriesHaveNoCurve) {
  const std::vector<Eigen::Vector3d> zero(3, Eigen::Vector3d::Zero());
  EXPECT_FALSE(sigma(zero, k_measured));
  EXPECT_FALSE(fit_gain(zero, k_measured));
  EXPECT_FALSE(fit_gain(k_ideal, zero));
  EXPECT_NEAR(*sigma(k_ideal, zero), std::sqrt((1.0 + 0.36) / 3.0), k_rounding);
  EXPECT_FALSE(sigma(Vectors{}, Vectors{}));
}

TEST(MagnitudeError, IsTheSineOfTheAngleBetweenTheSeries) {
  const std::vector<double> ideal{3.0, 4.0}, turned{4.0, 3.0};  // cosine 24 / 25
  const auto error = magnitude_error(ideal, turned);
  EXPECT_NEAR(error->gain, 24.0 / 25.0, k_rounding);
  EXPECT_NEAR(error->relative, 7.0 / 25.0, k_rounding);
  EXPECT_NEAR(magnitude_error(turned, ideal)->relative, 7.0 / 25.0, k_rounding);
}

TEST(MagnitudeError, DoesNotSeeAGain) {
  const std::vector<double> ideal{3.1, 4.7, 0.2};
  std::vector<double> louder;
  for (const double i : ideal) louder.push_back(1.7 * i);
  EXPECT_NEAR(magnitude_error(ideal, louder)->gain, 1.7, k_rounding);
  EXPECT_LT(magnitude_error(ideal, louder)->relative, k_rounding);
}

TEST(MagnitudeError, IsOneWithoutAnyForceOrWithForcesElsewhere) {
  const std::vector<double> ideal{3.0, 0.0}, zero{0.0, 0.0}, elsewhere{0.0, 2.0};
  EXPECT_EQ(magnitude_error(ideal, zero)->relative, 1.0);
  EXPECT_EQ(magnitude_error(ideal, zero)->gain, 0.0);
  EXPECT_EQ(magnitude_error(ideal, elsewhere)->relative, 1.0);
  EXPECT_FALSE(magnitude_error(zero, ideal));
  EXPECT_FALSE(magnitude_error({}, {}));
}

TEST(Magnitude, RefusesUnequalLengths) {
  EXPECT_THROW(magnitude_error(std::vector{1.0}, {}), BadArgument);
  EXPECT_THROW(sigma(k_ideal, Vectors(k_measured).first(2)), BadArgument);
  EXPECT_THROW(sigma_paper(k_ideal, Vectors(k_measured).first(2)), BadArgument);
  EXPECT_THROW(fit_gain(k_ideal, Vectors(k_measured).first(2)), BadArgument);
}

TEST(Penalty, SigmaAndGainAreThoseOfAParabolaAgainstALine) {
  // Ideal x, measured x^2 at the middles of N parts of 0..1: the RMS of x - x^2 tends to sqrt(1/30), the gain to
  // (1/4) / (1/3), with the error of the midpoint rule, whose peaks are at 1 - 1/(2N).
  constexpr std::size_t k_count = 4000;
  std::vector<double> ideal, measured;
  for (std::size_t k = 0; k < k_count; ++k) {
    const double x = (static_cast<double>(k) + 0.5) / k_count;
    ideal.push_back(x);
    measured.push_back(7.0 * x * x);
  }
  constexpr double k_quadrature = 1.0 / k_count;
  EXPECT_NEAR(*sigma(ideal, measured), std::sqrt(1.0 / 30.0), k_quadrature);
  const auto fit = fit_gain(ideal, measured);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->gain, 7.0 * 0.75, 7.0 * k_quadrature);
  // RMS of x^2 - 3x/4 is sqrt(1/5 - 3/8 + 3/16) = sqrt(1/80), over the gain 3/4.
  EXPECT_NEAR(fit->sigma, std::sqrt(1.0 / 80.0) / 0.75, k_quadrature);
}

TEST(Penalty, AWrongSignIsAnErrorAndHasNoGain) {
  const std::vector<double> ideal{1.0, 2.0, 0.5}, opposite{-1.0, -2.0, -0.5};
  EXPECT_NEAR(*sigma(ideal, opposite), std::sqrt((1.0 + 4.0 + 0.25) / 3.0), k_rounding);
  EXPECT_FALSE(fit_gain(ideal, opposite));
  EXPECT_EQ(peak(opposite), 2.0);
  EXPECT_FALSE(sigma(std::vector<double>(3, 0.0), ideal));
  EXPECT_THROW(sigma(ideal, std::vector<double>(2, 1.0)), BadArgument);
}

}  // namespace
}  // namespace sixdof
