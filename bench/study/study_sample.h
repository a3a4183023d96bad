#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/query/algorithm.h>
#include "bench/harness/judge.h"
#include "bench/harness/pair_cache.h"
#include "bench/harness/query_kind.h"

namespace sixdof::study {

/// How far bodies are from contact.
enum class Nearness {
  apart,       ///< 1 % of A's diagonal or more.
  near,        ///< Less than 1 % apart, or pushed into each other by less.
  overlapping  ///< Deeper.
};
inline constexpr double k_near = 0.01;  ///< Of A's diagonal.

/// What an answer is compared with.
struct Reference {
  bench::KnownAnswer known;
  Nearness nearness = Nearness::apart;
  Response exact;  ///< The response of `exact`; only for QueryKind::respond.
};

/// Poses that are timed, in this order.
struct TimedPoses {
  std::vector<Pose> poses;
  std::size_t period = 1;  ///< Poses of one motion; 1 for single configurations.
  std::size_t lead = 0;    ///< So many at the beginning of a motion are asked, but their times do not count.

  bool counts(std::size_t i) const { return i % period >= lead; }
  /// The first motions, or configurations.
  TimedPoses first(std::size_t count) const;
};

/// Configurations of several buckets, the same ones for every point of a study: one of each bucket in turn, each bucket
/// in the order of its sample, so that every prefix is spread evenly over buckets, rotations and directions.
struct StudySample {
  bench::QueryKind question = bench::QueryKind::respond;
  std::vector<BucketKey> buckets;
  std::vector<Pose> poses;
  std::vector<Reference> references;  ///< Of the first poses; answers to the others are timed only.
  TimedPoses motions;                 ///< Timed instead of `poses`, if there are any.

  std::size_t asked() const { return poses.size() + motions.poses.size(); }  ///< Poses of both kinds.
};

/// @param buckets of the set; those that do not suit the question are left out
/// @param count configurations in all, as many as there are if 0
/// @throws BadArgument if no bucket suits the question, NeedsSolid, BadFile
StudySample draw_sample(bench::PairCache& cache, const CatalogueEntry& pair, bench::QueryKind question,
                        const std::vector<BucketKey>& buckets, std::size_t count);

/// Motions (harness/motion.h) from the first of the sample's poses on: as many times count as there are
/// configurations. The first queries of a motion do not count: B has jumped there, which no body in motion does.
TimedPoses draw_motions(const StudySample& sample, const Mesh& a, const Mesh& b, std::uint64_t seed);

}  // namespace sixdof::study
