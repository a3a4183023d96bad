#pragma once

#include <optional>

#include <sixdof/measure/signal.h>

namespace sixdof {

/// Deviation of the magnitude's curve: sqrt(1/N sum (|i_k|/max|i| - |m_k|/max|m|)^2), a pure number. Each series is
/// normalised by its own largest magnitude, so a gain error is invisible here and one spike sets the scale; see
/// fit_gain(). Source: Weller et al. 2010, formula (1), with the sum divided by N inside the root: only that reading
/// gives the values the paper prints, and only that one does not depend on the sampling.
///
/// Empty where the ideal is zero throughout (there is no curve to compare with). A measured series that is zero
/// throughout is compared as zero.
std::optional<double> sigma(Vectors ideal, Vectors measured);

/// Formula (1) as printed: (1/N) sqrt(sum ...) = sigma / sqrt(N). Shrinks when the same path is sampled more finely.
std::optional<double> sigma_paper(Vectors ideal, Vectors measured);

struct GainFit {
  double gain = 0.0;   ///< Factor on the ideal magnitudes that fits the measured ones best, >= 0; unit measured/ideal.
  double sigma = 0.0;  ///< RMS of |m| - gain |i| over gain max|i|, a pure number.
};

/// Least-squares gain g = sum |m||i| / sum |i|^2 and what is left after it. Unlike sigma() it is not moved by one spike
/// as a whole, and it shows a gain error as a number. Empty where the ideal or the measured series is zero throughout.
std::optional<GainFit> fit_gain(Vectors ideal, Vectors measured);

}  // namespace sixdof
