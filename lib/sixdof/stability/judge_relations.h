#pragma once

#include <vector>

#include <sixdof/stability/judge.h>

/// What ties the answers to the shots of one case together; `answers` are in the order of the shots.
namespace sixdof::stability {

/// Relation::same: what distance, volume and direction of force become under scaling, motion and exchange.
void judge_same(const Case& member, const std::vector<Answers>& answers, const Traits& traits,
                std::vector<Finding>& findings);

/// Relation::path: slopes of distance and volume.
void judge_path(const Case& member, const std::vector<Answers>& answers, std::vector<Finding>& findings);

/// Relation::loop: work of the force over peak force times length of the path. An algorithm whose law is a volume and
/// that declares no resolution has a potential, so the work must be zero. For others a larger
/// work counts as within their resolution.
void judge_loop(const Case& member, const std::vector<Answers>& answers, const Traits& traits,
                std::vector<Finding>& findings);

/// Relation::repeat: a second object must give the same bits; another order, or another thread, the same answers to
/// rounding.
void judge_repeat(const Case& member, const std::vector<Answers>& answers, const Traits& traits, const Prepare& prepare,
                  std::vector<Finding>& findings);

/// Relation::sweep: conservative advancement by the algorithm's distances must end where the bodies touch. Without
/// distances: yes just after that time.
void judge_sweep(const Case& member, const Traits& traits, const Prepare& prepare, const Limits& limits,
                 std::vector<Finding>& findings);

/// Relation::bad, of the shots whose pose is none: an answer to one that is not finite is wrong; no answer may be a
/// NaN.
void judge_bad(const Case& member, const std::vector<Answers>& answers, std::vector<Finding>& findings);

}  // namespace sixdof::stability
