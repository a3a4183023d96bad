#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <sixdof/query/registry.h>
#include <sixdof/results/row.h>
#include "bench/harness/cast_check.h"
#include "bench/study/sweep.h"

/// Which algorithm finds first contacts within a deadline: times and judged answers of all algorithms on the same
/// motions.

namespace sixdof::study {

/// Motions of a pair and their truths.
struct CastSample {
  std::vector<Motion> motions;
  std::vector<ImpactBracket> truths;

  std::size_t hits() const;  ///< Motions with a contact.
};

/// Translations, rotations and tumbles by 1 and 10 % of A's diagonal from the poses of contact of a set, one of each in
/// turn. @param count motions in all, fewer if the set has fewer poses
/// @throws BadArgument without poses of contact; BadMesh as ImpactTruth does
CastSample draw_cast_sample(bench::PairCache& cache, const CatalogueEntry& pair, std::size_t count, std::uint64_t seed);

/// "2100 judged motions: 1400 with a first contact, 700 without; ...".
std::string motions_text(const CastSample& sample);

struct CastPlan {
  std::vector<const Algorithm*> algorithms;  ///< Those that answer casts.
  std::vector<SweptValues> values;           ///< Instead of the algorithms' own sweeps.
  /// A setting of which half of the first motions take longer is left out.
  double deadline_ns = std::numeric_limits<double>::infinity();
  double budget_s = std::numeric_limits<double>::infinity();  ///< Wall time.
};

/// One algorithm with one setting.
struct CastPoint {
  const Algorithm* algorithm = nullptr;
  SweepPoint sweep;
  /// "precision/cast/algorithm:NAME/pair:PAIR/PARAMETER:VALUE" with the counters of rows of casts, `late`, `timed` and
  /// `idle_late` of single queries in one pass; an error if the setting was left out.
  results::Row row;
};

/// Errors that can be minimised.
std::vector<std::string> cast_error_metrics();

/// Asks every setting all motions: once to judge them and to time single queries, then in three passes for the mean.
/// @param progress (algorithm, done, total); @param finished is called after every setting with those that are done
/// @throws Interrupted
std::vector<CastPoint> measure_casts(const CastPlan& plan, bench::PairCache& cache, const CatalogueEntry& pair,
                                     const CastSample& sample,
                                     const std::function<void(const std::string&, std::size_t, std::size_t)>& progress,
                                     const std::function<void(const std::vector<CastPoint>&)>& finished);

}  // namespace sixdof::study
