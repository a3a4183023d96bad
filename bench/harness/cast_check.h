#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/configuration/set_catalogue.h>
#include <sixdof/generation/motions.h>
#include <sixdof/oracle/impact_verdict.h>
#include <sixdof/query/ask.h>
#include "bench/harness/pair_cache.h"

namespace sixdof::bench {

/// The bucket whose poses motions start from.
inline constexpr BucketKey k_contact{BucketKind::distance, 0};

/// Whether the pair's set has poses of contact.
bool has_contacts(const CatalogueEntry& pair);

/// The motions of a kind and step (generation/motions.h) from the first poses of contact of a set.
/// @param most motions @throws what PairCache::bucket() throws
std::vector<Motion> motions_from_contacts(PairCache& cache, const CatalogueEntry& pair, MotionKind kind, double percent,
                                          std::size_t most, std::uint64_t seed);

/// Asks once; an exception becomes a failure. @param words of an answer that is none
Outcome<Impact> ask_cast(Query& query, const Motion& motion, std::string& words);

/// Judges answers to motions of one pair by their truths.
class CastJudge {
 public:
  /// Both meshes outlive it.
  CastJudge(const Mesh& a, const Mesh& b) : a_(a), b_(b) {}

  /// @throws BadMesh as DistanceOracle does, where a hit has to be measured that should not be
  JudgedImpact judge(const Motion& motion, const ImpactBracket& truth, const Outcome<Impact>& answer);

 private:
  double distance_at(const Motion& motion, double t);

  const Mesh& a_;
  const Mesh& b_;
  std::optional<DistanceOracle> oracle_;  ///< Made when first needed.
  std::optional<DistanceQuery> query_;
};

/// Verdicts of many answers.
struct CastCounts {
  std::array<std::size_t, 8> of = {};  ///< By ImpactVerdict.
  std::array<std::size_t, std::size(k_counted_statuses)> statuses = {};
  std::size_t asked = 0;
  std::size_t hits = 0;  ///< Motions with a contact.
  double early_max = 0.0, late_max = 0.0;
  double normal_max = -1.0;  ///< Degrees; negative where no right hit has a normal.
  std::string first_failure;

  std::size_t count(ImpactVerdict verdict) const { return of[static_cast<std::size_t>(verdict)]; }
  /// Late, missed, phantom, or in contact at the start though apart.
  std::size_t faults() const;
  std::size_t judged() const { return asked - count(ImpactVerdict::failed) - count(ImpactVerdict::not_judged); }

  void add(const ImpactBracket& truth, const Outcome<Impact>& answer, const JudgedImpact& judged,
           const std::string& words);
  /// The counts of another row, such as those of another kind of motion.
  void add(const CastCounts& other);
  /// By names of the table of metrics (measure/metrics.h).
  std::map<std::string, double> values() const;
};

}  // namespace sixdof::bench
