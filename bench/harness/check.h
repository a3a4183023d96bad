#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/query/algorithm.h>
#include "bench/harness/guarded_query.h"
#include "bench/harness/work.h"

/// Compares answers with the set's truth, before anything is timed.

namespace sixdof::bench {

/// Differences between answers and truth, none negative.
class Errors {
 public:
  /// Larger errors, e.g. of an answer of 1e308, count as this one, whose square and sums of it do not overflow.
  static constexpr double k_largest = 1e150;

  void add(double error) {
    error = std::min(error, k_largest);
    ++count_;
    largest_ = std::max(largest_, error);
    sum_ += error;
    squares_ += error * error;
  }
  double largest() const { return largest_; }
  double mean() const { return count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_); }
  double rms() const { return count_ == 0 ? 0.0 : std::sqrt(squares_ / static_cast<double>(count_)); }

 private:
  std::size_t count_ = 0;
  double largest_ = 0.0;
  double sum_ = 0.0;
  double squares_ = 0.0;
};

/// The answers to the first configurations of a sample, each asked once.
struct Check {
  std::vector<bool> answered;  ///< For each configuration asked, whether it got an answer.
  std::size_t judged = 0;      ///< Answers that are compared with a truth.
  std::size_t mismatch = 0;    ///< Wrong ones among them.
  Errors errors;               ///< |answer - truth|: distances in A's diagonals, volumes in the bucket's volume.
  std::size_t misses = 0;      ///< Responses without a force although the bodies overlap.
  MeanWork work;               ///< Over the answers.
  /// Configurations of the first wrong answer, the first miss and the largest error; empty without.
  std::optional<Pose> first_mismatch = {}, first_miss = {}, largest_error = {};
};

/// A distance is wrong if it differs by more than the set's own tolerance plus this fraction of A's diagonal. Two exact
/// algorithms in double precision differ by some 1e-13 for coordinates of the size of the diagonal; approximations
/// differ by far more than this.
constexpr double k_distance_slack = 1e-9;

/// Yes/no is not judged in bucket 0, where both answers to touching bodies are right.
inline void judge(const BucketSample& bucket, bool answer, Check& check) {
  if (bucket.key.percent == 0) return;
  ++check.judged;
  if (answer != (bucket.key.kind == BucketKind::volume)) ++check.mismatch;
}

/// Configurations of an overlap bucket have distance 0.
inline void judge(const BucketSample& bucket, const Separation& answer, Check& check) {
  const bool apart = bucket.key.kind == BucketKind::distance;
  const double error = std::abs(answer.distance - (apart ? bucket.target : 0.0));
  ++check.judged;
  if (!(error <= (apart ? bucket.tolerance : 0.0) + k_distance_slack * bucket.diagonal)) ++check.mismatch;
  check.errors.add(error / bucket.diagonal);
}

/// Responses are judged in overlap buckets, where each has a force; touching bodies (0 %) have none. A response's
/// volume is compared with the bucket's; how far off it is counts as no mismatch, since many algorithms approximate it.
inline void judge(const BucketSample& bucket, const Response& answer, Check& check) {
  if (bucket.key.kind != BucketKind::volume || bucket.key.percent == 0) return;
  if (answer.force.isZero(0.0)) ++check.misses;
  if (!std::isfinite(answer.volume)) return;
  ++check.judged;
  check.errors.add(std::abs(answer.volume - bucket.target) / bucket.target);
}

/// Asks the first `count` configurations once, however long it takes: rows that are compared ask the same ones.
/// @param has_truth whether the answers are about the meshes, as the set's truth is
template <class Ask>
Check check_answers(const BucketSample& bucket, std::size_t count, GuardedQuery<Ask>& query, bool has_truth = true) {
  Check check;
  for (const Pose& pose : std::span(bucket.poses).first(count)) {
    const auto answer = query.ask(pose);
    check.answered.push_back(answer.ok());
    if (!answer.ok()) continue;
    if (has_truth) {
      const std::size_t mismatch = check.mismatch, misses = check.misses;
      const double largest = check.errors.largest();
      judge(bucket, answer.value, check);
      if (check.mismatch > mismatch && !check.first_mismatch) check.first_mismatch = pose;
      if (check.misses > misses && !check.first_miss) check.first_miss = pose;
      if (check.errors.largest() > largest) check.largest_error = pose;
    }
    check.work.add(query.query().work());
  }
  return check;
}

}  // namespace sixdof::bench
