#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sixdof/results/fault.h>
#include <sixdof/results/results.h>

namespace sixdof::results {

/// The repetitions of one row of a file (--benchmark_repetitions); one without them.
struct RowGroup {
  std::vector<const Row*> repetitions;  ///< At least one.
  /// Medians over the repetitions that have the value; the mean times are those of mean_time().
  std::map<std::string, double> values;
  std::vector<Fault> faults;  ///< Of any repetition, by the rules of fault.h; empty for a row that is ranked.

  /// The first repetition that could be run, or the first.
  const Row& row() const;
  const RowFields& fields() const { return row().fields; }
  std::optional<double> value(const std::string& name) const;
  double count(const std::string& name) const { return value(name).value_or(0.0); }
  /// A value with the interval that the file has for it.
  std::optional<Estimate> estimate(const std::string& name) const;
  /// Mean processor time of a query in ns, on cold caches that by wall clock: of repetitions by mean_of_repetitions(),
  /// with the file's interval where it has one and there are no repetitions. Empty where the row has no such time.
  std::optional<Estimate> mean_time() const;
  /// The values of all repetitions that have it and are above zero.
  std::vector<double> all(const std::string& name) const;
  /// The algorithm with "(path order)", "(motion)", "(cold)" where the row is about these.
  std::string algorithm() const;
  /// Whether it is about one of these.
  bool is_special() const;
};

/// By file, then in the order of the rows. @param results outlives the groups
std::vector<RowGroup> row_groups(const Results& results);

}  // namespace sixdof::results
