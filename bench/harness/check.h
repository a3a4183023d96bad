#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <sixdof/configuration/bucket_sample.h>
#include "bench/harness/guarded_query.h"
#include "bench/harness/hull_truth.h"
#include "bench/harness/judge.h"
#include "bench/harness/work.h"

/// Compares answers with the truth, before anything is timed.

namespace sixdof::bench {

/// A count of a prepared structure's footprint; none if it has no such count.
inline std::optional<double> footprint_count(const Query& query, std::string_view wanted) {
  const Footprint footprint = query.footprint();
  for (const auto& [name, count] : footprint.counts) {
    if (name == wanted) return count;
  }
  return std::nullopt;
}

/// KnownAnswer::resolution; 0 of an algorithm that takes the bodies as they are.
inline double resolution_of(const Algorithm& algorithm, const Query& query) {
  return algorithm.traits().approximates ? footprint_count(query, "resolution").value_or(0.0) : 0.0;
}

/// The answers to the first configurations of a sample, each asked once.
struct Check : JudgedAnswers {
  std::vector<bool> answered;  ///< For each configuration asked, whether it got an answer.
  MeanWork work;               ///< Over the answers.
  /// Configurations of the first wrong answer, the first miss and the largest error; empty without.
  std::optional<Pose> first_wrong = {}, first_missed = {}, largest_error = {};
  std::optional<Pose> largest_phantom = {};  ///< Of the largest force of bodies that are apart.
};

/// Asks the first `count` configurations once, however long it takes: rows that are compared ask the same ones.
/// @param resolution KnownAnswer::resolution
/// @param hulls the truth of answers about convex hulls; null for answers about the meshes, as the set's truth is
template <class Ask>
Check check_answers(const BucketSample& bucket, std::size_t count, GuardedQuery<Ask>& query, HullTruth* hulls = nullptr,
                    double resolution = 0.0) {
  KnownAnswer of_set = KnownAnswer::of(bucket);
  of_set.resolution = resolution;
  Check check;
  for (const Pose& pose : std::span(bucket.poses).first(count)) {
    const auto answer = query.ask(pose);
    check.answered.push_back(answer.ok());
    if (!answer.ok()) continue;
    const Judgement judgement = judge(hulls == nullptr ? of_set : hulls->at(bucket, pose), answer.value);
    const double largest = check.errors.largest(), phantom = check.phantom_forces.largest();
    check.add(judgement);
    if (judgement.wrong && !check.first_wrong) check.first_wrong = pose;
    if (judgement.missed && !check.first_missed) check.first_missed = pose;
    if (check.errors.largest() > largest) check.largest_error = pose;
    if (check.phantom_forces.largest() > phantom) check.largest_phantom = pose;
    check.work.add(query.query().work());
  }
  return check;
}

}  // namespace sixdof::bench
