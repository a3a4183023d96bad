#pragma once

#include <cstddef>
#include <optional>

#include <sixdof/measure/signal.h>

namespace sixdof {

/// Angle between two vectors in degrees, 0..180, by atan2(|a x b|, a.b): accurate near 0 and 180 degrees, where the
/// arc cosine loses half of the digits. 0 if either vector is zero.
double angle_degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

struct DirectionError {
  /// Mean angle over the stamps where both act; empty if there is none.
  /// Source: Weller et al. 2010, formula (2), in degrees as the paper's values are (7.64 is more than pi).
  std::optional<double> gamma_degrees;
  double largest_degrees = 0.0;
  std::size_t compared = 0;        ///< Both act.
  std::size_t misses = 0;          ///< The ideal acts, the measured one is zero: tunnelling.
  std::size_t false_contacts = 0;  ///< The measured one acts where the ideal is zero.
  std::size_t skipped = 0;         ///< Both are zero.
};

/// Zero is what acting() calls zero. Every stamp is counted in exactly one of the four counts.
DirectionError direction_error(Vectors ideal, Vectors measured);

}  // namespace sixdof
