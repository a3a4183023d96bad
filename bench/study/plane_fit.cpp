#include "bench/study/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Dense>

#include <sixdof/base/error.h>

namespace sixdof::study {
namespace {

/// Smallest ratio of the singular values of a fit that determines its coefficients. Resolutions span a few decades, so
/// a quadratic of a good grid has ratios down to 1e-6; points on a line leave rounding, about 1e-16.
constexpr double k_least_singular_ratio = 1e-11;

/// Length of the kernel of residuals in natural logarithms of a resolution: neighbours of a grid are a factor of 2 to
/// 10 apart, so a residual reaches its neighbours and not much farther.
constexpr double k_kernel_length = 0.8;

/// Variance of the noise of a sample over that of the residuals: repeated times differ by a few percent, residuals are
/// of tens of percent.
constexpr double k_noise = 1e-3;

double kernel(double dx, double dy) {
  return std::exp(-(dx * dx + dy * dy) / (2.0 * k_kernel_length * k_kernel_length));
}

bool is_logarithmic(FitForm form) { return form == FitForm::log_plane || form == FitForm::log_quadratic; }

Eigen::Index terms(FitForm form) { return form == FitForm::plane || form == FitForm::log_plane ? 3 : 6; }

std::array<double, 6> basis(FitForm form, double x, double y) {
  if (is_logarithmic(form)) {
    x = std::log(x);
    y = std::log(y);
  }
  return {1.0, x, y, x * x, x * y, y * y};
}

/// @returns whether the samples determine the coefficients
bool solve(FitForm form, std::span<const FitSample> samples, std::array<double, 6>& coefficients) {
  const Eigen::Index n = terms(form);
  const auto rows = static_cast<Eigen::Index>(samples.size());
  if (rows < n) return false;
  Eigen::MatrixXd matrix(rows, n);
  Eigen::VectorXd values(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const FitSample& sample = samples[static_cast<std::size_t>(row)];
    const std::array<double, 6> b = basis(form, sample.x, sample.y);
    for (Eigen::Index i = 0; i < n; ++i) matrix(row, i) = b[static_cast<std::size_t>(i)];
    values[row] = is_logarithmic(form) ? std::log(sample.value) : sample.value;
  }
  // Columns of one length, so that units do not decide what counts as determined.
  const Eigen::VectorXd lengths = matrix.colwise().norm().cwiseMax(std::numeric_limits<double>::min());
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix * lengths.cwiseInverse().asDiagonal(),
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  if (!(svd.singularValues()[n - 1] > k_least_singular_ratio * svd.singularValues()[0])) return false;
  const Eigen::VectorXd solution = svd.solve(values).cwiseQuotient(lengths);
  std::copy(solution.begin(), solution.end(), coefficients.begin());
  return true;
}

double evaluate(FitForm form, const std::array<double, 6>& coefficients, double x, double y) {
  const std::array<double, 6> b = basis(form, x, y);
  double sum = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(terms(form)); ++i) sum += coefficients[i] * b[i];
  return is_logarithmic(form) ? std::exp(sum) : sum;
}

double leave_one_out_error(FitForm form, std::span<const FitSample> samples) {
  constexpr double k_undetermined = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (std::size_t left_out = 0; left_out < samples.size(); ++left_out) {
    std::vector<FitSample> others(samples.begin(), samples.end());
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
    const FitSample& sample = samples[left_out];
    std::array<double, 6> coefficients{};
    if (sample.value == 0.0 || !solve(form, others, coefficients)) return k_undetermined;
    const double error = evaluate(form, coefficients, sample.x, sample.y) / sample.value - 1.0;
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

bool all_positive(std::span<const FitSample> samples) {
  return std::ranges::all_of(samples, [](const FitSample& s) { return s.value > 0.0 && s.x > 0.0 && s.y > 0.0; });
}

SurfaceFit better(const SurfaceFit& a, const SurfaceFit& b) { return b.leave_one_out() < a.leave_one_out() ? b : a; }

}  // namespace

std::string_view to_string(FitForm form) {
  constexpr std::array<std::string_view, 4> k_words{"linear", "log-log", "quadratic", "log-log quadratic"};
  return k_words.at(static_cast<std::size_t>(form));
}

SurfaceFit::SurfaceFit(FitForm form, std::span<const FitSample> samples) : form_(form) {
  if (is_logarithmic(form) && !all_positive(samples)) {
    throw BadArgument("a fit of logarithms needs positive resolutions and values");
  }
  if (!solve(form, samples, coefficients_)) {
    throw BadArgument("the measured resolutions do not determine a fit: too few, or all on one line");
  }
  leave_one_out_ = leave_one_out_error(form, samples);
}

double SurfaceFit::at(double x, double y) const { return evaluate(form_, coefficients_, x, y); }

SurfaceFit fit_plane(std::span<const FitSample> samples) {
  const SurfaceFit linear(FitForm::plane, samples);
  return all_positive(samples) ? better(linear, SurfaceFit(FitForm::log_plane, samples)) : linear;
}

SurfaceFit fit_surface(std::span<const FitSample> samples) {
  const bool logarithms = all_positive(samples);
  const SurfaceFit plane(logarithms ? FitForm::log_plane : FitForm::plane, samples);
  const FitForm curved = logarithms ? FitForm::log_quadratic : FitForm::quadratic;
  std::array<double, 6> ignored{};
  return solve(curved, samples, ignored) ? better(plane, SurfaceFit(curved, samples)) : plane;
}

CorrectedFit::CorrectedFit(const SurfaceFit& fit, std::span<const FitSample> samples) : fit_(fit) {
  const auto n = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd covariance(n, n);
  Eigen::VectorXd residuals(n);
  for (const FitSample& sample : samples) {
    ratios_ = ratios_ && sample.value > 0.0 && fit_.at(sample.x, sample.y) > 0.0;
    centres_.push_back({std::log(sample.x), std::log(sample.y), 0.0});
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const FitSample& sample = samples[static_cast<std::size_t>(i)];
    const double fitted = fit_.at(sample.x, sample.y);
    residuals[i] = ratios_ ? std::log(sample.value / fitted) : sample.value - fitted;
    for (Eigen::Index j = 0; j < n; ++j) {
      const Centre &a = centres_[static_cast<std::size_t>(i)], &b = centres_[static_cast<std::size_t>(j)];
      covariance(i, j) = kernel(a.log_x - b.log_x, a.log_y - b.log_y) + (i == j ? k_noise : 0.0);
    }
  }
  const Eigen::VectorXd coefficients = covariance.ldlt().solve(residuals);
  for (Eigen::Index i = 0; i < n; ++i) centres_[static_cast<std::size_t>(i)].coefficient = coefficients[i];
}

double CorrectedFit::at(double x, double y) const {
  const double log_x = std::log(x), log_y = std::log(y);
  double correction = 0.0;
  for (const Centre& centre : centres_) {
    correction += centre.coefficient * kernel(log_x - centre.log_x, log_y - centre.log_y);
  }
  return ratios_ ? fit_.at(x, y) * std::exp(correction) : fit_.at(x, y) + correction;
}

}  // namespace sixdof::study
