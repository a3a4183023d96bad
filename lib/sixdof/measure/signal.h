#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace sixdof {

/// One vector per step of a path: forces or torques, in any consistent unit.
using Vectors = std::span<const Eigen::Vector3d>;

/// A vector shorter than this fraction of the longest one of its series counts as zero. Rounding accumulated over some
/// thousand terms of the peak's size stays below it.
inline constexpr double k_zero_fraction = 1e-12;

std::vector<double> magnitudes(Vectors vectors);

/// Largest magnitude; 0 for an empty series.
double peak(Vectors vectors);

/// Per step, whether the magnitude exceeds k_zero_fraction of the series' peak. All false for a series of zeros.
std::vector<bool> nonzero(Vectors vectors);

/// @throws BadArgument unless both series have the same length. Every measure of two series calls this first.
void check_same_length(Vectors ideal, Vectors measured);

}  // namespace sixdof
