#include <sixdof/models/cos_sin.h>

#include <cmath>
#include <numbers>

namespace sixdof {
namespace {

/// (cos x, sin x) for |x| <= pi/4 by Taylor series up to x^18 / 18!; the next term is below 1e-20. Sums and products in
/// a fixed order only: the same bits everywhere.
Eigen::Vector2d cos_sin_near_zero(double x) {
  const double s = x * x;
  double cosine = 0.0;
  double sine = 0.0;
  for (int k = 18; k >= 2; k -= 2) {
    cosine = (1.0 - cosine) * s / (k * (k - 1));
    sine = (1.0 - sine) * s / (k * (k + 1));
  }
  return {1.0 - cosine, x - x * sine};
}

Eigen::Vector2d rotate_by_quarters(Eigen::Vector2d u, unsigned quarters) {
  for (unsigned i = 0; i < quarters % 4; ++i) u = Eigen::Vector2d(-u.y(), u.x());
  return u;
}

}  // namespace

Eigen::Vector2d cos_sin(double revolutions) {
  const double quarters = std::floor(4.0 * revolutions + 0.5);
  const double rest = revolutions - 0.25 * quarters;
  const double wrapped = quarters - 4.0 * std::floor(0.25 * quarters);
  return rotate_by_quarters(cos_sin_near_zero(2.0 * std::numbers::pi * rest), static_cast<unsigned>(wrapped));
}

Eigen::Vector2d cos_sin(std::uint64_t numerator, std::uint64_t denominator) {
  const std::uint64_t whole = 4 * (numerator % denominator);
  const std::uint64_t quarters = (2 * whole + denominator) / (2 * denominator);
  const auto rest = static_cast<std::int64_t>(whole - quarters * denominator);
  // Half-way between two quarters cosine and sine are equal; the series could differ in the last bit.
  if (2 * whole + denominator == 2 * denominator * quarters) {
    const double eighth = std::sqrt(0.5);
    return rotate_by_quarters({eighth, -eighth}, static_cast<unsigned>(quarters));
  }
  return rotate_by_quarters(
      cos_sin_near_zero(0.5 * std::numbers::pi * (static_cast<double>(rest) / static_cast<double>(denominator))),
      static_cast<unsigned>(quarters));
}

}  // namespace sixdof
