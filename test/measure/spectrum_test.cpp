#include <sixdof/measure/spectrum.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-12;  // of sums of some hundred terms of order one
constexpr double k_full_angle = 2.0 * std::numbers::pi;

std::vector<double> tone(std::size_t count, double cycles, double amplitude, double offset = 0.0) {
  std::vector<double> signal;
  for (std::size_t k = 0; k < count; ++k) {
    const double phase = k_full_angle * cycles * static_cast<double>(k) / static_cast<double>(count);
    signal.push_back(offset + amplitude * std::cos(phase + 0.4));
  }
  return signal;
}

TEST(EnergySpectrum, ObeysParsevalForEvenAndOddLengths) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (const std::size_t count : {1u, 2u, 127u, 200u}) {
    std::vector<double> signal(count);
    for (double& x : signal) x = normal(random);
    const std::vector<double> energy = energy_spectrum(signal);
    EXPECT_EQ(energy.size(), count / 2 + 1);
    EXPECT_NEAR(std::accumulate(energy.begin(), energy.end(), 0.0),
                std::inner_product(signal.begin(), signal.end(), signal.begin(), 0.0), k_rounding * 100);
  }
  EXPECT_TRUE(energy_spectrum({}).empty());
}

TEST(EnergySpectrum, PutsAToneAtItsFrequency) {
  const std::vector<double> energy = energy_spectrum(tone(240, 17.0, 3.0, 0.5));
  EXPECT_NEAR(energy[0], 240 * 0.25, k_rounding * 240);
  EXPECT_NEAR(energy[17], 240 * 9.0 / 2.0, k_rounding * 1000);
  EXPECT_NEAR(energy[16] + energy[18], 0.0, k_rounding);
}

TEST(Nu, IsTheRatioOfEnergiesOfNormalisedMagnitudes) {
  // Normalised magnitudes: ideal (1, 0.5, 1), measured (0.25, 1, 0.5).
  const std::vector<Eigen::Vector3d> ideal{{0, 2, 0}, {0, 0, -1}, {2, 0, 0}};
  const std::vector<Eigen::Vector3d> measured{{0.5, 0, 0}, {0, 2, 0}, {0, 0, 1}};
  EXPECT_NEAR(*nu(ideal, measured), (0.0625 + 1.0 + 0.25) / 2.25, k_rounding);
  EXPECT_NEAR(*nu(measured, ideal), 2.25 / (0.0625 + 1.0 + 0.25), k_rounding);
  EXPECT_FALSE(nu(std::vector<Eigen::Vector3d>(3, Eigen::Vector3d::Zero()), measured));
}

TEST(Nu, OfPenaltiesIsTheRatioOfTheirMeanSquares) {
  const std::vector<double> ideal{2.0, 1.0, -2.0}, measured{0.5, 2.0, 1.0};
  EXPECT_NEAR(*nu(ideal, measured), (0.0625 + 1.0 + 0.25) / 2.25, k_rounding);
  EXPECT_FALSE(nu(std::vector<double>(3, 0.0), measured));
}

/// A direction that swings by `amplitude` radians to both sides of a direction that turns `turns` times, with another
/// length at each step.
std::vector<Eigen::Vector3d> swinging(std::size_t count, double turns, double swings, double amplitude) {
  std::vector<Eigen::Vector3d> vectors;
  for (std::size_t k = 0; k < count; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(count);
    const double angle = k_full_angle * turns * part + amplitude * std::sin(k_full_angle * swings * part + 0.3);
    const double size = 2.0 + std::cos(k_full_angle * 31.0 * part);
    vectors.emplace_back(size * std::cos(angle), size * std::sin(angle), 0.0);
  }
  return vectors;
}

/// exp(i a sin x) = sum J_n(a) exp(i n x): the steady part has the energy J_0^2, each harmonic 2 J_n^2. The window
/// moves energy by one bin only.
TEST(NuDirection, KeepsTheHarmonicsBelowTheCutoff) {
  constexpr double k_swing = 0.7;
  const double j0 = std::cyl_bessel_j(0.0, k_swing), j1 = std::cyl_bessel_j(1.0, k_swing);
  const double j2 = std::cyl_bessel_j(2.0, k_swing);
  for (const double turns : {0.0, 3.0}) {  // a steady ideal and one that rotates
    const auto ideal = swinging(1000, turns, 0.0, 0.0);
    const auto measured = swinging(1000, turns, 120.0, k_swing);
    const auto below = [&](double hz) { return *nu_direction(ideal, measured, 1000.0, hz); };
    EXPECT_NEAR(below(50.0), j0 * j0, k_rounding) << turns;
    EXPECT_NEAR(below(130.0), j0 * j0 + 2.0 * j1 * j1, k_rounding) << turns;
    EXPECT_NEAR(below(250.0), j0 * j0 + 2.0 * (j1 * j1 + j2 * j2), k_rounding) << turns;
    EXPECT_NEAR(*nu_direction(ideal, swinging(1000, turns, 2.0, k_swing), 1000.0, 50.0), 1.0, 1e-9)
        << "a slow error is not noise";
    EXPECT_NEAR(*nu_direction(ideal, ideal, 1000.0, 50.0), 1.0, k_rounding);
  }
}

