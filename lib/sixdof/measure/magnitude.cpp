#include <sixdof/measure/magnitude.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

double square(double x) { return x * x; }

void check_lengths(std::size_t ideal, std::size_t measured) {
  if (ideal == measured) return;
  throw BadArgument(fmt::format("{} ideal steps cannot be compared with {} measured ones", ideal, measured));
}

}  // namespace

std::vector<double> magnitudes(Vectors vectors) {
  std::vector<double> result(vectors.size());
  std::transform(vectors.begin(), vectors.end(), result.begin(), [](const Eigen::Vector3d& v) { return v.norm(); });
  return result;
}

double peak(Vectors vectors) {
  double largest = 0.0;
  for (const Eigen::Vector3d& v : vectors) largest = std::max(largest, v.norm());
  return largest;
}

double peak(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

void check_same_length(Vectors ideal, Vectors measured) { check_lengths(ideal.size(), measured.size()); }

void check_same_length(std::span<const double> ideal, std::span<const double> measured) {
  check_lengths(ideal.size(), measured.size());
}

std::optional<double> sigma(Vectors ideal, Vectors measured) { return sigma(magnitudes(ideal), magnitudes(measured)); }

std::optional<double> sigma(std::span<const double> ideal, std::span<const double> measured) {
  check_same_length(ideal, measured);
  const double ideal_peak = peak(ideal);
  const double measured_peak = peak(measured);
  if (ideal_peak == 0.0) return std::nullopt;
  const double measured_scale = measured_peak > 0.0 ? 1.0 / measured_peak : 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < ideal.size(); ++k) {
    sum += square(ideal[k] / ideal_peak - measured[k] * measured_scale);
  }
  return std::sqrt(sum / static_cast<double>(ideal.size()));
}

std::optional<double> sigma_paper(Vectors ideal, Vectors measured) {
  const std::optional<double> root_mean_square = sigma(ideal, measured);
  if (!root_mean_square) return std::nullopt;
  return *root_mean_square / std::sqrt(static_cast<double>(ideal.size()));
}

std::optional<GainFit> fit_gain(Vectors ideal, Vectors measured) {
  return fit_gain(magnitudes(ideal), magnitudes(measured));
}

std::optional<GainFit> fit_gain(std::span<const double> ideal, std::span<const double> measured) {
  check_same_length(ideal, measured);
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < ideal.size(); ++k) {
    products += ideal[k] * measured[k];
    squares += square(ideal[k]);
  }
  if (squares == 0.0 || !(products > 0.0)) return std::nullopt;
  GainFit fit;
  fit.gain = products / squares;
  double residual = 0.0;
  for (std::size_t k = 0; k < ideal.size(); ++k) residual += square(measured[k] - fit.gain * ideal[k]);
  fit.sigma = std::sqrt(residual / static_cast<double>(ideal.size())) / (fit.gain * peak(ideal));
  return fit;
}

std::optional<MagnitudeError> magnitude_error(std::span<const double> ideal, std::span<const double> measured) {
  check_same_length(ideal, measured);
  double products = 0.0, ideal_squares = 0.0, measured_squares = 0.0;
  for (std::size_t k = 0; k < ideal.size(); ++k) {
    products += ideal[k] * measured[k];
    ideal_squares += square(ideal[k]);
    measured_squares += square(measured[k]);
  }
  if (ideal_squares == 0.0) return std::nullopt;
  MagnitudeError error{.gain = products / ideal_squares, .relative = 1.0};
  if (measured_squares == 0.0) return error;
  double residual = 0.0;
  for (std::size_t k = 0; k < ideal.size(); ++k) residual += square(measured[k] - error.gain * ideal[k]);
  error.relative = std::sqrt(residual / measured_squares);
  return error;
}

}  // namespace sixdof
