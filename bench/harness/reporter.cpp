#include "bench/harness/reporter.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

#include <fmt/format.h>

#include "bench/harness/benchmark_versions.h"
#include "bench/harness/timing.h"

namespace sixdof::bench {
namespace {

using Run = benchmark::BenchmarkReporter::Run;

bool is_finite(const std::pair<const std::string, benchmark::Counter>& counter) {
  return std::isfinite(counter.second.value);
}

/// Takes the processor time that a row measured in another process out of its counters.
void take_processor_time(Run& run) {
  const auto counter = run.counters.find(k_processor_inside);
  if (counter == run.counters.end()) return;
  const double value = counter->second.value;
  run.counters.erase(counter);
  // A coefficient of variation has no unit; everything else is divided by the iterations when it is printed.
  const bool is_ratio = run.aggregate_unit == benchmark::kPercentage;
  run.cpu_accumulated_time =
      is_ratio ? value : 1e-9 * value * static_cast<double>(std::max(run.iterations, std::int64_t{1}));
}

}  // namespace

void RowReporter::ReportRuns(const std::vector<Run>& runs) {
  std::vector<Run> kept;
  for (Run run : runs) {
    if (left_out_.contains(run.run_name.function_name)) continue;
    if (run.run_name.time_type.ends_with("manual_time")) run.cpu_accumulated_time = run.real_accumulated_time;
    take_processor_time(run);
    run.run_name.time_type.clear();
    run.run_name.iterations.clear();
    if (run.aggregate_name == "cv") {
      if (!std::isfinite(run.real_accumulated_time) || !std::isfinite(run.cpu_accumulated_time)) continue;
      std::erase_if(run.counters, std::not_fn(is_finite));
    } else if (!has_error(run)) {
      const auto bad = std::ranges::find_if_not(run.counters, is_finite);
      if (bad != run.counters.end()) {
        set_error(run, fmt::format("counter {} is not finite ({})", bad->first, bad->second.value));
        run.counters.clear();
      }
    }
    failed_ += has_error(run) ? 1 : 0;
    kept.push_back(std::move(run));
  }
  if (next_ != nullptr && !kept.empty()) next_->ReportRuns(kept);
}

void ResultCollector::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) store_.add(run.run_name.function_name, row_json(run, fields_, outliers_));
}

Console::Console() : console_(benchmark::CreateDefaultDisplayReporter()) { console_->SetErrorStream(&context_); }

bool Console::ReportContext(const Context& context) {
  const bool run = console_->ReportContext(context);
  std::istringstream lines(context_.str());
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("***WARNING*** Library was built as DEBUG")) std::cerr << line << "\n";
  }
  return run;
}

}  // namespace sixdof::bench
