#include "bench/study/study_rows.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/measure/metrics.h>
#include "bench/common/json_text.h"

namespace sixdof::study {

using Json = nlohmann::ordered_json;

Json to_json_object(const StudyRow& row) {
  Json json = {{"name", row.name},      {"run_name", row.name}, {"run_type", "iteration"}, {"repetitions", 1},
               {"repetition_index", 0}, {"threads", 1},         {"iterations", 1}};
  const auto add = [&](const std::string& name, double value) {
    if (!std::isfinite(value)) throw Error(fmt::format("{}: {} is not finite", row.name, name));
    if (find_metric(name) == nullptr) throw Error(fmt::format("{}: {} is not in the table of metrics", row.name, name));
    json[name] = value;
  };
  if (row.error.empty()) {
    add("real_time", row.real_time_ns);
    add("cpu_time", row.cpu_time_ns);
    json["time_unit"] = "ns";
    if (!row.label.empty()) json["label"] = row.label;
    for (const auto& [name, value] : row.counters) add(name, value);
  } else {
    json["error_occurred"] = true;
    json["error_message"] = row.error;
  }
  json[k_row_fields_key] = to_json_object(row.fields);
  return json;
}

Json study_document(const Json& context, const std::vector<StudyRow>& rows) {
  Json list = Json::array();
  for (const StudyRow& row : rows) list.push_back(to_json_object(row));
  return {{"context", context}, {"benchmarks", std::move(list)}};
}

void write_study_rows(const std::filesystem::path& file, const Json& context, const std::vector<StudyRow>& rows) {
  write_file_atomically(file, json_text(study_document(context, rows)) + "\n");
}

}  // namespace sixdof::study
