#include <sixdof/results/row.h>

#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/measure/metrics.h>
#include <sixdof/results/result_json.h>

namespace sixdof::results {
namespace {

using Json = nlohmann::ordered_json;

/// Google Benchmark's name and ours.
constexpr std::pair<const char*, const char*> k_means[] = {{"cpu_time", k_processor_mean}, {"real_time", k_wall_mean}};
/// Of RowFields::runtime.
constexpr const char* k_native = "native";
constexpr const char* k_bounds[] = {"", "_low", "_high"};

/// Means and their bounds in ns, under names that say so.
void take_values(const Json& entry, Row& row) {
  for (const auto& [key, value] : entry.items()) {
    if (value.is_number() && find_metric(key) != nullptr) row.values[key] = value.get<double>();
  }
  for (const auto& [key, name] : k_means) {
    if (!row.values.contains(key)) throw Error(fmt::format("no number \"{}\"", key));
    const double unit = nanoseconds(text_at(entry, "time_unit"));
    for (const std::string bound : k_bounds) {
      auto node = row.values.extract(key + bound);
      if (node) row.values[name + bound] = unit * node.mapped();
    }
  }
  if (row.fields.cache == "cold") row.values.erase(k_processor_mean);  // the wall time again
}

}  // namespace

std::optional<double> Row::value(const std::string& metric) const {
  const auto found = values.find(metric);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

std::optional<Estimate> Row::estimate(const std::string& metric) const {
  for (const auto& [theirs, ours] : k_means) {
    if (metric == theirs) return estimate(ours);
  }
  const auto middle = value(metric);
  if (!middle) return std::nullopt;
  return Estimate{*middle, value(metric + "_low").value_or(*middle), value(metric + "_high").value_or(*middle)};
}

std::string interpreter_of(const RowFields& fields) { return fields.runtime == k_native ? "" : fields.runtime; }

std::string class_of(const RowFields& fields) {
  const std::string interpreter = interpreter_of(fields);
  if (fields.body.empty() || interpreter.empty()) return fields.body + interpreter;
  return fmt::format("{}, {}", fields.body, interpreter);
}

std::string bodies_of(const RowFields& fields) {
  const std::string apart = class_of(fields);
  if (fields.pair.empty() || apart.empty()) return fields.pair + apart;
  return fmt::format("{} ({})", fields.pair, apart);
}

CastMotion cast_motion_of(const RowFields& fields) {
  const auto slash = fields.order.find('/');
  if (fields.query != k_cast || slash == std::string::npos) return {};
  const char* const begin = fields.order.data() + slash + 1;
  const char* const end = fields.order.data() + fields.order.size();
  double percent = 0.0;
  const auto [stop, error] = std::from_chars(begin, end, percent);
  if (error != std::errc() || stop != end) return {};
  return {fields.order.substr(0, slash), percent};
}

std::string place_of(const RowFields& fields) {
  if (const CastMotion motion = cast_motion_of(fields); !motion.kind.empty()) {
    return fmt::format("{} {:g} %", motion.kind, motion.percent);
  }
  return fields.bucket ? fmt::format("{} {:g} %", to_string(fields.bucket->kind), fields.bucket->percent)
                       : fields.scenario;
}

Row parse_row(const Json& entry) {
  if (!entry.contains(k_row_fields_key)) {
    throw Error(
        fmt::format("no \"{}\" object: not a row of sixdof-bench, or of one before it wrote them; measure again",
                    k_row_fields_key));
  }
  Row row{.name = text_at(entry, "name"),
          .fields = row_fields_of(entry.at(k_row_fields_key)),
          .label = text_at(entry, "label")};
  if (row.fields.bucket && row.fields.cache.empty()) row.fields.cache = "warm";
  if (entry.contains("error_occurred") && entry.at("error_occurred") == true) {
    row.error = text_at(entry, "error_message");
    if (row.error.empty()) row.error = "unknown error";
  } else {
    take_values(entry, row);
  }
  if (entry.contains(k_outliers_key)) row.outliers = parse_outliers(entry.at(k_outliers_key));
  return row;
}

Json to_json_object(const Row& row) {
  Json json = {{"name", row.name},      {"run_name", row.name}, {"run_type", "iteration"}, {"repetitions", 1},
               {"repetition_index", 0}, {"threads", 1},         {"iterations", 1}};
  const auto add = [&](const std::string& name, double value) {
    if (!std::isfinite(value)) throw Error(fmt::format("{}: {} is not finite", row.name, name));
    if (find_metric(name) == nullptr) throw Error(fmt::format("{}: {} is not in the table of metrics", row.name, name));
    json[name] = value;
  };
  if (row.error.empty()) {
    std::map<std::string, double> values = row.values;
    for (const auto& [theirs, ours] : k_means) {
      for (const std::string bound : k_bounds) {
        if (const auto node = values.extract(ours + bound)) add(theirs + bound, node.mapped());
      }
    }
    json["time_unit"] = "ns";
    if (!row.label.empty()) json["label"] = row.label;
    for (const auto& [name, value] : values) add(name, value);
  } else {
    json["error_occurred"] = true;
    json["error_message"] = row.error;
  }
  json[k_row_fields_key] = to_json_object(row.fields);
  return json;
}

}  // namespace sixdof::results
