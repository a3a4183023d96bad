#include <nlohmann/json.hpp>

#include "bench/cli/table.h"

namespace sixdof::cli {
namespace {

using Json = nlohmann::ordered_json;

Json as_json(const ResultFile& file) {
  Json settings = Json::object();
  for (const ResultRow& row : file.rows) {
    settings[row.fields.algorithm] = to_json_object(row.fields).at("settings");
  }
  return {{"file", file.path},     {"date", file.date},
          {"commit", file.commit}, {"interrupted", file.interrupted},
          {"settings", settings},  {"not_shown", file.not_shown}};
}

Json as_json(const RankedRow& ranked) {
  if (ranked.row == nullptr) return nullptr;
  Json faults = Json::array();
  for (const Fault& fault : ranked.faults) {
    Json entry = {{"what", fault.what}};
    if (fault.of > 0) entry.update({{"count", fault.count}, {"of", fault.of}});
    faults.push_back(std::move(entry));
  }
  return {{"fastest", ranked.fastest},
          {"faults", faults},
          {"ratio_to_first", ranked.ratio ? Json(*ranked.ratio) : Json(nullptr)},
          {"values", ranked.row->values}};
}

}  // namespace

Json as_json(const std::vector<ResultTable>& tables, const std::vector<ResultFile>& files) {
  Json document = {{"files", Json::array()}, {"tables", Json::array()}};
  for (const ResultFile& file : files) document["files"].push_back(as_json(file));
  for (const ResultTable& table : tables) {
    Json lines = Json::array();
    for (const TableLine& line : table.lines) {
      Json of_files = Json::array();
      for (const RankedRow& ranked : line.files) of_files.push_back(as_json(ranked));
      lines.push_back({{"percent", percent_number(line.bucket)},
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
