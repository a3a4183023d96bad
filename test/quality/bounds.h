#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/scenario/scenario.h>

namespace sixdof {

enum class Kind {
  gate,     ///< Not worse than the bound, and not better than half of it (that asks for the table to be tightened).
  records,  ///< A known weakness, as bad as the measure can tell: the value is recorded, and a change either way fails.
};

/// What is recorded: an algorithm with its default settings, or with some parameters changed.
struct Subject {
  std::string algorithm;
  std::vector<std::string> parameters;  ///< "name=value"
};

/// By the name in the table: that of an algorithm, or of a variant.
Subject subject(std::string_view name);

/// One gate: a measure of an algorithm on a scenario may not be worse than this.
struct Bound {
  std::string_view scenario;
  std::string_view algorithm;  ///< See subject().
  IdealLaw law;
  std::string_view measure;  ///< As in lib/measure/metrics.h; absolute values are compared.
  double bound;              ///< 0 means exactly zero.
  std::string_view reason;   ///< What limits the value.
  Kind kind = Kind::gate;
};

/// The one table. A value above the bound fails. A value below half the bound fails too, unless the bound is at most
/// k_rounding_bound.
std::span<const Bound> bounds();

/// Bounds up to here say "nothing but rounding", and how far below it rounding stays is no merit.
inline constexpr double k_rounding_bound = 1e-6;

/// Stamps of every gate's recording: a multiple of four (Scenario::stamps), and 5 ms apart at one second for a path.
inline constexpr std::size_t k_gate_stamps = 200;

/// Relative change of a recorded value that is none: the table gives four digits.
inline constexpr double k_record_tolerance = 1e-3;

enum class Verdict {
  holds,
  worse,      ///< Above the bound.
  too_loose,  ///< Below half of the bound: the table is to be tightened.
  changed,    ///< Not the recorded value.
};

Verdict judge(double value, double bound, Kind kind = Kind::gate);

}  // namespace sixdof
