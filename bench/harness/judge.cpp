#include "bench/harness/judge.h"

namespace sixdof::bench {
namespace {

double limited(double error) { return std::clamp(error, -k_largest_error, k_largest_error); }

}  // namespace

Judgement judge(const KnownAnswer& known, bool answer) {
  if (known.key.percent == 0) return {};
  return {.judged = true, .wrong = answer != (known.key.kind == BucketKind::volume)};
}

Judgement judge(const KnownAnswer& known, const Separation& answer) {
  const bool apart = known.key.kind == BucketKind::distance;
  const double error = answer.distance - (apart ? known.target : 0.0);
  const double allowed = (apart ? known.tolerance : 0.0) + k_distance_slack * known.diagonal;
  // Not `> allowed`: NaN is wrong.
  return {.judged = true, .wrong = !(std::abs(error) <= allowed), .error = limited(error / known.diagonal)};
}

Judgement judge(const KnownAnswer& known, const Response& answer) {
  if (known.key.kind == BucketKind::distance) {
    Judgement judgement{.judged = known.key.percent > 0};
    if (answer.force.isZero(0.0) && answer.torque.isZero(0.0)) return judgement;
    judgement.phantom_force = std::min(answer.force.stableNorm(), k_largest_error);
    judgement.wrong = judgement.judged && known.target - known.tolerance > known.resolution;
    return judgement;
  }
  if (known.key.percent == 0) return {};
  Judgement judgement{.missed = answer.force.isZero(0.0)};
  if (!std::isfinite(answer.volume)) return judgement;
  judgement.judged = true;
  judgement.error = limited((answer.volume - known.target) / known.target);
  return judgement;
}

}  // namespace sixdof::bench
