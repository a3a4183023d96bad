#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/common/row_fields.h"

/// What `sixdof table` does: reads result files (table_read.cpp), puts their rows side by side and ranks them
/// (table_ranking.cpp), chooses columns (table_sheet.cpp, table_wide.cpp), and prints as text, Markdown
/// (table_format.cpp) or JSON (table_json.cpp).

namespace sixdof::cli {

/// Names of the means in ResultRow::values; all other values have the names of their counters.
inline constexpr const char* k_processor_mean = "processor_mean_ns";
inline constexpr const char* k_wall_mean = "wall_mean_ns";

/// One row of a result file: a query on a bucket.
struct ResultRow {
  RowFields fields;
  std::string error;                     ///< Why the row could not be run; empty if it could.
  std::map<std::string, double> values;  ///< Counters, and the two means in ns; empty with an error.

  std::optional<double> value(const std::string& name) const;
  std::uint64_t count(const std::string& name) const;  ///< 0 where the row has no such value.
};

struct ResultFile {
  std::string path;
  std::string date, commit;  ///< From the context; empty where it has none.
  bool interrupted = false;  ///< The run was broken off; rows may be missing.
  /// Those with a bucket, in the file's order. Of repetitions the one with the least mean time.
  std::vector<ResultRow> rows;
  std::map<std::string, std::size_t> not_shown;  ///< How many rows of other families, by family.
};

/// @throws BadFile with the place and the cause, for a file that is empty, no JSON, or has no rows of sixdof-bench
ResultFile read_result_file(const std::string& path);

/// The same of the file's text. @param path named in messages
ResultFile parse_result_file(const std::string& text, const std::string& path);

/// A reason why a row is not ranked.
struct Fault {
  std::string what;         ///< "failed", "wrong", ...: behind the counts, or alone where there are none.
  std::uint64_t count = 0;  ///< How many configurations,
  std::uint64_t of = 0;     ///< of how many; 0: without counts.
};

/// "3 of 640 failed".
std::string to_string(const Fault& fault);

/// A row in one of the files.
struct RankedRow {
  const ResultRow* row = nullptr;  ///< None: the file has no such row.
  std::vector<Fault> faults;
  bool fastest = false;         ///< Least mean processor time of the bucket, in this file, among rows without faults.
  std::optional<double> ratio;  ///< Mean processor time over that of the same row in the first file.
};

/// One algorithm on one bucket, in all files.
struct TableLine {
  BucketKey bucket;
  std::string algorithm, order;
  std::string cache;             ///< "warm" or "cold".
  std::vector<RankedRow> files;  ///< One for each file.

  std::string label() const {
    const std::string with_order = order == "random" || order.empty() ? algorithm : algorithm + " (" + order + ")";
    return cache == "warm" ? with_order : with_order + " (" + cache + ")";
  }
};

/// The lines of a pair, query and kind of bucket: by bucket, then in the order in which the files name the algorithms.
struct ResultTable {
  std::string pair, query;
  BucketKind kind;
  std::vector<TableLine> lines;
};

/// A row has a fault, and is not ranked, if
/// - it could not be run, or some of its configurations failed, were answered wrongly or, in an overlap, without a
///   force;
/// - all answers of its algorithm to the same query are at fault in another bucket of the pair: a constant "no" is
/// right
///   wherever bodies are apart;
/// - its algorithm is `null`, which measures the harness.
/// @param files outlive the result
std::vector<ResultTable> rank(const std::vector<ResultFile>& files);

/// What a table looks like: text in cells.
struct Sheet {
  struct Column {
    std::string group;  ///< Stands above neighbouring columns of the same group.
    std::string title;
    bool left = false;  ///< Aligned to the left.
  };
  std::string title;
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> lines;
  std::vector<std::string> notes;  ///< Below the lines: what was not ranked, and why.
};

/// @param files those of `table`; columns of several files stand side by side, with fewer of each
Sheet sheet_of(const ResultTable& table, const std::vector<ResultFile>& files);

/// One sheet per query over all pairs, a line per pair and algorithm, a column per bucket. Errors are over all buckets:
/// the mean of means, or the largest; faults are sums.
/// @param tables of one file
std::vector<Sheet> wide_sheets_of(const std::vector<ResultTable>& tables);

/// What stands once, above and below all tables.
std::vector<std::string> lines_above(const std::vector<ResultFile>& files);
std::vector<std::string> lines_below(const std::vector<ResultFile>& files);

std::string as_text(const Sheet& sheet);
std::string as_markdown(const Sheet& sheet);
std::string lines_as_text(const std::vector<std::string>& lines);
std::string lines_as_markdown(const std::vector<std::string>& lines);

/// `sixdof table --help` documents the keys.
nlohmann::ordered_json as_json(const std::vector<ResultTable>& tables, const std::vector<ResultFile>& files);

}  // namespace sixdof::cli
