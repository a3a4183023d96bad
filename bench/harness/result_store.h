#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <sixdof/results/row_fields.h>
#include "bench/harness/options.h"
#include "bench/harness/result_journal.h"

namespace sixdof::bench {

/// The rows of a result file. While rows are measured, every finished one is a line of FILE.journal; FILE itself is
/// written in one piece at the end, and the journal removed. So a crash or a full disk loses no finished row, and a run
/// can be continued.
class ResultStore {
 public:
  using Json = nlohmann::ordered_json;

  /// Without a file, rows are kept in memory only.
  /// @param order names of rows as they stand in the file; rows of an earlier run that are not among them come last
  /// @param context of this run (run_context.h)
  ResultStore(std::vector<std::string> order, Json context);
  ~ResultStore();

  /// Begins to write a file. With `resume` it takes over the rows of FILE and of FILE.journal, if they exist; rows that
  /// failed are measured again. A CSV file has no context, so rows of its journal only are taken over.
  /// @throws BadFile if the file could not be written, the journal of another run is there, or an earlier result cannot
  ///   be read; BadArgument if rows of its run do not belong beside rows of this one
  void open(const std::filesystem::path& file, ResultFormat format, bool resume);

  /// Whether an earlier run measured the row.
  bool has(const std::string& row) const;

  /// What the rows say of which has() is true. @throws Error if they were not written by sixdof-bench
  std::vector<results::RowFields> fields() const;

  /// Adds to the row that is being measured: one run of it, or one aggregate of its repetitions.
  void add(const std::string& row, Json run);

  /// Ends the row that is being measured, if any. To be called before the next one begins.
  /// @param hashes of everything that rows have used so far
  /// @throws BadFile if the journal cannot be written; BadArgument if an earlier run used other meshes or sets
  void commit(const std::vector<std::pair<std::string, std::string>>& hashes);

  /// "context" and "benchmarks" of all rows that have ended. May be called from another thread, as may finish().
  Json document(bool interrupted) const;

  /// Writes the file, if there is one. @throws BadFile; the journal then stays
  void finish(bool interrupted);

 private:
  /// A row's runs and aggregates.
  using Runs = std::vector<Json>;

  void take_over_file();
  void take_over_journal();
  void take_over(const Json& context, const std::filesystem::path& from);
  void keep(const std::string& row, Runs runs);

  const std::vector<std::string> order_;
  std::filesystem::path file_;
  ResultFormat format_ = ResultFormat::json;
  std::unique_ptr<ResultJournal> journal_;
  bool journal_has_rows_ = false;
  std::string measuring_;  ///< Name of the row that is being measured.
  Runs measured_;          ///< What is known of it.

  mutable std::mutex mutex_;  ///< Of all below.
  Json context_;
  std::map<std::string, Runs> rows_;
  std::vector<std::string> names_;  ///< Of rows_, in the order in which they ended.
};

}  // namespace sixdof::bench
