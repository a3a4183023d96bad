#pragma once

#include <string>
#include <utility>
#include <vector>

#include <sixdof/scenario/recorder.h>

namespace sixdof {

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
  std::vector<Eigen::Vector3d> forces, torques;
  std::vector<double> penalties;

  /// @throws BadArgument if the scenario has no such ideal
  Ideals(const Scenario& scenario, const Recording& recording, IdealLaw law);
};

}  // namespace sixdof
