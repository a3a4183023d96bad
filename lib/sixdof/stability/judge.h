#pragma once

#include <vector>

#include <sixdof/stability/answers.h>
#include <sixdof/stability/case.h>
#include <sixdof/stability/verdict.h>

/// Judges the answers of one algorithm. Lengths are compared with three bounds: the rounding of the input, then the
/// algorithm's declared resolution plus k_declared_accuracy; beyond them an answer is wrong. Yes/no is not scored where
/// the bodies are closer to contact than that.
namespace sixdof::stability {

/// What an algorithm says of itself, and what asking it about one body inside another shows.
struct Profile {
  QuerySet answers;
  ResponseLaw law = ResponseLaw::none;
  bool finds_contained = true;      ///< collide() is true for a body inside another, not only for surfaces that meet.
  bool pushes_contained = true;     ///< respond() has a penalty there.
  bool distance_of_bodies = false;  ///< distance() is 0 there, as of bodies, not that of the surfaces.
};

/// Asks about a small box inside a large one, in both orders.
Profile profile_of(const Traits& traits, const Prepare& prepare);

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
Judgement judge(const Case& member, const Profile& profile, const Prepare& prepare, const Limits& limits = {});

}  // namespace sixdof::stability
