#include "bench/harness/reporter.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include <fmt/format.h>

#include "bench/common/json_text.h"

namespace sixdof::bench {
namespace {

using Run = benchmark::BenchmarkReporter::Run;

bool is_finite(const std::pair<const std::string, benchmark::Counter>& counter) {
  return std::isfinite(counter.second.value);
}

}  // namespace

void RowReporter::ReportRuns(const std::vector<Run>& runs) {
  std::vector<Run> kept;
  for (Run run : runs) {
    if (left_out_.contains(run.run_name.function_name)) continue;
    if (run.aggregate_name == "cv") {
      if (!std::isfinite(run.real_accumulated_time) || !std::isfinite(run.cpu_accumulated_time)) continue;
      std::erase_if(run.counters, std::not_fn(is_finite));
    } else if (!run.error_occurred) {
      const auto bad = std::ranges::find_if_not(run.counters, is_finite);
      if (bad != run.counters.end()) {
        run.error_occurred = true;
        run.error_message = fmt::format("counter {} is not finite ({})", bad->first, bad->second.value);
        run.counters.clear();
      }
    }
    failed_ += run.error_occurred ? 1 : 0;
    kept.push_back(std::move(run));
  }
  if (next_ != nullptr && !kept.empty()) next_->ReportRuns(kept);
}

bool JsonRows::ReportContext(const Context& context) {
  std::ostringstream text;
  benchmark::JSONReporter writer;
  writer.SetOutputStream(&text);
  writer.ReportContext(context);
  writer.Finalize();
  document = nlohmann::ordered_json::parse(valid_utf8(text.str()));
  return true;
}

std::string ResultCollector::document(const ContextKeys& context) const {
  nlohmann::ordered_json json = rows_.document;
  for (const auto& [key, value] : context) json["context"][key] = value;
  return json_text(json) + "\n";
}

}  // namespace sixdof::bench
