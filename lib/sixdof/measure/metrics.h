#pragma once

#include <span>
#include <string_view>

namespace sixdof {

/// Which values of a metric are better.
enum class Better {
  lower,       ///< The nearer to zero the better.
  higher,      ///< The larger the better.
  nearer_one,  ///< A ratio that should be 1.
  neither,     ///< Describes the row, does not rate it.
};

/// The word as it stands in tables: "nearer 1".
std::string_view to_string(Better better);

/// Whether `value` is strictly better than `other`; false for Better::neither.
bool is_better(Better better, double value, double other);

/// One column of the results: a counter of a row of `sixdof-bench`, a measure of `sixdof quality`, or a time that
/// Google Benchmark itself adds to every row.
struct Metric {
  /// As in the results. A '*' stands for a unit of work: "*_tested" is points_tested and so on.
  std::string_view name;
  std::string_view unit;     ///< "1" for pure numbers.
  Better better;             ///< Which values are better.
  std::string_view meaning;  ///< One sentence.
  std::string_view source;   ///< Where the formula is from, or the file that computes it.
};

/// The one table of metrics, read by rows, command line, tests and documentation.
std::span<const Metric> metrics();

/// The metric of a counter, or nullptr if the table has none. Suffixes are part of a counter's name but not of the
/// table: "_low" and "_high" (bounds of its 95 % interval), "_all" (over the whole path of a scenario instead of its
/// window) and "_by_LAW" (against the ideal of that law instead of the algorithm's own), e.g.
/// "sigma_T_all_by_wall_traction".
const Metric* find_metric(std::string_view counter);

/// What a counter is about.
enum class MetricKind {
  time,    ///< Differs between any two runs: times, and what depends on times, as the frontier does.
  work,    ///< What a query looks at, and the size of structures: changes with how an answer is found.
  answer,  ///< Everything else: errors, failures, counts of configurations.
};

/// MetricKind::answer for a counter that the table does not have.
MetricKind kind_of(std::string_view counter);

}  // namespace sixdof
