#include "bench/harness/row_json.h"

#include <sstream>

#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>
#include "bench/harness/benchmark_versions.h"

namespace sixdof::bench {

using Json = nlohmann::ordered_json;
using Run = benchmark::BenchmarkReporter::Run;

Json row_json(const Run& run, const FieldsByName& fields, const OutliersByName& outliers) {
  std::ostringstream text;
  benchmark::JSONReporter writer;
  writer.SetOutputStream(&text);
  writer.ReportRuns({run});  // without a context: the object alone
  Json json;
  try {
    json = Json::parse(visible_json(text.str()));  // which has control characters as they are
  } catch (const Json::exception& e) {
    throw Error(run.benchmark_name() + ": Google Benchmark wrote no valid JSON: " + e.what());
  }
  results::RowFields of_run = fields.at(run.run_name.function_name);
  const auto asked = run.counters.find("configurations");
  if (asked != run.counters.end() && run.run_type == Run::RT_Iteration) {
    of_run.configurations = static_cast<std::uint64_t>(asked->second.value);
  }
  json[results::k_row_fields_key] = results::to_json_object(of_run);
  const auto found = outliers.find(run.run_name.function_name);
  if (found != outliers.end() && run.run_type == Run::RT_Iteration && !has_error(run)) {
    json[results::k_outliers_key] = results::to_json_object(found->second());
  }
  return json;
}

}  // namespace sixdof::bench
