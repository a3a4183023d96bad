#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include <sixdof/query/algorithm.h>
#include "bench/harness/timing.h"
#include "bench/harness/work.h"
#include <sixdof/configuration/bucket_sample.h>

/// Answers against the set's truth, outside every timed region and before it.

namespace sixdof::bench {

/// What came of asking each configuration once.
struct Check {
  std::size_t asked = 0;        ///< Configurations asked; fewer than given where the time ran out.
  std::size_t failed = 0;       ///< No answer, whatever the reason.
  std::size_t judged = 0;       ///< Answers that have a truth to be compared with.
  std::size_t mismatch = 0;     ///< Of those, wrong ones.
  double largest_error = 0.0;   ///< Largest |answer - truth|: distances in A's diagonals, volumes in the target.
  double sum_of_errors = 0.0;   ///< Sum of the same.
  double squared_errors = 0.0;  ///< Sum of the squares of the same.
  std::size_t misses = 0;       ///< Responses only: no force where the bodies overlap.
  std::string diagnosis;        ///< Of the first failure.
  MeanWork work;                ///< Over the answers.

  void add_error(double error) {
    largest_error = std::max(largest_error, error);
    sum_of_errors += error;
    squared_errors += error * error;
  }
  double mean_error() const { return judged == 0 ? 0.0 : sum_of_errors / static_cast<double>(judged); }
  double rms_error() const { return judged == 0 ? 0.0 : std::sqrt(squared_errors / static_cast<double>(judged)); }
};

/// A distance counts as wrong if it is off by more than the set's own tolerance plus this share of A's diagonal. It
/// covers what one exact algorithm computes differently from another (some 1e-13 in double precision for coordinates of
/// the size of the diagonal), and is still far below what any approximation is off by.
constexpr double k_distance_slack = 1e-9;

/// Judges one answer. Yes/no is not judged in bucket 0, where touching may be called either way.
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
  check.add_error(error / bucket.diagonal);
}

/// Responses are judged in overlap buckets: none may be without a force. An algorithm that says what volume it sees is
/// measured against the target, which is exact; how far off is reported and no mismatch, as approximations are honest.
/// Contact has no force.
inline void judge(const BucketSample& bucket, const Response& answer, Check& check) {
  if (bucket.key.kind != BucketKind::volume || bucket.key.percent == 0) return;
  if (answer.force.isZero(0.0)) ++check.misses;
  if (!std::isfinite(answer.volume)) return;
  ++check.judged;
  check.add_error(std::abs(answer.volume - bucket.target) / bucket.target);
}

/// Asks every configuration once, and judges. When `seconds` have passed it stops, at the end of a run of neighbours,
/// so that what was asked is a fair sample of what was given.
template <class Ask>
Check check_answers(const BucketSample& bucket, Ask ask, const Query& query, double seconds) {
  Check check;
  const auto start = Clock::now();
  for (const Pose& pose : bucket.poses) {
    const bool run_ends = check.asked > 0 && check.asked % BucketSample::k_run == 0;
    if (run_ends && std::chrono::duration<double>(Clock::now() - start).count() > seconds) break;
    const auto answer = ask(pose);
    ++check.asked;
    if (answer.ok()) {
      judge(bucket, answer.value, check);
      check.work.add(query.work());
    } else {
      ++check.failed;
      if (check.diagnosis.empty()) check.diagnosis = query.diagnosis();
    }
  }
  return check;
}

}  // namespace sixdof::bench
