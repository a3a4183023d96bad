#pragma once

#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

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

/// Collects Google Benchmark's JSON in memory, so that a file appears whole or not at all.
class ResultCollector final : public RowReporter {
 public:
  explicit ResultCollector(const std::set<std::string>& left_out) : RowReporter(&json_, left_out) {
    json_.SetOutputStream(&text_);
  }

  /// The whole document after Finalize(), or after a run that was broken off. Keys are added to "context".
  /// @throws Error if the text is not valid JSON
  std::string document(const ContextKeys& context) const;

 private:
  benchmark::JSONReporter json_;
  std::ostringstream text_;
};

}  // namespace sixdof::bench
