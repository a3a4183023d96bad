#pragma once

#include <span>
#include <string>
#include <string_view>

#include <sixdof/scenario/scenario.h>

namespace sixdof {

/// One gate: a measure of an algorithm on a scenario may not be worse than this.
struct Bound {
  std::string_view scenario;
  std::string_view algorithm;
  IdealLaw law;
  std::string_view measure;  ///< As in lib/measure/metrics.h; absolute values are compared.
  double bound;              ///< 0 means exactly zero.
  std::string_view reason;   ///< What limits the value.
};

/// The one table. A value above the bound fails. A value below half the bound fails too and asks to tighten the table,
/// unless the bound is at most k_rounding_bound.
std::span<const Bound> bounds();

/// Bounds up to here say "nothing but rounding", and how far below it rounding stays is no merit.
inline constexpr double k_rounding_bound = 1e-6;

/// Stamps of every gate's recording: a multiple of four (Scenario::stamps), and 5 ms apart at one second for a path.
inline constexpr std::size_t k_gate_stamps = 200;

enum class Verdict {
  holds,
  worse,      ///< Above the bound.
  too_loose,  ///< Below half of the bound: the table is to be tightened.
};

Verdict judge(double value, double bound);

}  // namespace sixdof
