#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <sixdof/measure/magnitude.h>

namespace sixdof {

/// Periodic Hann window.
std::vector<double> hann(std::size_t length);

/// One-sided energy spectrum of a real signal: |X_0|^2 / N, 2 |X_j|^2 / N, ... so that its sum is the signal's energy
/// sum x_k^2 (Parseval). Entry j belongs to the frequency j / N in units of the signal's rate; N/2 + 1 entries, rounded
/// down.
std::vector<double> energy_spectrum(std::span<const double> signal);

/// Ratio of the integrals of the two energy spectra, of magnitudes normalised by their largest value.
/// Source: Weller et al. 2010, formula (3). By Parseval this is the ratio of the mean squares, so the mean dominates
/// it; residual_noise() measures noise. Empty where the ideal is zero throughout.
std::optional<double> nu(Vectors ideal, Vectors measured);

/// The same of scalars, such as penalties, each over its largest absolute value.
std::optional<double> nu(std::span<const double> ideal, std::span<const double> measured);

/// Formula (3) of directions: energy of the unit vectors m/|m| up to the cut-off frequency over that of i/|i|; a pure
/// number, 1 if the measured direction is as smooth as the ideal one, smaller by the part that is noise. The integral
/// has to end at the cut-off: over all frequencies the energy of any unit vectors is their number (Parseval), and the
/// ratio is 1 whatever they are. A direction that is wrong but smooth has 1, too; gamma measures it. A vector up to
/// k_zero_fraction of its series' longest is zero and has no energy, so a miss lowers the ratio. A Hann window is on
/// both. Empty where the ideal is zero throughout, or zero but for the ends, where the window leaves less than 1e-6 of
/// it.
/// @param rate_hz steps per second
/// @throws BadArgument if the cut-off is negative or not below half of the rate, or lengths differ
std::optional<double> nu_direction(Vectors ideal, Vectors measured, double rate_hz, double cutoff_hz);

/// Noise: energy of the residual (measured minus gain times ideal, as vectors, with the least-squares gain) above the
/// cut-off, over the energy of gain times ideal; a pure number. A Hann window on both suppresses the high frequencies
/// of an open path's ends. If the gain is not positive (the response points the wrong way), the whole measured series
/// is the residual, over its own energy. Empty where the ideal or the measured series is zero throughout, or zero but
/// for the ends, where the window leaves less than 1e-6 of its energy.
/// @param rate_hz steps per second
/// @throws BadArgument if the cut-off is negative or not below half of the rate
std::optional<double> residual_noise(Vectors ideal, Vectors measured, double rate_hz, double cutoff_hz);

/// Time-frequency diagram: intensity[t * frequencies.size() + f] is the energy of the Hann-windowed piece around
/// times[t] at frequencies[f].
struct Spectrogram {
  std::vector<double> times;        ///< Middle of each piece, seconds from the first step.
  std::vector<double> frequencies;  ///< Hz; window / 2 + 1 entries.
  std::vector<double> intensity;    ///< Row by row, one row per time.
};

/// Short-time Fourier transform of a real signal.
/// @param window length of a piece in steps; @param hop steps between the starts of two pieces
/// @throws BadArgument if window or hop is 0 or the signal is shorter than the window
Spectrogram short_time_spectrum(std::span<const double> signal, double rate_hz, std::size_t window, std::size_t hop);

}  // namespace sixdof
