#pragma once

#include <cstddef>
#include <string_view>

#include <sixdof/oracle/penetration.h>

namespace sixdof {

/// What a claimed depth is worth.
enum class DepthVerdict {
  right,        ///< Within [lo, hi] and the slack.
  too_shallow,  ///< Below lo: whoever moves B by it, in whatever direction, leaves the bodies overlapping. Unsafe.
  too_deep,     ///< Above hi: B is moved farther than it has to be.
  missed,       ///< No depth although the bodies overlap: too shallow as well.
  not_judged    ///< The interval is open.
};

/// The name as it stands in results: "too_shallow".
constexpr std::string_view to_string(DepthVerdict verdict) {
  constexpr std::string_view k_names[] = {"right", "too_shallow", "too_deep", "missed", "not_judged"};
  return k_names[static_cast<std::size_t>(verdict)];
}

/// A claimed depth beside the interval.
struct JudgedDepth {
  DepthVerdict verdict = DepthVerdict::not_judged;
  double shallow = 0.0;  ///< (lo - claimed) / lo of one that is too shallow or missed.
  double deep = 0.0;     ///< (claimed - hi) / hi of one that is too deep.
};

/// Depths that differ from the interval by no more than this part of A's diagonal are right: many libraries compute in
/// single precision, with margins of some 1e-6 of the bodies.
inline constexpr double k_depth_slack = 1e-6;

/// @param claimed the depth of an algorithm (length); 0 or less: none. Finite
/// @param slack a length
JudgedDepth judge_depth(const PenetrationDepth& truth, double claimed, double slack);

}  // namespace sixdof
