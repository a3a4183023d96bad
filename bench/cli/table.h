#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/results/rivals.h>
#include <sixdof/results/row_group.h>

/// What `sixdof table` does: puts the rows of result files side by side (table_lines.cpp), chooses columns
/// (table_sheet.cpp, table_wide.cpp, table_overview.cpp), and prints as text, Markdown (table_format.cpp) or JSON
/// (table_json.cpp).

namespace sixdof::cli {

/// The files of a table and their rows.
struct TableInput {
  results::Results content;
  std::vector<results::RowGroup> groups;  ///< Of `content`.

  /// @param rows_only refuses files that are no result of sixdof-bench or a study
  /// @throws BadFile with the place and the cause
  explicit TableInput(const std::vector<std::string>& files, bool rows_only = true);
  TableInput(const TableInput&) = delete;  // the groups refer to the content
  std::size_t files() const { return content.files.size(); }
};

/// A row in one of the files.
struct RankedRow {
  const results::RowGroup* group = nullptr;  ///< None: the file has no such row.
  bool fastest = false;                      ///< Wins its contest (results/contest.h).
  std::optional<double> ratio;               ///< Mean processor time over that of the same row in the first file.

  bool has_fault() const { return group != nullptr && !group->faults.empty(); }
  /// "!": has faults; "~": approximate; "*": fastest; else empty.
  const char* mark() const {
    if (has_fault()) return std::ranges::all_of(group->faults, &results::Fault::is_approximation) ? "~" : "!";
    return fastest ? "*" : "";
  }
  /// Whether no time was measured.
  bool is_error() const { return group != nullptr && group->values.empty(); }
};

/// One algorithm on one bucket, in all files.
struct TableLine {
  BucketKey bucket;
  std::string algorithm, order;
  std::string cache;             ///< "warm" or "cold".
  bool is_cast = false;          ///< Then `order` says how B moves: "tumble/10".
  std::vector<RankedRow> files;  ///< One for each file.

  /// How B moves, of casts: "tumble 10 %"; else the bucket, "05 %".
  std::string place() const;
  /// The algorithm, with the order of poses and the state of the caches where they are not the usual ones.
  std::string label() const {
    if (is_cast) return algorithm;
    const std::string with_order = order == "random" || order.empty() ? algorithm : algorithm + " (" + order + ")";
    return cache == "warm" ? with_order : with_order + " (" + cache + ")";
  }
};

/// The lines of a pair, query and kind of bucket: by bucket, then in the order in which the files name the algorithms.
struct ResultTable {
  std::string pair;  ///< results::bodies_of() its rows.
  std::string query;
  BucketKind kind;
  std::string apart;  ///< results::class_of() its rows.
  std::vector<TableLine> lines;

  bool is_of_casts() const { return query == results::k_cast; }
  std::string place_title() const { return is_of_casts() ? "motion" : to_string(kind); }
};

/// The tables of all rows on buckets. @param input outlives the result
std::vector<ResultTable> tables_of(const TableInput& input);

/// How many rows of other families a file has, by family.
std::map<std::string, std::size_t> other_rows(const TableInput& input, std::size_t file);

/// The settings of the rows of one file, by algorithm.
std::map<std::string, std::string> settings_of(const TableInput& input, std::size_t file);

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

/// @param input that of `table`; columns of several files stand side by side, with fewer of each
Sheet sheet_of(const ResultTable& table, const TableInput& input);

/// One sheet per query and class over all pairs, a line per pair and algorithm, a column per bucket. Errors are over
/// all buckets: the mean of means, or the largest; faults are sums.
/// @param tables of one file
std::vector<Sheet> wide_sheets_of(const std::vector<ResultTable>& tables);

/// One sheet per pair, a line per algorithm: times over all buckets, the error of the force, and what is wrong. Rows of
/// random poses on warm caches only. @param tables of one file
std::vector<Sheet> overview_sheets_of(const std::vector<ResultTable>& tables);
std::vector<std::string> lines_below_overview();

/// A line per scenario row: its resolution, time and measures beside those that the paper prints
/// (results/paper_scenarios.h).
Sheet paper_sheet_of(const TableInput& input);

/// What sheet_against() compares.
struct Against {
  std::string algorithm = "exact";
  std::vector<std::string> others;  ///< Names, in which * stands for any part.
  results::RivalTime time = results::RivalTime::mean;
  std::optional<double> slower;  ///< Only where the algorithm takes more than so many times as long, the worst first.
};

/// A line per query, bodies and bucket (or target, or scene): the algorithm's time, that of the fastest of the others,
/// their ratio and how far it spreads over the files, e.g. of several seeds (results/rivals.h). Rows with a fault stand
/// below and count for nothing.
/// @throws BadArgument if there is nothing to compare
Sheet sheet_against(const TableInput& input, const Against& asked);

/// What stands once, above and below all tables.
std::vector<std::string> lines_above(const TableInput& input);
std::vector<std::string> lines_below(const TableInput& input);

std::string as_text(const Sheet& sheet);
std::string as_markdown(const Sheet& sheet);
std::string lines_as_text(const std::vector<std::string>& lines);
std::string lines_as_markdown(const std::vector<std::string>& lines);

/// `sixdof table --help` documents the keys.
nlohmann::ordered_json as_json(const std::vector<ResultTable>& tables, const TableInput& input);

}  // namespace sixdof::cli
