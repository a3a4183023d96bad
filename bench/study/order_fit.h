#pragma once

#include <optional>
#include <span>

namespace sixdof::study {

/// error = c * resolution^order, fitted by least squares to the logarithms.
struct OrderFit {
  double order = 0.0;
  double standard_error = 0.0;  ///< Of the order.
};

/// Empty for fewer than three points whose resolution and error are positive. @param resolution, error of equal length
std::optional<OrderFit> fit_order(std::span<const double> resolution, std::span<const double> error);

}  // namespace sixdof::study