TEST(NuDirection, IsOneOverAllFrequenciesUnlessForcesAreMissed) {
  const auto ideal = swinging(399, 1.0, 0.0, 0.0);
  auto measured = swinging(399, 0.0, 90.0, 1.1);
  constexpr double k_all = 499.0;  // an odd number of steps has no frequency above 498.8 Hz
  EXPECT_NEAR(*nu_direction(ideal, measured, 1000.0, k_all), 1.0, k_rounding);
  // Hann's energy over every third step is a third of the whole.
  for (std::size_t k = 0; k < measured.size(); k += 3) measured[k].setZero();
  EXPECT_NEAR(*nu_direction(ideal, measured, 1000.0, k_all), 2.0 / 3.0, k_rounding);
  const std::vector<Eigen::Vector3d> zero(399, Eigen::Vector3d::Zero());
  EXPECT_FALSE(nu_direction(zero, measured, 1000.0, 50.0));
  EXPECT_EQ(*nu_direction(ideal, zero, 1000.0, 50.0), 0.0);
  EXPECT_THROW(nu_direction(ideal, measured, 1000.0, 500.0), BadArgument);
}

std::vector<Eigen::Vector3d> along_x(const std::vector<double>& x) {
  std::vector<Eigen::Vector3d> vectors;
  for (const double value : x) vectors.emplace_back(value, 0.0, 0.0);
  return vectors;
}

TEST(ResidualNoise, SeesOnlyWhatIsAboveTheCutoff) {
  // A gain of 2.5, plus a tone of amplitude 0.2 at 120 Hz across the force. Through the same Hann window the ratio of
  // the energies is that of the mean squares: 0.02 over (2.5 * 4)^2.
  const std::size_t count = 1000;
  std::vector<Eigen::Vector3d> ideal(count, Eigen::Vector3d(4.0, 0.0, 0.0));
  std::vector<Eigen::Vector3d> measured = ideal;
  const std::vector<double> noise = tone(count, 120.0, 0.2);
  for (std::size_t k = 0; k < count; ++k) measured[k] = 2.5 * ideal[k] + Eigen::Vector3d(0.0, noise[k], 0.0);
  EXPECT_NEAR(*residual_noise(ideal, measured, 1000.0, 50.0), 0.02 / 100.0, k_rounding);
  EXPECT_NEAR(*residual_noise(ideal, measured, 1000.0, 130.0), 0.0, k_rounding);
  // The same steps at half the rate: the tone is at 60 Hz.
  EXPECT_NEAR(*residual_noise(ideal, measured, 500.0, 70.0), 0.0, k_rounding);
}

TEST(ResidualNoise, ASmallGainIsNotNoise) {
  const std::vector<Eigen::Vector3d> ideal = along_x(tone(1000, 120.0, 2.0));
  const std::vector<Eigen::Vector3d> faint = along_x(tone(1000, 120.0, 0.1));
  EXPECT_NEAR(*residual_noise(ideal, faint, 1000.0, 50.0), 0.0, k_rounding);
}

TEST(ResidualNoise, ASlowErrorIsNotNoise) {
  const std::vector<Eigen::Vector3d> ideal = along_x(std::vector<double>(1000, 1.0));
  std::vector<double> ramp(1000);
  for (std::size_t k = 0; k < ramp.size(); ++k) ramp[k] = 0.8 + 0.0004 * static_cast<double>(k);
  constexpr double k_window_leak = 1e-9;  // leakage of a ramp through the Hann window at 50 bins from the mean
  EXPECT_LT(*residual_noise(ideal, along_x(ramp), 1000.0, 50.0), k_window_leak);
}

TEST(ResidualNoise, AnOppositeForceIsComparedWithItself) {
  const std::vector<Eigen::Vector3d> ideal = along_x(std::vector<double>(500, 1.0));
  EXPECT_NEAR(*residual_noise(ideal, along_x(std::vector<double>(500, -3.0)), 1000.0, 50.0), 0.0, k_rounding);
  EXPECT_FALSE(residual_noise(ideal, along_x(std::vector<double>(500, 0.0)), 1000.0, 50.0));
  EXPECT_NO_THROW(residual_noise(ideal, ideal, 1000.0, 0.0));
  EXPECT_THROW(residual_noise(ideal, ideal, 1000.0, 500.0), BadArgument);
  EXPECT_THROW(residual_noise(ideal, ideal, 1000.0, -1.0), BadArgument);
}

