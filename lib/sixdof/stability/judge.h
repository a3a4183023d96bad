#pragma once

#include <vector>

#include <sixdof/stability/answers.h>
#include <sixdof/stability/case.h>
#include <sixdof/stability/verdict.h>

/// Judges the answers of one algorithm. Lengths are compared with two bounds: the rounding of the input, then what the
/// algorithm's Traits declare, a resolution if it approximates, plus k_declared_accuracy; beyond them an answer is
/// wrong. Yes/no is not scored where the bodies are closer to contact than that. Other limits are excused only where
/// Traits::limits declares them.
namespace sixdof::stability {

/// Limits of a judgement.
struct Limits {
  double seconds = 20.0;  ///< Wall time of one query; more is Verdict::hung.
};

struct Judgement {
  std::vector<Finding> findings;  ///< Never empty.
  double slowest_seconds = 0.0;   ///< Processor time of the slowest query,
  std::size_t slowest_shot = 0;   ///< and its shot.
  double median_seconds = 0.0;    ///< Of the shots.

  const Finding& worst() const;
};

/// Deterministic but for times.
Judgement judge(const Case& member, const Traits& traits, const Prepare& prepare, const Limits& limits = {});

}  // namespace sixdof::stability
