#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace sixdof {

/// (cos, sin) of an angle given in turns (1 = 360 degrees), the same bits on every machine: std::sin may differ in the
/// last bit between versions of the C library and between processors, and a model's content hash must not. Error at
/// most 1e-16 plus the rounding of `turns` itself. Multiples of a quarter turn are exact.
Eigen::Vector2d unit_at(double turns);

/// (cos, sin) of numerator/denominator turns, reduced in integers, so that points of a regular polygon have its
/// symmetries exactly. `denominator` is positive and below 2^60.
Eigen::Vector2d unit_at(std::uint64_t numerator, std::uint64_t denominator);

}  // namespace sixdof
