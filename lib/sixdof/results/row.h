#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/results/estimate.h>
#include <sixdof/results/outliers.h>
#include <sixdof/results/row_fields.h>

namespace sixdof::results {

/// Names of the mean times in Row::values, in ns; Google Benchmark calls them cpu_time and real_time, in a unit of each
/// row's own.
inline constexpr const char* k_processor_mean = "processor_mean_ns";
inline constexpr const char* k_wall_mean = "wall_mean_ns";

/// One row of a result file.
struct Row {
  std::string name;  ///< API, as Google Benchmark has it: "distance/algorithm:exact/pair:bunny/distance:05".
  RowFields fields = {};
  /// Numbers by the names of the table of metrics (measure/metrics.h), and the two means; without meaning where there
  /// is an error. Those of NAME's interval are NAME_low and NAME_high.
  std::map<std::string, double> values = {};
  std::string label = {};
  std::string error = {};  ///< Why the row could not be run; empty if it could.
  Outliers outliers = {};  ///< Of a row on a bucket.
  std::size_t file = 0;    ///< Index in Results::files.

  std::optional<double> value(const std::string& metric) const;
  double count(const std::string& metric) const { return value(metric).value_or(0.0); }
  /// A value with its interval; without spread where the row has no bounds. Takes Google Benchmark's names, too.
  std::optional<Estimate> estimate(const std::string& metric) const;
};

/// What executes the algorithm, where calls or the code itself cost more than those of a compiled program: "python",
/// "node", "wasm". Empty elsewhere.
std::string interpreter_of(const RowFields& fields);

/// Why a row is not compared with others of its pair, and stands in tables of its own: "convex_hull" where answers are
/// not about the meshes, what interprets the algorithm, or both: "convex_hull, wasm". Empty for most.
std::string class_of(const RowFields& fields);

/// What rows are compared on: "bunny", or "bunny (CLASS)" of a row that has a class.
std::string bodies_of(const RowFields& fields);

/// RowFields::query of rows that ask for first contacts.
inline constexpr const char* k_cast = "cast";

/// How B moves in a row of casts.
struct CastMotion {
  std::string kind;      ///< "translation", "rotation", "tumble".
  double percent = 0.0;  ///< By what part of A's diagonal.
};

/// Of RowFields::order, "tumble/10"; no kind where it has not this form.
CastMotion cast_motion_of(const RowFields& fields);

/// "distance 5 %"; of a cast its motion, "tumble 10 %"; the scenario of a row without a bucket.
std::string place_of(const RowFields& fields);

/// The row of an entry of "benchmarks". Numbers that the table of metrics does not know are left out; rows from before
/// there were cold caches are warm. @throws Error with what is wrong
Row parse_row(const nlohmann::ordered_json& entry);

/// The inverse, without outliers. @throws Error for a value that is not finite, or that the table of metrics lacks
nlohmann::ordered_json to_json_object(const Row& row);

}  // namespace sixdof::results
