#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace sixdof {

/// One vector per time stamp: forces or torques, any consistent unit.
using Vectors = std::span<const Eigen::Vector3d>;

/// A vector shorter than this share of its series' longest one is zero: accumulated rounding of some thousand terms of
/// the peak's size, and far below what any device can show.
inline constexpr double k_zero_share = 1e-12;

std::vector<double> magnitudes(Vectors vectors);

/// Largest magnitude; 0 for an empty series.
double peak(Vectors vectors);

/// Per stamp, whether the magnitude exceeds k_zero_share of the series' peak. A series of zeros is zero everywhere.
std::vector<bool> acting(Vectors vectors);

/// @throws BadArgument unless both series have the same length. Every measure of two series calls this first.
void check_same_length(Vectors ideal, Vectors measured);

}  // namespace sixdof
