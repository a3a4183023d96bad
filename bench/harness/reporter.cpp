#include "bench/harness/reporter.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof::bench {

bool ResultCollector::ReportContext(const Context& context) {
  json_.SetOutputStream(&text_);
  started_ = true;
  return json_.ReportContext(context);
}

void ResultCollector::ReportRuns(const std::vector<Run>& runs) {
  std::vector<Run> kept;
  for (const Run& run : runs) {
    if (run.error_occurred) {
      ++failed_;
    } else if (run.run_type == Run::RT_Iteration) {
      ++rows_;
    }
    if (!std::isfinite(run.real_accumulated_time) || !std::isfinite(run.cpu_accumulated_time)) continue;
    kept.push_back(run);
    std::erase_if(kept.back().counters, [](const auto& counter) { return !std::isfinite(counter.second.value); });
  }
  if (!kept.empty()) json_.ReportRuns(kept);
}

void ResultCollector::Finalize() {
  if (started_) json_.Finalize();
}

std::string ResultCollector::document(const std::vector<std::pair<std::string, std::string>>& context) const {
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
