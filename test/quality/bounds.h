#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/scenario/scenario.h>

namespace sixdof {

enum class Kind {
  gate,     ///< Not above the bound, and not below half of it (then the table is to be tightened).
  records,  ///< A known weakness, or a value that is neither good nor bad, such as a gain: a change in either direction
            ///< fails.
};

/// An algorithm with its default settings, or with some parameters changed.
struct Subject {
  std::string algorithm;
  std::vector<std::string> parameters;  ///< "name=value"
};

/// By the name in the table: that of an algorithm, or of a variant.
Subject subject(std::string_view name);

/// The bound of one measure of an algorithm on a scenario.
struct Bound {
  std::string_view scenario;
  std::string_view algorithm;  ///< See subject().
  IdealLaw law;
  std::string_view measure;  ///< As in lib/sixdof/measure/metrics.h; absolute values are compared.
  double bound;              ///< 0 means exactly zero.
  std::string_view reason;   ///< Why the value is not better.
  Kind kind = Kind::gate;
};

/// The one table, without algorithms that this build leaves out. A value above the bound fails. A value below half the
/// bound fails too, unless the bound is at most k_rounding_bound.
std::span<const Bound> bounds();

/// Up to here a bound means "rounding only", and a value far below it is not reported.
inline constexpr double k_rounding_bound = 1e-6;

/// Steps of every gate's recording: a multiple of four (Scenario::steps), 5 ms apart at one second for a path.
inline constexpr std::size_t k_gate_steps = 200;

/// Relative change of a recorded value that is accepted: the table has four digits.
inline constexpr double k_record_tolerance = 1e-3;

enum class Verdict {
  holds,
  worse,      ///< Above the bound.
  too_loose,  ///< Below half of the bound: the table is to be tightened.
  changed,    ///< Not the recorded value.
};

Verdict judge(double value, double bound, Kind kind = Kind::gate);

}  // namespace sixdof
