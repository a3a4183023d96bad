#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/results/collection.h>
#include <sixdof/results/growth.h>
#include <sixdof/results/row.h>

/// Files of results of this project's programs: rows of `sixdof-bench` and of studies, hard cases of `sixdof stress`,
/// scenes that `sixdof scene play` replayed. Commands, pages and scripts read them here.

namespace sixdof::results {

/// One cell of `sixdof stress`.
struct HardCase {
  std::size_t file = 0;
  std::string family, algorithm, verdict, metric, words, reproduction, unit, settings;
  std::string name;  ///< Of the worst case.
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
  Collection collection;  ///< The summaries that files have beside their rows.
  std::vector<GrowthSeries> growth;
};

/// Reads a file of `sixdof-bench`, of a study (`-o`), of `bench/scripts/collection` or `growth`, of `sixdof stress` or
/// of `sixdof scene play --json`, and adds what it has.
/// @throws BadFile "FILE: PLACE: CAUSE" for a file that is empty, is no JSON, or is none of these
void read_results(const std::filesystem::path& path, Results& results);

/// The same of the file's text. @param path named in messages
void parse_results(const std::string& text, const std::string& path, Results& results);

/// Every file with rows directly in a folder, in the order of their dates. Other JSON files are left out.
/// @throws BadFile if the folder cannot be read or has no such file
Results read_folder(const std::filesystem::path& folder);

/// A result file: Google Benchmark's JSON, so that its compare.py reads it. @param context what is known of the run
/// @throws what to_json_object(Row) throws
nlohmann::ordered_json document_of(const nlohmann::ordered_json& context, std::span<const Row> rows);

/// Writes such a file, whole or not at all. @throws BadFile, Error
void write_rows(const std::filesystem::path& file, const nlohmann::ordered_json& context, std::span<const Row> rows);

/// Whether an algorithm failed a hard case: neither right, within its resolution, nor declared unsupported.
bool is_red(const HardCase& cell);

/// A command line that measures the row again, on as many configurations and with the file's seed; empty if the file
/// does not say how it was made.
std::string reproduction(const Row& row, const Source& source);

/// A part of a row's name as an expression for --benchmark_filter that matches just this text (a dot matches any).
std::string name_expression(const std::string& text);

}  // namespace sixdof::results
