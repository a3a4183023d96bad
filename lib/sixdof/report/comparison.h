#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <sixdof/report/data_table.h>
#include <sixdof/results/results.h>
#include <sixdof/results/row_group.h>

namespace sixdof::report {

using namespace results;

/// What changed from one file to another, over the rows that both have (by name).
struct Comparison {
  std::string before, after;  ///< Names of the runs.
  /// "answers": errors, failures and counts that differ in rows that asked the same number of configurations.
  DataTable answers;
  /// "changes": ratio of processor times with its interval, and "slower", "faster" or "no change shown".
  DataTable changes;
  std::vector<std::string> sentences;
};

/// Probability that any row of a comparison is called slower or faster although nothing changed.
inline constexpr double k_false_alarm = 0.05;

/// Least standard deviation of the logarithm of a ratio of two means that were each measured once (k_run_to_run).
inline constexpr double k_least_spread = 0.05;

/// Factor on the spread of all rows. The noisiest rows have twice the noise of the quietest (5 to 10 %); with this
/// factor one comparison in twenty of equal programs has a false alarm (comparison_test.cpp).
inline constexpr double k_uneven = 1.2;

/// A change is shown where the interval of the ratio does not contain 1. Its width comes from the repetitions where
/// both files have k_fewest_repetitions, and from how much more the rows differ between the files than their
/// repetitions do; otherwise from the spread of the ratios of all rows about their median, which two runs of the same
/// program have too. Intervals are wide enough for all rows of the file together (Sidak).
Comparison compare(const Results& results, const std::vector<RowGroup>& groups, std::size_t before, std::size_t after);

/// Every later file with rows against the first, where they have rows in common.
std::vector<Comparison> comparisons(const Results& results, const std::vector<RowGroup>& groups);

}  // namespace sixdof::report
