#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <sixdof/query/algorithm.h>
#include <sixdof/results/estimate.h>
#include "bench/study/study_sample.h"

namespace sixdof::study {

using results::Estimate;

/// The errors of an algorithm's answers to the judged configurations of a sample, by names of the table of metrics.
///
/// collide, distance: judged_apart, judged_near, judged_overlapping and wrong_... (Nearness); respond:
/// judged_overlapping. collide: mismatch, false_positives, false_negatives; touching (configurations of bucket 0, where
/// both answers are
///   right, so they are in none of the others) and touching_yes.
/// distance: error_mean (signed), error_rms, error_max, in A's diagonals; too_small and too_large count answers beyond
///   the tolerance: a distance that is too small is conservative, one that is too large is not.
/// respond: for force and torque about the centre of B's box, angles to the exact vector (gamma_F_deg, gamma_F_p95_deg,
///   gamma_max_F_deg), gain_F and magnitude_error_F (measure/magnitude.h), and penalty_error likewise for the penalty
///   against the exact volume; volume_error_mean where there is a volume; misses: responses without a force.
/// All: configurations (that were judged) and failed, which includes those that are not judged; crashed, timed_out and
///   out_of_memory of the failed, where there are any.
struct AnswerErrors {
  /// Intervals are bootstraps over the configurations (Efron 1979): 2.5 % and 97.5 % of k_resamples resamples. Counts
  /// have no spread.
  std::map<std::string, Estimate> values;
  std::vector<Pose> answered;  ///< Those of the sample's poses that have an answer, judged or not.
  /// Of QueryKind::respond: forces by the configurations that are judged; zero where there is no answer.
  std::vector<Eigen::Vector3d> forces;
  std::size_t failed = 0;
  std::string first_failure;  ///< Words of it.

  /// Counts poses without an answer that are no configurations of the sample.
  void add_failures(std::size_t count, const std::string& first);
};

/// The names of the values, those of which the table of metrics knows what is better.
std::vector<std::string> error_metrics(bench::QueryKind question);

inline constexpr std::size_t k_resamples = 200;

/// Asks every configuration of the sample once. The same answers and seed give the same bits.
AnswerErrors measure_errors(Query& query, const StudySample& sample, std::uint64_t seed);

}  // namespace sixdof::study
