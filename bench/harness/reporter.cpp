#include "bench/harness/reporter.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof::bench {
namespace {

using Run = benchmark::BenchmarkReporter::Run;

bool has_value(const Run& run) {
  return std::isfinite(run.real_accumulated_time) && std::isfinite(run.cpu_accumulated_time);
}

bool is_finite(const std::pair<const std::string, benchmark::Counter>& counter) {
  return std::isfinite(counter.second.value);
}

void refuse_non_finite_counters(Run& run) {
  for (const auto& counter : run.counters) {
    if (is_finite(counter)) continue;
    run.error_occurred = true;
    run.error_message = fmt::format("counter {} is not finite ({})", counter.first, counter.second.value);
    run.counters.clear();
    return;
  }
}

}  // namespace

bool RowReporter::ReportContext(const Context& context) { return next_ == nullptr || next_->ReportContext(context); }

void RowReporter::ReportRuns(const std::vector<Run>& runs) {
  std::vector<Run> kept;
  for (Run run : runs) {
    if (left_out_.contains(run.run_name.function_name)) continue;
    if (run.aggregate_name == "cv") {
      if (!has_value(run)) continue;
      std::erase_if(run.counters, [](const auto& counter) { return !is_finite(counter); });
    } else if (!run.error_occurred) {
      refuse_non_finite_counters(run);
    }
    failed_ += run.error_occurred ? 1 : 0;
    kept.push_back(std::move(run));
  }
  if (next_ != nullptr && !kept.empty()) next_->ReportRuns(kept);
}

void RowReporter::Finalize() {
  if (next_ != nullptr) next_->Finalize();
}

bool ResultCollector::ReportContext(const Context& context) {
  json_.SetOutputStream(&text_);
  started_ = true;
  return RowReporter::ReportContext(context);
}

void ResultCollector::Finalize() {
  if (started_) RowReporter::Finalize();
}

std::string ResultCollector::document(const ContextKeys& context) const {
  nlohmann::ordered_json json;
  try {
    json = nlohmann::ordered_json::parse(text_.str());
  } catch (const nlohmann::json::exception& e) {
    throw Error(std::string("Google Benchmark wrote no valid JSON: ") + e.what());
  }
  for (const auto& [key, value] : context) json["context"][key] = value;
  return json.dump(2) + "\n";
}

}  // namespace sixdof::bench
