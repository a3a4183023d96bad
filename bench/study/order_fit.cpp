#include "bench/study/order_fit.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace sixdof::study {

std::optional<OrderFit> fit_order(std::span<const double> resolution, std::span<const double> error) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < resolution.size(); ++i) {
    if (!(resolution[i] > 0.0) || !(error[i] > 0.0)) continue;
    x.push_back(std::log(resolution[i]));
    y.push_back(std::log(error[i]));
  }
  if (x.size() < 3) return std::nullopt;
  const auto n = static_cast<double>(x.size());
  double mean_x = 0.0, mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / n;
    mean_y += y[i] / n;
  }
  double xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  if (xx == 0.0) return std::nullopt;
  const double order = xy / xx;
  double residual = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double difference = y[i] - mean_y - order * (x[i] - mean_x);
    residual += difference * difference;
  }
  return OrderFit{.order = order, .standard_error = std::sqrt(residual / (n - 2.0) / xx)};
}

}  // namespace sixdof::study
