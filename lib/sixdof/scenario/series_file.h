#pragma once

#include <filesystem>
#include <string>

#include <sixdof/scenario/evaluation.h>

namespace sixdof {

/// What a series was recorded with.
struct SeriesSource {
  std::string algorithm;
  std::string version;   ///< Of the algorithm.
  std::string settings;  ///< Settings::to_string of the algorithm.
  std::string shape;     ///< Settings::to_string of the scenario.
};

/// Writes one recording with its ideal as an HDF5 file. The file appears complete or not at all.
///
/// Attributes of "/": format, format_version, scenario, law, algorithm, version, settings, shape, rate_hz, and every
/// measure by its name. Datasets, float64, one row per step: /progress, /pose (w, x, y, z, tx, ty, tz), /force,
/// /torque, /penalty, /time_ns, /ideal_force, /ideal_torque, /ideal_penalty; /status int32 in the order of Status.
/// Time-frequency diagrams (rows: times in s, columns: frequencies in Hz) of the magnitudes of force and torque, and of
/// their residuals after the least-squares gain (the signal itself where the ideal is zero): /spectrum/force_signal,
/// force_residual, torque_signal, torque_residual, times, frequencies. Intensity is energy, in the unit of the
/// magnitude squared. /spectrum is absent for fewer than k_spectrum_window steps. @throws BadFile, BadArgument
void write_series(const std::filesystem::path& path, const Scenario& scenario, const Recording& recording, IdealLaw law,
                  const SeriesSource& source, const Measures& measures);

/// Length of a piece of the time-frequency diagram in steps: 64 ms at 1 kHz, so frequencies are 16 Hz apart.
inline constexpr std::size_t k_spectrum_window = 64;

}  // namespace sixdof
