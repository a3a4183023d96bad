#include <sixdof/measure/perception.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <sixdof/measure/direction.h>
#include <sixdof/measure/perception_thresholds.h>
#include <sixdof/measure/spectrum.h>

namespace sixdof {
namespace {

using namespace perception;

/// Length of a piece that is scored for vibration, in seconds: a vibration sums up over about this time.
constexpr double k_piece_s = 0.25;

double norm_of(double a, double b, double c) { return std::sqrt(a * a + b * b + c * c); }

}  // namespace

double PerceptualScores::pooled() const {
  return std::sqrt(magnitude * magnitude + direction * direction + vibration * vibration + jump * jump);
}

double vibration_threshold(double frequency_hz) {
  const double octaves = std::abs(std::log2(std::max(frequency_hz, k_flat_until_hz) / k_most_sensitive_hz));
  return k_least_displacement * std::pow(10.0, k_slope_db_per_octave * octaves / 20.0);
}

double buzz(std::span<const double> force_N, double rate_hz) {
  const std::size_t n = force_N.size();
  if (n < 2) return 0.0;
  std::vector<double> windowed = hann(n);
  double squares = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    squares += windowed[k] * windowed[k];
    windowed[k] *= force_N[k];
  }
  const std::vector<double> energy = energy_spectrum(windowed);
  double sum = 0.0;
  for (std::size_t j = 1; j < energy.size(); ++j) {
    const double f = rate_hz * static_cast<double>(j) / static_cast<double>(n);
    if (f < k_vibration_from_hz || f > k_vibration_to_hz) continue;
    const double force_squared = 2.0 * energy[j] / squares;  // of a tone, these sum up to its amplitude squared
    const double per_newton = 1.0 / (k_felt_mass * std::pow(2.0 * std::numbers::pi * f, 2));
    sum += force_squared * std::pow(per_newton / vibration_threshold(f), 2);
  }
  return std::sqrt(sum);
}

std::optional<PerceptualScores> perceptual_scores(Vectors ideal, Vectors measured, double gain, double rate_hz) {
  check_same_length(ideal, measured);
  const double full = gain * peak(ideal);
  if (!(full > 0.0) || peak(measured) == 0.0) return std::nullopt;
  PerceptualScores scores;
  std::array<std::vector<double>, 3> residual;  // components, in N
  double steps = 0.0;
  for (std::size_t k = 0; k < ideal.size(); ++k) {
    const Eigen::Vector3d wanted = gain * ideal[k], off = (measured[k] - wanted) * (k_full_force / full);
    for (std::size_t axis = 0; axis < 3; ++axis) residual[axis].push_back(off[static_cast<Eigen::Index>(axis)]);
    if (wanted.norm() < k_noticeable_fraction * full) continue;
    steps += 1.0;
    scores.magnitude += std::pow((measured[k].norm() / wanted.norm() - 1.0) / k_force_fraction, 2);
    scores.direction += std::pow(angle_degrees(wanted, measured[k]) / k_direction_degrees, 2);
  }
  scores.magnitude = std::sqrt(scores.magnitude / steps);
  scores.direction = std::sqrt(scores.direction / steps);
  for (std::size_t k = 1; k < ideal.size(); ++k) {
    const double change = norm_of(residual[0][k] - residual[0][k - 1], residual[1][k] - residual[1][k - 1],
                                  residual[2][k] - residual[2][k - 1]);
    scores.jump = std::max(scores.jump, change / (k_force_fraction * k_full_force));
  }
  const std::size_t piece = std::min(ideal.size(), static_cast<std::size_t>(k_piece_s * rate_hz));
  for (std::size_t first = 0; piece > 1 && first + piece <= ideal.size();
       first += std::max<std::size_t>(1, piece / 2)) {
    const auto score = [&](std::size_t axis) { return buzz(std::span(residual[axis]).subspan(first, piece), rate_hz); };
    scores.vibration = std::max(scores.vibration, norm_of(score(0), score(1), score(2)));
  }
  return scores;
}

}  // namespace sixdof
