#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <sixdof/scenario/scenario.h>

namespace sixdof {

/// What a bound claims.
enum class Kind {
  characterised,  ///< What the code reaches today, in two digits; no theory gives the number, `reason` only says what
                  ///< limits it. Fails where the value is k_margin times as bad (largest_defect()). A sigma or gamma
                  ///< fails where it is much better, too (smallest_defect()): then the table no longer says what the
                  ///< code reaches, and a worse one could pass.
  required,       ///< A limit with a reason: rounding, zero, a value of the paper. Fails above it.
  scale,     ///< A gain, of which no value is better; a change of a method's stiffness is news to its users all the
             ///< same. Fails outside a factor of k_scale_margin on both sides.
  weakness,  ///< Known to be as bad as can be, so that no bound could fail. Nothing is held.
};

std::string_view to_string(Kind kind);

inline constexpr double k_margin = 2.0;
/// How much better than its bound a characterised sigma or gamma may be. Compilers and processors change the last
/// digits only; a better method changes the table as well.
inline constexpr double k_better_margin = 4.0;
inline constexpr double k_scale_margin = 1.5;

/// An algorithm with its default settings along a path, or with some parameters changed.
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
  std::string_view measure;  ///< As in lib/sixdof/measure/metrics.h.
  double bound;              ///< Of the absolute value; of nu and gain of max(x, 1/x) - 1; of Kind::scale the gain.
  std::string_view reason;   ///< Why the value is not better.
  Kind kind = Kind::characterised;
};

/// Bounds of a subject that share reason and kind: a line of the table.
struct BoundLine {
  std::string_view scenario, algorithm;
  IdealLaw law;
  std::string_view reason;
  Kind kind;
  std::vector<std::pair<std::string_view, double>> measures;
};

/// The one table, without algorithms that this build leaves out.
std::span<const Bound> bounds();

/// The worst value that a measure can have; infinity if there is no limit.
double worst_value(std::string_view measure);

/// From where on a value fails, as Bound::bound is measured: k_margin times a characterised one, but no farther than
/// half-way to the worst value.
double largest_defect(const Bound& bound);

/// Below which a value fails: a k_better_margin-th of a characterised sigma or gamma, otherwise 0.
double smallest_defect(const Bound& bound);

bool holds(const Bound& bound, double value);

/// Steps of every gate's recording: a multiple of four (Scenario::steps), 5 ms apart at one second for a path.
inline constexpr std::size_t k_gate_steps = 200;

}  // namespace sixdof
