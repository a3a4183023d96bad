#pragma once

#include <vector>

#include <sixdof/stability/judge.h>

namespace sixdof::stability {

/// Relation::cast: the first contact of Case::cast must be at Case::contact_time. Later than rounding and
/// k_declared_accuracy explain, a miss, a phantom, or contact at the start of bodies that are apart is wrong; earlier
/// is conservative, and counts as within the resolution. Nothing is judged of an algorithm that answers no casts.
void judge_cast(const Case& member, const Traits& traits, const Prepare& prepare, const Limits& limits,
                std::vector<Finding>& findings);

}  // namespace sixdof::stability
