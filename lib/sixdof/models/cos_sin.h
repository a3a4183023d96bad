#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace sixdof {

/// (cos, sin) of an angle in revolutions (1 = 360 degrees), the same bits on every machine: a model's content hash must
/// not depend on the C library's std::sin. Error at most 1e-16 plus that of the rounding of `revolutions`. Exact at
/// multiples of 1/4.
Eigen::Vector2d cos_sin(double revolutions);

/// (cos, sin) of numerator / denominator revolutions, reduced in integers: the points of a regular polygon have its
/// symmetries exactly. `denominator` is positive and below 2^60.
Eigen::Vector2d cos_sin(std::uint64_t numerator, std::uint64_t denominator);

}  // namespace sixdof
