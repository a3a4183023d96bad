#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/report/collection.h>
#include <sixdof/report/outlier.h>

/// Results of this project's programs as a report takes them: rows of `sixdof-bench` and of studies, hard cases of
/// `sixdof stress`, scenes that `sixdof scene play` replayed. Whatever of a row a report does not know is kept by its
/// name, so that newer files can be read.

namespace sixdof::report {

/// Names of the mean times in Row::values, in ns.
inline constexpr const char* k_processor_mean = "processor_mean_ns";
inline constexpr const char* k_wall_mean = "wall_mean_ns";

/// One row of a result file. Texts are empty where the row has none.
struct Row {
  std::size_t file = 0;  ///< Index in Results::files.
  std::string name;      ///< As Google Benchmark has it.
  std::string query;     ///< "collide", "distance", "respond", or the family: "scenario", "precision", ...
  std::string algorithm, settings, pair, order, body, cache, scenario, question;
  std::string kind;                      ///< Of the bucket: "distance" or "volume".
  std::optional<double> percent;         ///< Of the bucket.
  std::string label, error;              ///< `error`: why the row could not be run.
  std::map<std::string, double> values;  ///< Numbers by the names of the table of metrics, and the two means.
  Outliers outliers;                     ///< Of a row on a bucket.

  std::optional<double> value(const std::string& key) const;
  double count(const std::string& key) const { return value(key).value_or(0.0); }
};

/// One cell of `sixdof stress`.
struct HardCase {
  std::size_t file = 0;
  std::string family, algorithm, verdict, metric, name, words, reproduction, unit, settings;
  double cases = 0.0, worst = 0.0;
};

/// What is known of a file beside its rows.
struct Source {
  std::string path;
  std::string kind;                                          ///< "rows", "stress" or "play".
  std::vector<std::pair<std::string, std::string>> context;  ///< In the file's order; numbers as text.

  /// Empty where the context has no such entry.
  std::string at(const std::string& key) const;
};

struct Results {
  std::vector<Source> files;
  std::vector<Row> rows;
  std::vector<HardCase> hard_cases;
  Collection collection;
};

/// Reads a file of `sixdof-bench`, of a study (`-o`), of `bench/collection` or `bench/growth`, of `sixdof stress` or of
/// `sixdof scene play --json`, and adds what it has.
/// @throws BadFile "FILE: PLACE: CAUSE" for a file that is empty, is no JSON, or is none of these
void read_results(const std::filesystem::path& path, Results& results);

/// The same of the file's text. @param path named in messages
void parse_results(const std::string& text, const std::string& path, Results& results);

/// A reason why the times of a row are not ranked.
struct Fault {
  std::string what;     ///< "failed", "wrong", "without a force", "not run".
  std::string counter;  ///< That counts it; empty where the row was not run.
  double count = 0.0;   ///< Of queries.
  double of = 0.0;
};

/// What is wrong with a row's answers; empty for a row to be ranked.
std::vector<Fault> faults_of(const Row& row);

/// Whether an algorithm failed a hard case: neither right, within its resolution, nor declared unsupported.
bool is_red(const HardCase& cell);

/// "3 of 64 wrong".
std::string to_string(const Fault& fault);

/// A command line that measures the row again, on as many configurations and with the file's seed.
std::string reproduction(const Row& row, const Source& source);

}  // namespace sixdof::report
