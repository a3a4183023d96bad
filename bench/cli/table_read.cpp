#include <algorithm>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>
#include <sixdof/measure/metrics.h>
#include <sixdof/report/result_json.h>
#include "bench/cli/table.h"

namespace sixdof::cli {
namespace {

using Json = nlohmann::ordered_json;
using report::nanoseconds;
using report::text_at;
using report::words_of;

Json result_document(const std::string& text, const std::string& path) {
  Json document = report::parse_document(text, path);
  if (!document.is_object() || !document.contains("benchmarks") || !document["benchmarks"].is_array()) {
    throw BadFile(path, "not a result file of sixdof-bench: it has no array \"benchmarks\"");
  }
  return document;
}

/// @throws Error
ResultRow row_of(const Json& entry) {
  if (!entry.contains(k_row_fields_key)) {
    throw Error(
        fmt::format("no \"{}\" object: not a row of sixdof-bench, or of one before it wrote them; measure again",
                    k_row_fields_key));
  }
  ResultRow row{.fields = row_fields_of(entry.at(k_row_fields_key)), .error = {}, .values = {}};
  if (row.fields.cache.empty()) row.fields.cache = "warm";  // written before there were cold rows
  if (entry.contains("error_occurred") && entry.at("error_occurred") == true) {
    row.error = text_at(entry, "error_message");
    if (row.error.empty()) row.error = "unknown error";
    return row;
  }
  for (const auto& [key, value] : entry.items()) {
    if (value.is_number() && find_metric(key) != nullptr) row.values[key] = value.get<double>();
  }
  for (const auto& [key, name] : {std::pair("cpu_time", k_processor_mean), std::pair("real_time", k_wall_mean)}) {
    const auto found = row.values.find(key);
    if (found == row.values.end()) throw Error(fmt::format("no number \"{}\"", key));
    row.values[name] = found->second * nanoseconds(text_at(entry, "time_unit"));
    row.values.erase(found);
  }
  if (row.fields.cache == "cold") row.values.erase(k_processor_mean);  // the wall time again
  return row;
}

bool are_repetitions(const RowFields& a, const RowFields& b) {
  return a.query == b.query && a.algorithm == b.algorithm && a.pair == b.pair && a.bucket == b.bucket &&
         a.order == b.order && a.cache == b.cache;
}

/// Adds a row, or keeps the better one of two repetitions. @throws Error
void add(ResultRow row, ResultFile& file) {
  const auto same = std::ranges::find_if(
      file.rows, [&](const ResultRow& other) { return are_repetitions(row.fields, other.fields); });
  if (same == file.rows.end()) {
    file.rows.push_back(std::move(row));
    return;
  }
  if (same->fields.settings != row.fields.settings) {
    throw Error(fmt::format("{} has the settings {} here and {} in an earlier row", row.fields.algorithm,
                            row.fields.settings, same->fields.settings));
  }
  const char* const mean = row.fields.cache == "cold" ? k_wall_mean : k_processor_mean;
  const auto time = row.value(mean), earlier = same->value(mean);
  if (time && (!earlier || *time < *earlier)) *same = std::move(row);
}

}  // namespace

std::optional<double> ResultRow::value(const std::string& name) const {
  const auto found = values.find(name);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

std::uint64_t ResultRow::count(const std::string& name) const {
  return static_cast<std::uint64_t>(value(name).value_or(0.0));
}

ResultFile parse_result_file(const std::string& text, const std::string& path) {
  const Json document = result_document(text, path);
  ResultFile file;
  file.path = visible_text(path, k_any_length);
  if (document.contains("context") && document.at("context").is_object()) {
    const Json& context = document.at("context");
    file.date = text_at(context, "date");
    file.commit = text_at(context, "commit");
    file.interrupted = text_at(context, "interrupted") == "true";
  }
  std::size_t index = 0;
  for (const Json& entry : document.at("benchmarks")) {
    const std::string place = fmt::format("benchmarks[{}]", index++);
    if (!entry.is_object()) throw BadFile(path, place, "not an object");
    const std::string name = text_at(entry, "name");
    try {
      if (text_at(entry, "run_type") == "aggregate") continue;
      ResultRow row = row_of(entry);
      if (row.fields.bucket) {
        add(std::move(row), file);
      } else {
        ++file.not_shown[row.fields.query];
      }
    } catch (const Error& e) {
      throw BadFile(path, name.empty() ? place : fmt::format("{} ({})", place, name), e.what());
    } catch (const Json::exception& e) {
      throw BadFile(path, name.empty() ? place : fmt::format("{} ({})", place, name), words_of(e));
    }
  }
  return file;
}

ResultFile read_result_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw BadFile(path, "cannot be opened");
  std::ostringstream text;
  text << in.rdbuf();
  if (in.bad()) throw BadFile(path, "cannot be read");
  return parse_result_file(text.str(), path);
}

}  // namespace sixdof::cli
