#include <sixdof/oracle/impact_verdict.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sixdof {
namespace {

/// Degrees from the line of the closest points just before contact to the answer's normal; negative if unknown.
double normal_angle(const ImpactBracket& truth, const Impact& answer) {
  const Eigen::Vector3d line = truth.closest.witness_b - truth.closest.witness_a;
  if (!truth.closest.has_witnesses || !(line.norm() > 0.0) || answer.normal.isZero(0.0)) return -1.0;
  return 180.0 / std::numbers::pi * std::atan2(line.cross(answer.normal).norm(), line.dot(answer.normal));
}

}  // namespace

double impact_tolerance(const Motion& motion, const Eigen::AlignedBox3d& box_b, double diagonal) {
  const double speed = speed_bound(motion, box_b), width = bracket_width(motion, box_b);
  return speed > 0.0 ? std::max(width, std::min(1.0, k_impact_slack * diagonal / speed)) : width;
}

JudgedImpact judge_impact(const ImpactBracket& truth, const Outcome<Impact>& answer, double tolerance,
                          double clearance_at_hit, double slack) {
  using Kind = ImpactBracket::Kind;
  if (!answer.ok()) return {ImpactVerdict::failed};
  if (truth.kind == Kind::grazing) return {ImpactVerdict::not_judged};
  const Impact& impact = answer.value;
  if (truth.kind == Kind::none) {
    if (!impact.hit) return {ImpactVerdict::right};
    if (clearance_at_hit >= 0.0 && clearance_at_hit <= slack) return {ImpactVerdict::right};
    return {impact.at_start() ? ImpactVerdict::false_contact : ImpactVerdict::phantom};
  }
  if (!impact.hit) return {ImpactVerdict::missed};
  if (truth.kind == Kind::at_start) {
    if (impact.t <= tolerance) return {ImpactVerdict::right};
    return {.verdict = ImpactVerdict::late, .late = impact.t};
  }
  JudgedImpact judged{.verdict = ImpactVerdict::right, .normal_angle = normal_angle(truth, impact)};
  if (impact.at_start() && truth.t_free > tolerance) {
    judged.verdict = ImpactVerdict::false_contact;
    judged.early = truth.t_free;
  } else if (impact.t > truth.t_touch + tolerance) {
    judged.verdict = ImpactVerdict::late;
    judged.late = impact.t - truth.t_touch;
  } else if (impact.t < truth.t_free - tolerance) {
    judged.verdict = ImpactVerdict::early;
    judged.early = truth.t_free - impact.t;
  }
  return judged;
}

}  // namespace sixdof
