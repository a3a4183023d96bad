#pragma once

#include <cstddef>
#include <optional>

#include <sixdof/measure/signal.h>

namespace sixdof {

/// Angle between two vectors in degrees, 0..180, by atan2(|a x b|, a.b): accurate near 0 and 180 degrees, where the
/// arc cosine loses half of the digits. 0 if either vector is zero.
double angle_degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

struct DirectionError {
  /// Mean angle over the steps where both vectors are nonzero; empty if there is no such step.
  /// Source: Weller et al. 2010, formula (2), in degrees: the paper's values exceed pi.
  std::optional<double> gamma_degrees;
  double largest_degrees = 0.0;
  std::size_t compared = 0;        ///< Both are nonzero.
  std::size_t misses = 0;          ///< The ideal is nonzero, the measured one is zero: tunnelling.
  std::size_t false_contacts = 0;  ///< The ideal is zero, the measured one is nonzero.
  std::size_t skipped = 0;         ///< Both are zero.
};

/// Zero as nonzero() (signal.h) decides it. Every step is in exactly one of the four counts.
DirectionError direction_error(Vectors ideal, Vectors measured);

}  // namespace sixdof
