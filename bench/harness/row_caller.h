#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <set>
#include <string>

#include <benchmark/benchmark.h>

#include "bench/common/progress_line.h"
#include "bench/harness/row.h"
#include "bench/harness/sample_plan.h"

namespace sixdof::bench {

/// Calls rows: divides the time among them, shows progress, and turns exceptions into errors of the row.
class RowCaller {
 public:
  /// @param rows how many will be called; @param budget_s wall time for all of them, 0 for no limit
  /// @param plan of their samples, which outlives this object
  /// @param before_row called before each; what it throws ends the run
  RowCaller(std::size_t rows, double budget_s, SamplePlan& plan, std::function<void()> before_row)
      : rows_(rows), budget_s_(budget_s), plan_(plan), before_row_(std::move(before_row)) {}

  /// Google Benchmark calls a row several times in succession. @throws Interrupted
  void call(const PlannedRow& row, benchmark::State& state);

  std::set<std::string> left_out;   ///< Names of the rows that are left out because they need solids.
  std::set<std::string> not_solid;  ///< "MESH: REASON" of the meshes because of which rows are left out.

  /// Rows that were called and not left out.
  std::size_t measured() const { return begun_.size() - left_out.size(); }

 private:
  double row_budget_s() const;

  const std::size_t rows_;
  const double budget_s_;
  SamplePlan& plan_;
  const std::function<void()> before_row_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  ProgressLine progress_{"rows"};
  std::set<std::string> begun_;
};

}  // namespace sixdof::bench
