#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/harness/result_store.h"
#include "bench/harness/row_json.h"

namespace sixdof::bench {

/// Hands rows on to another reporter:
/// - rows that are left out are not handed on;
/// - names are those of PlannedRow, without what Google Benchmark adds to rows of one round. The processor time of
/// these rows is
///   the wall time that the row has set, since their loop spends most of its processor time outside of queries;
/// - the processor time of an isolated algorithm is what its process measured (k_processor_inside);
/// - a row with a counter that is not finite becomes an error that names the counter;
/// - of repetitions that are all zero the coefficient of variation is left out, since it is undefined.
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

/// Hands rows on to a store.
class ResultCollector final : public benchmark::BenchmarkReporter {
 public:
  /// @param fields of every row. All outlive this object.
  ResultCollector(ResultStore& store, const FieldsByName& fields, const OutliersByName& outliers)
      : store_(store), fields_(fields), outliers_(outliers) {}
  bool ReportContext(const Context& /*context*/) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override;

 private:
  ResultStore& store_;
  const FieldsByName& fields_;
  const OutliersByName& outliers_;
};

/// Google Benchmark's console, without its warning that Debian's build of that library has assertions: nothing of it
/// runs in a timed loop.
class Console final : public benchmark::BenchmarkReporter {
 public:
  Console();
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override { console_->ReportRuns(runs); }
  void Finalize() override { console_->Finalize(); }

 private:
  std::ostringstream context_;
  std::unique_ptr<benchmark::BenchmarkReporter> console_;
};

}  // namespace sixdof::bench
