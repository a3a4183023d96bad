#pragma once

#include <string_view>

#include <sixdof/oracle/advancement.h>
#include <sixdof/query/algorithm.h>

namespace sixdof {

/// What an answer to a cast is worth.
enum class ImpactVerdict {
  right,          ///< Within the tolerance, or no hit where there is none.
  early,          ///< Conservative: before the contact by more than the tolerance.
  late,           ///< A fault: after the contact by more than the tolerance, with the bodies inside each other.
  missed,         ///< A fault: no hit although there is one.
  phantom,        ///< A fault: a hit although there is none.
  false_contact,  ///< A fault: contact at the start, of bodies that are apart there. So is {hit, t = 0} for every
                  ///< motion.
  not_judged,     ///< The truth is grazing.
  failed          ///< There is no answer: Outcome::status says why.
};

/// The name as it stands in results: "false_contact".
constexpr std::string_view to_string(ImpactVerdict verdict) {
  constexpr std::string_view k_names[] = {"right",   "early",         "late",       "missed",
                                          "phantom", "false_contact", "not_judged", "failed"};
  return k_names[static_cast<std::size_t>(verdict)];
}

/// Whether the verdict is one of the faults above.
constexpr bool is_fault(ImpactVerdict verdict) {
  return verdict == ImpactVerdict::late || verdict == ImpactVerdict::missed || verdict == ImpactVerdict::phantom ||
         verdict == ImpactVerdict::false_contact;
}

/// By how much an answer may be off, as a length: a hit in time by this much less than it takes B to move so far. In
/// units of A's diagonal it is that of distances.
inline constexpr double k_impact_slack = 1e-9;

/// The same as a part of the motion: at least the width of a bracket.
/// @param diagonal of A's box (length)
double impact_tolerance(const Motion& motion, const Eigen::AlignedBox3d& box_b, double diagonal);

/// A judged answer.
struct JudgedImpact {
  ImpactVerdict verdict = ImpactVerdict::failed;
  double early = 0.0;          ///< Of an early answer: by how much of the motion.
  double late = 0.0;           ///< Of a late one.
  double normal_angle = -1.0;  ///< To the true normal (degrees); negative where either is not known.
};

/// @param truth of the motion
/// @param tolerance a part of the motion, impact_tolerance()
/// @param clearance_at_hit distance of the bodies at the answer's time (length); asked for where the truth has no hit:
/// an answer of bodies that are as close as `slack` then is right. Negative if not known
JudgedImpact judge_impact(const ImpactBracket& truth, const Outcome<Impact>& answer, double tolerance,
                          double clearance_at_hit = -1.0, double slack = 0.0);

}  // namespace sixdof
