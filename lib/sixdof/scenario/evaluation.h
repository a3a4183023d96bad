#pragma once

#include <string>
#include <utility>
#include <vector>

#include <sixdof/scenario/recorder.h>

namespace sixdof {

/// Values by their name in the table of measures (metrics.h), in its order. What is undefined is left out: a torque's
/// angle where no torque should be, loop work on an open path.
using Measures = std::vector<std::pair<std::string, double>>;

/// Frequency above which a residual counts as noise. The ideals of all scenarios change within some tenths of the path,
/// i.e. below 10 Hz at one second for a path; a hand feels vibrations best between 50 and 500 Hz.
inline constexpr double k_noise_cutoff_hz = 50.0;

/// Stamps searched for a lag on both sides: 10 ms, more than any haptic loop may be late.
inline constexpr std::size_t k_lag_reach = 10;

/// Every measure of a recording against one ideal law of its scenario. Names without suffix are taken over the stamps
/// in the scenario's window; where there are stamps outside of it, those with the suffix "_all" over the whole path.
/// Stamps without an answer are counted as `failed`, left out of magnitudes and directions, and zero in the spectra and
/// the work. @throws BadArgument if the scenario has no such ideal.
Measures evaluate(const Scenario& scenario, const Recording& recording, IdealLaw law);

/// jump_F and jump_T: the largest jumps that stay under step refinement, over the recording's largest magnitude; asks
/// the query again between stamps. Only for what the ideal says acts.
Measures evaluate_jumps(const Scenario& scenario, Query& query, const Recording& recording, IdealLaw law);

/// What the ideal says at every stamp of a recording. @throws BadArgument if the scenario has no such ideal.
std::vector<IdealWrench> ideals_of(const Scenario& scenario, const Recording& recording, IdealLaw law);

}  // namespace sixdof
