#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/query/algorithm.h>
#include <sixdof/scenario/evaluation.h>
#include <sixdof/scenario/scenario.h>

#include "bench/study/equivalent.h"

/// Equivalent resolutions of an algorithm in a response scenario.

namespace sixdof::study {

/// eta = sigma w_sigma + gamma w_gamma.
struct EtaWeights {
  double sigma = 1.0;
  double gamma = 1.0;  ///< Per radian.
};

/// What is measured at every resolution, and how.
struct ScenarioStudy {
  const Scenario& scenario;
  const Algorithm& algorithm;
  Settings settings;  ///< Of the parameters that are not searched.
  IdealLaw law = IdealLaw::depth;
  EtaWeights weights;
  std::size_t steps = k_default_steps;
};

/// "F" (force) or "T" (torque): whose sigma and gamma make eta. The ideal force of III is zero.
std::string_view rated_wrench(std::string_view scenario);

/// Values of the grid by the name of a swept parameter, in place of three of its sweep.
using Grids = std::map<std::string, std::vector<double>>;

/// How far the search may go beyond the values of the grid: a factor on both sides, within the parameter's limits.
/// Twice as fine takes up to eight times the memory and time to prepare (voxels).
inline constexpr double k_default_reach = 2.0;

/// The two swept parameters of an algorithm as axes: the first, a middle and the last value of the sweep, or `grids`.
/// @throws BadArgument if the algorithm has not exactly two swept numeric parameters, or a value is not allowed
std::array<ResolutionAxis, 2> resolution_axes(const Traits& traits, const Grids& grids, double reach);

/// `settings` with both parameters of the axes set. Text and number have the same value.
Settings with_resolution(const Settings& settings, const std::array<ResolutionAxis, 2>& axes, const Resolution& at);

/// Prepares the algorithm at one resolution and records the scenario: once for sigma and gamma in the scenario's
/// window, then k_timing_passes times for the time, the least of the passes' mean processor times (other work on the
/// machine only adds time). Counters are the misses, and sigma, gamma and nu in every reading of the paper's table
/// (results/paper_table.h).
/// @throws what Algorithm::prepare() does; Error if a step has no answer
Measurement measure_scenario(const ScenarioStudy& study, const std::array<ResolutionAxis, 2>& axes,
                             const Resolution& at);

inline constexpr std::size_t k_timing_passes = 5;

}  // namespace sixdof::study
