#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace sixdof {

/// One vector per step of a path: forces or torques, in any consistent unit.
using Vectors = std::span<const Eigen::Vector3d>;

/// Length of each vector, in its unit.
std::vector<double> magnitudes(Vectors vectors);

/// Largest magnitude; 0 for an empty series.
double peak(Vectors vectors);
/// Largest absolute value; 0 for an empty series.
double peak(std::span<const double> values);

/// @throws BadArgument unless both series have the same length. Every measure of two series calls this first.
void check_same_length(Vectors ideal, Vectors measured);
/// The same for series of numbers.
void check_same_length(std::span<const double> ideal, std::span<const double> measured);

/// RMS difference of the magnitudes: sqrt(1/N sum (|i_k|/max|i| - |m_k|/max|m|)^2), a pure number. Each series is
/// normalised by its own largest magnitude, so a gain error does not show, and a single spike changes the scale of the
/// series; see fit_gain(). Source: Weller et al. 2010, formula (1), with the sum divided by N inside the root: only
/// this reading gives the values the paper prints, and only this one does not depend on the number of steps.
///
/// Empty where the ideal is zero throughout. A measured series that is zero throughout is compared as zero.
std::optional<double> sigma(Vectors ideal, Vectors measured);

/// The same of scalars, such as penalties: sqrt(1/N sum (i_k/max|i| - m_k/max|m|)^2). Signs are kept: a negative
/// penalty is an error. @throws BadArgument unless both have the same length
std::optional<double> sigma(std::span<const double> ideal, std::span<const double> measured);

/// Formula (1) as printed: (1/N) sqrt(sum ...) = sigma / sqrt(N). Shrinks as the same path gets more steps.
std::optional<double> sigma_paper(Vectors ideal, Vectors measured);

/// Answer of fit_gain().
struct GainFit {
  double gain = 0.0;   ///< Factor on the ideal magnitudes that fits the measured ones best, >= 0; unit measured/ideal.
  double sigma = 0.0;  ///< RMS of |m| - gain |i| over gain max|i|, a pure number.
};

/// Least-squares gain g = sum |m||i| / sum |i|^2 and its residual. A gain error shows in it, and one spike hardly moves
/// it. Empty where the ideal or the measured series is zero throughout.
std::optional<GainFit> fit_gain(Vectors ideal, Vectors measured);

/// The same of scalars. Empty where their products sum to zero or less: no gain fits a penalty of the wrong sign.
/// @throws BadArgument unless both have the same length
std::optional<GainFit> fit_gain(std::span<const double> ideal, std::span<const double> measured);

/// Answer of magnitude_error().
struct MagnitudeError {
  double gain = 0.0;      ///< As in GainFit; 0 where the measured magnitudes are all zero.
  double relative = 0.0;  ///< RMS of m - gain i over the RMS of m, 0..1, a pure number.
};

/// How far measured magnitudes m are from proportional to the ideal ones i, whatever their unit: 0 if m = gain i, and 1
/// if they have nothing in common or the measured ones are all zero. It is the sine of the angle between the two series
/// as vectors, so exchanging them changes the gain only. Unlike GainFit::sigma it does not depend on the largest value.
///
/// Empty where the ideal is zero throughout. Squares of the magnitudes and their sums must not overflow.
/// @param ideal, measured >= 0. @throws BadArgument unless both have the same length
std::optional<MagnitudeError> magnitude_error(std::span<const double> ideal, std::span<const double> measured);

}  // namespace sixdof
