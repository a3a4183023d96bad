#include <sixdof/results/estimate.h>

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/statistics/univariate_statistics.hpp>

namespace sixdof::results {
namespace {

constexpr double k_tail = 0.025;  ///< Of a 95 % interval.

}  // namespace

double median(std::vector<double> values) { return boost::math::statistics::median(values); }

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  const double place = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  return std::lerp(values[low], values[std::min(low + 1, values.size() - 1)], place - static_cast<double>(low));
}

double student_t95(double degrees_of_freedom) {
  return boost::math::quantile(boost::math::complement(boost::math::students_t(degrees_of_freedom), k_tail));
}

LogMoments log_moments(std::span<const double> values) {
  std::vector<double> logs;
  for (const double value : values) logs.push_back(std::log(value));
  return {.mean = boost::math::statistics::mean(logs),
          .variance = logs.size() < 2 ? 0.0 : boost::math::statistics::sample_variance(logs),
          .count = static_cast<double>(logs.size())};
}

double geometric_mean(std::span<const double> values) { return std::exp(log_moments(values).mean); }

Estimate mean_of_repetitions(std::vector<double> times) {
  if (times.size() < k_fewest_repetitions) {
    const double middle = median(std::move(times));
    return {middle, middle * (1.0 - k_run_to_run), middle * (1.0 + k_run_to_run)};
  }
  const auto [mean, variance, n] = log_moments(times);
  const double half = student_t95(n - 1.0) * std::sqrt(variance / n);
  return {std::exp(mean), std::exp(mean - half), std::exp(mean + half)};
}

Estimate median_of_rounds(std::vector<double> times) {
  if (times.empty()) return {};
  std::ranges::sort(times);
  const std::size_t n = times.size();
  const boost::math::binomial values_below_median(static_cast<double>(n), 0.5);
  const auto rank = static_cast<std::size_t>(boost::math::quantile(values_below_median, k_tail));
  const double low = times[rank], high = times[n - 1 - rank], middle = median(std::move(times));
  return {middle, std::min(low, (1.0 - k_run_to_run) * middle), std::max(high, (1.0 + k_run_to_run) * middle)};
}

}  // namespace sixdof::results
