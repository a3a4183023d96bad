#pragma once

#include <optional>
#include <span>

#include <sixdof/measure/magnitude.h>

/// What a person would feel of a response's error: a model made of published thresholds (perception_thresholds.h), not
/// a user study. Every score is in units of a threshold: below 1 few would notice, above most would.

namespace sixdof {

/// Answer of perceptual_scores(), each in units of a threshold.
struct PerceptualScores {
  double magnitude = 0.0;  ///< RMS of |m| / (g |i|) - 1 over the steps with a noticeable ideal, over k_force_fraction.
  double direction = 0.0;  ///< RMS angle over the same steps, over k_direction_degrees.
  double vibration = 0.0;  ///< The loudest piece of 250 ms of the residual m - g i (buzz() of each component).
  /// Largest change of the residual within a step, over k_force_fraction of the ideal's peak g |i|.
  double jump = 0.0;
  /// Root of the sum of squares: discriminabilities of independent channels add so (Green and Swets, "Signal Detection
  /// Theory and Psychophysics", 1966).
  double pooled() const;
};

/// Steps whose ideal is below this fraction of its peak are not scored for magnitude and direction: a light touch.
inline constexpr double k_noticeable_fraction = 0.05;

/// Threshold of a vibration's peak displacement at a frequency, in m. Above k_most_sensitive_hz it rises as it fell.
double vibration_threshold(double frequency_hz);

/// A force signal in units of the vibration threshold: displacements F / (m (2 pi f)^2) of its frequencies from
/// k_vibration_from_hz to k_vibration_to_hz, each over its threshold, as the root of the sum of squares. A steady tone
/// whose amplitude is at its threshold scores 1. A Hann window suppresses the ends of an open path.
/// @param force_N,rate_hz a piece of the signal
double buzz(std::span<const double> force_N, double rate_hz);

/// @param gain g, from ideal to measured magnitudes: 1 to score a gain error itself; fit_gain() where the unit of the
///   response is unknown, so that the local error is scored
/// Empty where the ideal or the measured series is zero throughout. @throws BadArgument for series of different length
std::optional<PerceptualScores> perceptual_scores(Vectors ideal, Vectors measured, double gain, double rate_hz);

}  // namespace sixdof
