#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sixdof/report/results.h>

namespace sixdof::report {

/// The repetitions of one row of a file (--benchmark_repetitions); one without them.
struct RowGroup {
  std::vector<const Row*> repetitions;  ///< At least one; the answers of all are the same.

  const Row& row() const { return *repetitions.front(); }
  /// The algorithm as a figure names it: with "(path order)", "(motion)", "(cold)" where the row is about these.
  std::string algorithm() const;
  /// Whether it is about one of these, so that it is compared with no other row.
  bool is_special() const;
  /// Median over the repetitions; empty where none has the value.
  std::optional<double> median(const std::string& name) const;
  /// The values of all repetitions that have it and are above zero.
  std::vector<double> all(const std::string& name) const;
};

/// By file, then in the order of the rows. @param results outlives the groups
std::vector<RowGroup> row_groups(const Results& results);

/// A value with its 95 % interval.
struct Estimate {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// Repetitions from which an interval is estimated; fewer say too little about their spread.
inline constexpr std::size_t k_fewest_repetitions = 3;

/// By how much the means of two runs of the same row differ on a machine that does other work: half of the interval of
/// a mean that was measured once. `sixdof precision` takes the same for its intervals.
inline constexpr double k_run_to_run = 0.10;

/// Mean processor time of a query in ns. The interval is Student's t of the logarithms of the repetitions; that of the
/// file where it has one; k_run_to_run to either side otherwise. Empty where the row has no such time.
std::optional<Estimate> processor_time(const RowGroup& group);

/// Groups whose times are ranked: without a fault, about the meshes, not `null`.
bool is_ranked(const RowGroup& group);

}  // namespace sixdof::report
