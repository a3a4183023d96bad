#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sixdof/base/run_options.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/motion.h>
#include <sixdof/oracle/advancement.h>
#include <sixdof/query/algorithm.h>

namespace sixdof {

/// How verify_impacts() looks at each motion.
struct ImpactVerification {
  std::size_t samples = 32;  ///< Random times at which the bodies must be apart.
  std::uint64_t seed = 1;    ///< Of these.
};

/// Answer of verify_impacts(). Problems are counted by motion.
struct ImpactsVerdict {
  std::size_t motions = 0;            ///< That were checked, and below how many of each kind of truth.
  std::size_t hits = 0;               ///< ImpactBracket::Kind::hit
  std::size_t misses = 0;             ///< Kind::none
  std::size_t at_start = 0;           ///< Kind::at_start
  std::size_t grazing = 0;            ///< Kind::grazing; checked up to t_free.
  double widest = 0.0;                ///< Largest t_touch - t_free of the hits, a part of the motion.
  std::size_t wide = 0;               ///< Brackets wider than bracket_width().
  std::size_t changed = 0;            ///< Truths that have other bits when they are computed again.
  std::size_t earlier = 0;            ///< The bodies touch before t_free.
  std::size_t apart = 0;              ///< They do not touch at t_touch, or at the start.
  std::vector<std::string> problems;  ///< In words, the first of each kind.

  /// Whether no truth has a problem.
  bool ok() const { return problems.empty(); }
};

/// Checks true first contacts. Each is computed again and compared bit by bit, and measured by another algorithm's
/// distances: at random times and just before t_free the bodies must be apart, at t_touch they must be within
/// k_impact_slack of A's diagonal. Before t_free means by impact_tolerance(), so that a rounding decides nothing.
/// @param truths of the motions, such as stored_impacts()
/// @param oracle answers distances, and is best another one than `exact`
/// @param run a step is one motion; one thread is used
/// @throws BadArgument if the oracle answers no distances, Error if it gives none; Interrupted
ImpactsVerdict verify_impacts(const Mesh& a, const Mesh& b, std::span<const Motion> motions,
                              std::span<const ImpactBracket> truths, const Algorithm& oracle,
                              const ImpactVerification& options = {}, const RunOptions& run = {});

}  // namespace sixdof
