#include <nlohmann/json.hpp>

#include "bench/cli/table.h"

namespace sixdof::cli {
namespace {

using Json = nlohmann::ordered_json;
using results::Fault;

Json file_json(const TableInput& input, std::size_t file) {
  const results::Source& source = input.content.files[file];
  Json settings = Json::object();
  for (const auto& [algorithm, text] : settings_of(input, file)) {
    settings[algorithm] =
        results::to_json_object({.query = {}, .algorithm = algorithm, .settings = text}).at("settings");
  }
  return {{"file", source.path},           {"date", source.at("date")},
          {"commit", source.at("commit")}, {"interrupted", source.at("interrupted") == "true"},
          {"settings", settings},          {"not_shown", other_rows(input, file)}};
}

Json as_json(const RankedRow& ranked) {
  if (ranked.group == nullptr) return nullptr;
  Json faults = Json::array();
  for (const Fault& fault : ranked.group->faults) {
    Json entry = {{"what", fault.what}};
    if (fault.of > 0) entry.update({{"count", fault.count}, {"of", fault.of}});
    faults.push_back(std::move(entry));
  }
  return {{"fastest", ranked.fastest},
          {"faults", faults},
          {"ratio_to_first", ranked.ratio ? Json(*ranked.ratio) : Json(nullptr)},
          {"values", ranked.group->values}};
}

}  // namespace

Json as_json(const std::vector<ResultTable>& tables, const TableInput& input) {
  Json document = {{"files", Json::array()}, {"tables", Json::array()}};
  for (std::size_t file = 0; file < input.files(); ++file) document["files"].push_back(file_json(input, file));
  for (const ResultTable& table : tables) {
    Json lines = Json::array();
    for (const TableLine& line : table.lines) {
      Json of_files = Json::array();
      for (const RankedRow& ranked : line.files) of_files.push_back(as_json(ranked));
      lines.push_back({{"percent", results::percent_number(line.bucket)},
                       {"algorithm", line.algorithm},
                       {"order", line.order},
                       {"cache", line.cache},
                       {"files", std::move(of_files)}});
    }
    document["tables"].push_back(
        {{"pair", table.pair}, {"query", table.query}, {"kind", to_string(table.kind)}, {"rows", std::move(lines)}});
  }
  return document;
}

}  // namespace sixdof::cli
