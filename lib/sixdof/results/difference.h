#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/measure/metrics.h>
#include <sixdof/results/row_group.h>

/// Whether two files differ, but for times.

namespace sixdof::results {

/// Numbers that differ by no more than k_rounding plus this share of the larger are the same: other compilers and
/// instruction sets round differently.
inline constexpr double k_relative_rounding = 1e-9;

/// The values of a row's repetitions.
struct Range {
  double least = 0.0, largest = 0.0;
};

/// Whether two ranges are further apart than rounding and `relative`, a share of the larger.
bool differ(const Range& before, const Range& after, double relative = k_relative_rounding);

/// One value of a row that both files have.
struct Difference {
  std::string row, counter;  ///< Of a row that one side could not run, "error".
  MetricKind kind = MetricKind::answer;
  std::optional<Range> before, after;               ///< Empty where a side has no such value.
  std::string error_before = {}, error_after = {};  ///< Of "error"; empty where the row ran.
};

/// "0.2 -> 0.3", "0.2 to 0.3 -> none", or words of errors; with as many digits as tell the sides apart.
std::string to_string(const Difference& difference);

/// Whether the later side is worse, by the direction of its metric or by an error that the earlier side does not have.
/// A value that a side lacks counts as 0. Empty for a metric without a direction, and for a counter without a metric.
std::optional<bool> is_worse(const Difference& difference);

/// Of the context: what a result depends on besides the machine's load.
struct Changed {
  std::string key, before, after;
};

struct Differences {
  std::vector<Changed> versions;
  std::vector<std::string> only_before, only_after;  ///< Rows of one side, sorted.
  /// By row and counter, of rows that both have. Of a row that asked another number of configurations or steps only
  /// that number.
  std::vector<Difference> values;
  std::size_t common_rows = 0;

  std::size_t changed_answers() const;
};

/// @param groups those of `results`; @param before, after files
/// @param relative numbers that differ by no more than this share of the larger are the same
Differences differences(const Results& results, std::span<const RowGroup> groups, std::size_t before, std::size_t after,
                        double relative = k_relative_rounding);

}  // namespace sixdof::results
