#pragma once

#include <cstddef>
#include <optional>

#include <sixdof/measure/magnitude.h>

namespace sixdof {

/// Angle between two vectors in degrees, 0..180, by atan2(|a x b|, a.b): accurate near 0 and 180 degrees, where the
/// arc cosine loses half of the digits. 0 if either vector is zero.
double angle_degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Rounding accumulated over some thousand terms of the peak's size stays below it.
inline constexpr double k_zero_fraction = 1e-12;

/// How far measured vectors are from the ideal ones in direction.
struct DirectionError {
  /// Mean angle over the steps where both vectors are nonzero; empty if there is no such step.
  /// Source: Weller et al. 2010, formula (2), in degrees: the paper's values exceed pi.
  std::optional<double> gamma_degrees;
  double largest_degrees = 0.0;    ///< Largest angle, 0..180; 0 without a step where both are nonzero.
  std::size_t compared = 0;        ///< Both are nonzero.
  std::size_t misses = 0;          ///< The ideal is nonzero, the measured one is zero: tunnelling.
  std::size_t false_contacts = 0;  ///< The ideal is zero, the measured one is nonzero.
  std::size_t skipped = 0;         ///< Both are zero.
};

/// A vector up to k_zero_fraction of the longest one of its series is zero. Every step is in exactly one of the counts.
DirectionError direction_error(Vectors ideal, Vectors measured);

}  // namespace sixdof
