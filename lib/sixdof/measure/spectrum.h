#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <sixdof/measure/signal.h>

namespace sixdof {

/// One-sided energy spectrum of a real signal: |X_0|^2 / N, 2 |X_j|^2 / N, ... so that its sum is the signal's energy
/// sum x_k^2 (Parseval). Entry j stands for the frequency j * sample_rate / N; N/2 + 1 entries (rounded down).
std::vector<double> energy_spectrum(std::span<const double> signal);

/// Ratio of the integrals of the two energy spectra, of magnitudes normalised by their largest value.
/// Source: Weller et al. 2010, formula (3). By Parseval this is the ratio of the mean squares: it is dominated by the
/// mean and says little about noise; use residual_noise() for that. Empty where the ideal is zero throughout.
std::optional<double> nu(Vectors ideal, Vectors measured);

/// Noise: energy of the residual (measured minus gain times ideal, as vectors, with the least-squares gain) above
/// `cutoff`, over the energy of gain times ideal; a pure number. Both are seen through a Hann window so that a path
/// that does not close on itself makes no false high frequencies. If the gain is not positive (the response points the
/// wrong way) the measured series as a whole is the residual, over its own energy.
/// @param sample_rate,cutoff in Hz.
/// Empty where the ideal or the measured series is zero throughout.
/// @throws BadArgument if the cut-off is negative or not below half of the sample rate.
std::optional<double> residual_noise(Vectors ideal, Vectors measured, double sample_rate, double cutoff);

/// Time-frequency diagram: intensity[t * frequencies + f] is the energy of the Hann-windowed piece around times[t] (s)
/// at f * sample_rate / window (Hz).
struct Spectrogram {
  std::vector<double> times;        ///< Middle of each piece, seconds from the first sample.
  std::vector<double> frequencies;  ///< Hz; window / 2 + 1 entries.
  std::vector<double> intensity;    ///< Row by row, one row per time.
};

/// Short-time Fourier transform of a real signal.
/// @param window length of a piece in samples; @param hop samples between the starts of two pieces.
/// @throws BadArgument if window or hop is 0 or the signal is shorter than the window.
Spectrogram short_time_spectrum(std::span<const double> signal, double sample_rate, std::size_t window,
                                std::size_t hop);

}  // namespace sixdof
