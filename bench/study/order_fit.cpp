#include "bench/study/order_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <boost/math/statistics/linear_regression.hpp>
#include <boost/math/statistics/univariate_statistics.hpp>

namespace sixdof::study {

std::optional<OrderFit> fit_order(std::span<const double> resolution, std::span<const double> error) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < resolution.size(); ++i) {
    if (!(resolution[i] > 0.0) || !(error[i] > 0.0)) continue;
    x.push_back(std::log(resolution[i]));
    y.push_back(std::log(error[i]));
  }
  if (x.size() < 3 || std::ranges::all_of(x, [&](double each) { return each == x.front(); })) return std::nullopt;
  const auto [offset, order] = boost::math::statistics::simple_ordinary_least_squares(x, y);
  double residual = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) residual += std::pow(y[i] - offset - order * x[i], 2);
  const double xx = boost::math::statistics::variance(x) * static_cast<double>(x.size());
  return OrderFit{.order = order, .standard_error = std::sqrt(residual / (static_cast<double>(x.size()) - 2.0) / xx)};
}

}  // namespace sixdof::study
