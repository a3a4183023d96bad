#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/generation_job.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/query/algorithm.h>
#include "bench/harness/query_kind.h"

/// Every configuration of a set, asked once: the paper's mean and longest time of a bucket are over all of its
/// 1,991,808 or 268,128 configurations, where rows of sixdof-bench ask a sample. A set is divided into shards, which
/// may be asked anywhere and in any order; sums over shards are those over the set.

namespace sixdof::study {

/// A query on the configurations of one bucket that a shard has. Everything but poses and maxima adds up over shards.
struct SurveyCell {
  bench::QueryKind question = bench::QueryKind::respond;
  BucketKey key;
  std::uint64_t configurations = 0;  ///< Of the grid.
  std::uint64_t reachable = 0;       ///< Of these; the others have no pose and are not asked.
  std::uint64_t asked = 0;           ///< Less than reachable only where a sample was.
  std::uint64_t failed = 0;          ///< Without an answer, and so without a time.
  std::uint64_t judged = 0, wrong = 0, missed = 0, phantoms = 0;  ///< bench/harness/judge.h.
  double sum_ns = 0.0;                                            ///< Wall time of single queries.
  double max_ns = 0.0;                                            ///< Of the longest.
  double max_least_ns = 0.0;  ///< Of the longest, where each that seemed to be it was asked twice more.
  double error_sum = 0.0, error_squares = 0.0, error_max = 0.0;  ///< Judgement::error.
  double force_sum = 0.0;                                        ///< |F| of bodies that overlap.
  double phantom_sum = 0.0, phantom_max = 0.0;                   ///< |F| of bodies that are apart.
  double seconds = 0.0;                                          ///< Wall time of all, judging included.
  std::map<std::string, std::string> poses =
      {};  ///< Worst ones by counters of rows, as `sixdof query --pose` has them.

  std::uint64_t answered() const { return asked - failed; }
};

/// What a shard is asked.
struct SurveyOptions {
  ShardNumber shard;        ///< Has the rotations r with r mod count = number - 1, and all directions.
  std::size_t sample = 0;   ///< At most so many configurations of each bucket; 0: all.
  std::uint64_t seed = 1;   ///< Of the order in which they are asked.
  double resolution = 0.0;  ///< KnownAnswer::resolution.
};

/// Asks the reachable configurations of a shard's part of a bucket once each, in a random order.
/// @throws BadArgument, BadFile as ConfigurationSet does; Interrupted
SurveyCell survey_bucket(const ConfigurationSet& set, BucketKey key, bench::QueryKind question, const Mesh& a,
                         const Mesh& b, Query& query, const SurveyOptions& options);

/// Adds another shard's part of the same query on the same bucket.
void add_to(SurveyCell& sum, const SurveyCell& part);

}  // namespace sixdof::study