/// As the torque of a point shell has it in Ia, next to the block's ends only.
TEST(Spectrum, OfAnIdealThatActsAtTheEndsOnlyIsEmpty) {
  std::vector<double> noisy = tone(1000, 120.0, 0.2);
  for (double& value : noisy) value += 1.0;
  const std::vector<Eigen::Vector3d> measured = along_x(noisy);
  std::vector<double> ends(1000, 0.0);
  for (std::size_t k = 0; k < 6; ++k) ends[k] = ends[999 - k] = 1.0;
  EXPECT_FALSE(residual_noise(along_x(ends), measured, 1000.0, 50.0));
  EXPECT_FALSE(nu_direction(along_x(ends), measured, 1000.0, 50.0));
  ends[100] = 1.0;
  EXPECT_TRUE(nu_direction(along_x(ends), measured, 1000.0, 50.0));
  EXPECT_TRUE(residual_noise(along_x(ends), measured, 1000.0, 50.0));
}

TEST(ShortTimeSpectrum, ShowsWhenAToneStarts) {
  // Silence, then 125 Hz at 1 kHz.
  std::vector<double> signal(512, 0.0);
  const std::vector<double> late = tone(512, 64.0, 1.0);
  signal.insert(signal.end(), late.begin(), late.end());
  const Spectrogram diagram = short_time_spectrum(signal, 1000.0, 128, 64);
  EXPECT_EQ(diagram.times.size(), (1024u - 128u) / 64u + 1u);
  EXPECT_EQ(diagram.frequencies.size(), 65u);
  EXPECT_EQ(diagram.intensity.size(), diagram.times.size() * diagram.frequencies.size());
  EXPECT_NEAR(diagram.times.front(), 0.064, k_rounding);
  EXPECT_NEAR(diagram.frequencies[16], 125.0, k_rounding);
  const auto at = [&](std::size_t time, std::size_t bin) {
    return diagram.intensity[time * diagram.frequencies.size() + bin];
  };
  EXPECT_EQ(at(0, 16), 0.0);
  // Hann halves the amplitude: |X| = 128 / 4 at the tone's bin, twice squared over 128.
  EXPECT_NEAR(at(diagram.times.size() - 1, 16), 2.0 * 32.0 * 32.0 / 128.0, k_rounding * 100);
  EXPECT_NEAR(at(diagram.times.size() - 1, 30), 0.0, k_rounding);
  EXPECT_THROW(short_time_spectrum(signal, 1000.0, 2048, 64), BadArgument);
  EXPECT_THROW(short_time_spectrum(signal, 1000.0, 64, 0), BadArgument);
}

TEST(ShortTimeSpectrum, FollowsAChirp) {
  // Frequency rising from 40 Hz by 300 Hz a second: phase 2 pi (40 t + 150 t^2).
  constexpr double k_rate_hz = 1000.0;
  std::vector<double> signal;
  for (int k = 0; k < 1000; ++k) {
    const double t = k / k_rate_hz;
    signal.push_back(0.7 * std::sin(k_full_angle * (40.0 * t + 150.0 * t * t)));
  }
  const Spectrogram diagram = short_time_spectrum(signal, k_rate_hz, 64, 8);
  const std::size_t bins = diagram.frequencies.size();
  const double bin_width = diagram.frequencies[1];
  EXPECT_NEAR(bin_width, k_rate_hz / 64.0, k_rounding);
  for (std::size_t row = 0; row < diagram.times.size(); ++row) {
    const auto from = diagram.intensity.begin() + static_cast<std::ptrdiff_t>(row * bins);
    const auto strongest = std::max_element(from, from + static_cast<std::ptrdiff_t>(bins)) - from;
    const double expected = 40.0 + 300.0 * diagram.times[row];
    EXPECT_LE(std::abs(diagram.frequencies[static_cast<std::size_t>(strongest)] - expected), 0.75 * bin_width) << row;
    // The chirp keeps its strength: a piece of amplitude a under a Hann window has energy (3/8) a^2 / 2 per step.
    EXPECT_NEAR(std::accumulate(from, from + static_cast<std::ptrdiff_t>(bins), 0.0), 64.0 * 0.375 * 0.49 / 2.0,
                0.1 * 64.0 * 0.375 * 0.49 / 2.0);
  }
}

}  // namespace
}  // namespace sixdof
