#pragma once

#include <span>

#include <sixdof/conformance/subject.h>

namespace sixdof::conformance {

/// One check of the kit.
struct Check {
  const char* name;
  /// Whether it applies to an algorithm that answers these kinds.
  bool (*applies)(const QuerySet&);
  /// Fails by GoogleTest's assertions.
  void (*run)(const Subject&);
};

inline bool always(const QuerySet&) { return true; }
inline bool if_collide(const QuerySet& set) { return set.collide; }
inline bool if_distance(const QuerySet& set) { return set.distance; }
inline bool if_respond(const QuerySet& set) { return set.respond; }

std::span<const Check> agreement_checks();   ///< With the oracles.
std::span<const Check> invariance_checks();  ///< What must not change the answers.
std::span<const Check> state_checks();       ///< Statuses, repetition, threads, lifetimes.

}  // namespace sixdof::conformance
