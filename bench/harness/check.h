#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include <sixdof/algorithm/algorithm.h>
#include <sixdof/bench/harness/timing.h>
#include <sixdof/fixtures/bucket.h>

/// Answers against the set's truth, outside every timed region and before it.

namespace sixdof::bench {

/// What came of asking each configuration once.
struct Check {
  std::size_t asked = 0;        ///< Configurations asked; fewer than given where the time ran out.
  std::size_t failed = 0;       ///< No answer, whatever the reason.
  std::size_t judged = 0;       ///< Answers that have a truth to be compared with.
  std::size_t mismatch = 0;     ///< Of those, wrong ones.
  double largest_error = 0.0;   ///< Distances only: largest |answer - truth|, in A's diagonals.
  double squared_errors = 0.0;  ///< Distances only: sum of the squares of the same.
  std::string diagnosis;        ///< Of the first failure.

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
  const double error = std::abs(answer.distance - (apart ? bucket.aim : 0.0));
  ++check.judged;
  if (!(error <= (apart ? bucket.tolerance : 0.0) + k_distance_slack * bucket.diagonal)) ++check.mismatch;
  check.largest_error = std::max(check.largest_error, error / bucket.diagonal);
  check.squared_errors += (error / bucket.diagonal) * (error / bucket.diagonal);
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
    } else {
      ++check.failed;
      if (check.diagnosis.empty()) check.diagnosis = query.diagnosis();
    }
  }
  return check;
}

}  // namespace sixdof::bench
