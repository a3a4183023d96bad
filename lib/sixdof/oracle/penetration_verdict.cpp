#include <sixdof/oracle/penetration_verdict.h>

namespace sixdof {

JudgedDepth judge_depth(const PenetrationDepth& truth, double claimed, double slack) {
  if (!truth.closed) return {};
  if (claimed > truth.hi + slack) {
    return {.verdict = DepthVerdict::too_deep, .deep = truth.hi > 0.0 ? (claimed - truth.hi) / truth.hi : 1.0};
  }
  if (claimed < truth.lo - slack) {
    const bool missed = !(claimed > 0.0);
    return {.verdict = missed ? DepthVerdict::missed : DepthVerdict::too_shallow,
            .shallow = missed ? 1.0 : (truth.lo - claimed) / truth.lo};
  }
  return {.verdict = DepthVerdict::right};
}

}  // namespace sixdof
