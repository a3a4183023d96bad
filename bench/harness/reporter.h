#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <nlohmann/json.hpp>

#include "bench/harness/row_json.h"

namespace sixdof::bench {

/// (key, value) of a result file's "context".
using ContextKeys = std::vector<std::pair<std::string, std::string>>;

/// Hands rows on to another reporter:
/// - rows that are left out are not handed on;
/// - a row with a counter that is not finite becomes an error that names the counter;
/// - the coefficient of variation of zeros, which has no value, is left out of repetitions.
class RowReporter : public benchmark::BenchmarkReporter {
 public:
  /// @param next null for none; @param left_out names of rows. Both outlive this object.
  RowReporter(benchmark::BenchmarkReporter* next, const std::set<std::string>& left_out)
      : next_(next), left_out_(left_out) {}

  bool ReportContext(const Context& context) override { return next_ == nullptr || next_->ReportContext(context); }
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override {
    if (next_ != nullptr) next_->Finalize();
  }

  int failed() const { return failed_; }  ///< Rows that could not be run.

 private:
  benchmark::BenchmarkReporter* const next_;
  const std::set<std::string>& left_out_;
  int failed_ = 0;
};

/// Keeps rows as JSON in memory.
class JsonRows final : public benchmark::BenchmarkReporter {
 public:
  /// @param fields of every row; outlives this object
  explicit JsonRows(const FieldsByName& fields) : fields_(fields) {}
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) document["benchmarks"].push_back(row_json(run, fields_));
  }

  /// Google Benchmark's "context" and the rows so far.
  nlohmann::ordered_json document;

 private:
  const FieldsByName& fields_;
};

/// Collects rows in memory, so that a file appears whole or not at all.
class ResultCollector final : public RowReporter {
 public:
  /// @param fields of every row. Both arguments outlive this object.
  ResultCollector(const std::set<std::string>& left_out, const FieldsByName& fields)
      : RowReporter(&rows_, left_out), rows_(fields) {}

  /// The whole document, with the rows so far. Keys are added to "context".
  std::string document(const ContextKeys& context) const;

 private:
  JsonRows rows_;
};

}  // namespace sixdof::bench
