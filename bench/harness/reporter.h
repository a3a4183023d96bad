#pragma once

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

namespace sixdof::bench {

/// Collects Google Benchmark's JSON in memory, so that the file appears whole or not at all, and mends what the library
/// leaves: numbers that JSON does not know (NaN as the coefficient of variation of zero) are left out, and rows that
/// failed are counted. What was reported when a run is broken off is complete.
class ResultCollector final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

  int rows() const { return rows_; }      ///< Rows (without aggregates) that ran.
  int failed() const { return failed_; }  ///< Rows that could not be run.

  /// The whole document. Keys are added to "context".
  /// @throws Error if the text is no JSON after all
  std::string document(const std::vector<std::pair<std::string, std::string>>& context) const;

 private:
  benchmark::JSONReporter json_;
  std::ostringstream text_;
  bool started_ = false;
  int rows_ = 0;
  int failed_ = 0;
};

}  // namespace sixdof::bench
