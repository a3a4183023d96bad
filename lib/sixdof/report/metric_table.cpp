#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include <sixdof/report/tables.h>

namespace sixdof::report {
namespace {

/// Bounds of intervals are no metrics of their own.
bool is_bound(const std::string& name) { return name.ends_with("_low") || name.ends_with("_high"); }

/// What rows are compared on: the same objects, path or bodies.
std::string place_of(const Row& row) {
  if (row.query == "scene") {
    return fmt::format("{}, {:.0f} bodies, {}", row.scenario, row.count("bodies"), row.question);
  }
  std::string place = row.pair;
  const auto add = [&](const std::string& text) { place += (place.empty() ? "" : ", ") + text; };
  if (!row.scenario.empty()) add("scenario " + row.scenario);
  if (!row.question.empty()) add(row.question);
  if (row.percent) add(fmt::format("{} {:g} %", row.kind, *row.percent));
  if (const auto tau = row.value("tau_ns")) add(fmt::format("{:g} ms", *tau / 1e6));
  return place.empty() ? row.query : place;
}

/// Memory and time of the prepared structure, from the row that prepares it.
using Prepared = std::map<std::tuple<std::size_t, std::string, std::string>, const RowGroup*>;

std::map<std::string, double> values_of(const RowGroup& group, const Prepared& prepared) {
  const Row& row = group.row();
  std::map<std::string, double> values;
  for (const auto& [name, value] : row.values) {
    if (!is_bound(name)) values[name] = group.median(name).value_or(value);
  }
  const auto found = prepared.find({row.file, row.pair, row.algorithm});
  if (row.query == "prepare" || row.pair.empty() || found == prepared.end()) return values;
  if (const auto bytes = found->second->median("bytes")) values.try_emplace("bytes", *bytes);
  if (const auto ns = found->second->median(k_wall_mean)) values.try_emplace("prepare_ns", *ns);
  return values;
}

}  // namespace

DataTable metrics_table(const Results& results, const std::vector<RowGroup>& groups) {
  Prepared prepared;
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    if (row.query == "prepare" && row.error.empty()) prepared[{row.file, row.pair, row.algorithm}] = &group;
  }
  std::vector<std::map<std::string, double>> all;
  std::set<std::string> names;
  for (const RowGroup& group : groups) {
    all.push_back(values_of(group, prepared));
    for (const auto& [name, value] : all.back()) names.insert(name);
  }
  DataTable table{.name = "metrics",
                  .title = "Every number of every row",
                  .columns = {"run", "query", "where", "algorithm", "settings", "faults", "command", "worst_pose"},
                  .rows = {}};
  table.columns.insert(table.columns.end(), names.begin(), names.end());
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const Row& row = groups[i].row();
    if (row.algorithm == "null" || all[i].empty()) continue;
    std::string faults;
    for (const Fault& fault : faults_of(row)) faults += (faults.empty() ? "" : ", ") + to_string(fault);
    if (!row.body.empty()) faults += (faults.empty() ? "" : ", ") + row.body;
    table.rows.push_back({run_name(results, row.file), row.query, place_of(row), groups[i].algorithm(), row.settings,
                          faults, reproduction(row, results.files[row.file]), row.outliers.command_of("max_least_ns")});
    std::vector<Cell>& cells = table.rows.back();
    for (const std::string& name : names) {
      cells.emplace_back();
      if (const auto found = all[i].find(name); found != all[i].end()) cells.back() = found->second;
    }
  }
  return table;
}

}  // namespace sixdof::report
