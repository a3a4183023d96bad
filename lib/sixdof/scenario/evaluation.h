#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/scenario/scenario.h>

/// Recording a response along a scenario's path, comparing it with the ideal, and keeping both in a file.

namespace sixdof {

/// Steps follow one another at the rate of a haptic loop, so a recording of 1,000 steps is one second.
inline constexpr double k_haptic_rate_hz = 1000.0;
/// Steps of a recording of one second.
inline constexpr std::size_t k_default_steps = 1000;

/// An algorithm's answers along a scenario's path: one entry per step in every array. A step without an answer has a
/// status that says why, and zero wrench and penalty (a device would be sent zero).
struct Recording {
  std::vector<double> progress;          ///< As Scenario::steps() gives it.
  std::vector<Pose> poses;               ///< X_AB.
  std::vector<Status> status;            ///< Of the answer.
  std::vector<Eigen::Vector3d> forces;   ///< On B, in A's frame.
  std::vector<Eigen::Vector3d> torques;  ///< On B about the scenario's reference point, in A's frame.
  std::vector<double> penalties;         ///< A depth (length) or a volume (length^3), by the algorithm's law.
  std::vector<double> times_ns;          ///< Wall-clock time of each query alone, successful or not.
  /// Mean processor time per step, the recorder's own overhead included; of an isolated query that of another pass over
  /// the answered steps in its process.
  double processor_ns = 0.0;
  std::string first_failure;  ///< Diagnosis of the first step without an answer; empty if there is none.

  /// Number of steps.
  std::size_t size() const { return progress.size(); }
};

/// Asks `query` for its response at one progress, torque about the scenario's reference point. An exception becomes
/// Status::failed, a value that is not finite Status::non_finite; `diagnosis` receives the reason.
Outcome<Response> respond_at(const Scenario& scenario, Query& query, double progress, std::string& diagnosis);

/// Runs `query`, prepared for the scenario's a() and b(), over `count` steps (Scenario::steps) in order, after one
/// untimed query at the first step. Does not throw for a query that fails. @throws BadArgument for fewer than 2 steps
Recording record(const Scenario& scenario, Query& query, std::size_t count = k_default_steps);

/// Values by their name in the table of metrics (measure/metrics.h). Undefined ones are left out: the angle of a torque
/// that should be zero, loop work on an open path.
using Measures = std::vector<std::pair<std::string, double>>;

/// Frequency above which a residual counts as noise. The ideals of all scenarios change over tenths of the path, i.e.
/// below 10 Hz at one second for a path; a hand feels vibrations best between 50 and 500 Hz.
inline constexpr double k_noise_cutoff_hz = 50.0;

/// Steps searched for a lag on both sides: 10 ms, more than a haptic loop may be late.
inline constexpr std::size_t k_lag_reach = 10;

/// Every measure of a recording against one ideal law of its scenario. Names without suffix are taken over the steps in
/// the scenario's window; if there are steps outside of it, names with the suffix "_all" are over the whole path. Steps
/// without an answer are counted as `failed`, left out of magnitudes and directions, and zero in spectra and work.
/// @throws BadArgument if the scenario has no such ideal
Measures evaluate(const Scenario& scenario, const Recording& recording, IdealLaw law);

/// jump_F and jump_T: the largest jump that remains under refinement (measure/path.h), over the recording's peak. Each
/// only where the ideal is nonzero. Asks the query again, between the steps.
Measures evaluate_jumps(const Scenario& scenario, Query& query, const Recording& recording, IdealLaw law);

/// The ideal at every step of a recording.
struct Ideals {
  std::vector<Eigen::Vector3d> forces;   ///< On B, in A's frame.
  std::vector<Eigen::Vector3d> torques;  ///< On B about the scenario's reference point, in A's frame.
  std::vector<double> penalties;         ///< By the law, see IdealWrench.

  /// Asks the scenario at every step. @throws BadArgument if the scenario has no such ideal
  Ideals(const Scenario& scenario, const Recording& recording, IdealLaw law);
};

/// What a series was recorded with.
struct SeriesSource {
  std::string algorithm;     ///< Its name.
  std::string version;       ///< Of the algorithm.
  std::string settings;      ///< Settings::to_string of the algorithm.
  std::string shape;         ///< Settings::to_string of the scenario.
  std::string command = {};  ///< That records it again; empty if there is none.
};

/// Writes one recording with its ideal as an HDF5 file. The file appears complete or not at all.
///
/// Attributes of "/": format, format_version, scenario, law, algorithm, version, settings, shape, command, rate_hz,
/// reference_length, and every measure by its name. Datasets, float64, one row per step: /progress, /pose (w, x, y, z,
/// tx, ty, tz), /force, /torque, /penalty, /time_ns, /ideal_force, /ideal_torque, /ideal_penalty; /status int32 in the
/// order of Status. Time-frequency diagrams (rows: times in s, columns: frequencies in Hz) of the magnitudes of force
/// and torque, of their residuals after the least-squares gain (the signal itself where the ideal is zero), and of each
/// component: /spectrum/force_signal, force_residual, force_x_signal, ..., torque_signal, ..., times, frequencies.
/// Intensity is energy, in the unit of the signal squared. /spectrum is absent for fewer than k_spectrum_window steps.
/// @throws BadFile, BadArgument
void write_series(const std::filesystem::path& path, const Scenario& scenario, const Recording& recording, IdealLaw law,
                  const SeriesSource& source, const Measures& measures);

/// Length of a piece of the time-frequency diagram in steps: 64 ms at 1 kHz, so frequencies are 16 Hz apart.
inline constexpr std::size_t k_spectrum_window = 64;

}  // namespace sixdof
