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
std::string where_of(const RowGroup& group) {
  const Row& row = group.row();
  if (row.fields.query == "scene") {
    return fmt::format("{}, {:.0f} bodies, {}", row.fields.scenario, group.count("bodies"), row.fields.question);
  }
  if (row.fields.query == "deform") {
    return fmt::format("{}, {:g} %, {}", row.fields.scenario, group.count("amplitude"), row.fields.question);
  }
  std::string place = bodies_of(row.fields);
  const auto add = [&](const std::string& text) { place += (place.empty() ? "" : ", ") + text; };
  if (!row.fields.scenario.empty()) add("scenario " + row.fields.scenario);
  if (!row.fields.question.empty()) add(row.fields.question);
  if (row.fields.bucket) add(place_of(row.fields));
  if (const auto tau = group.value("tau_ns")) add(fmt::format("{:g} ms", *tau / 1e6));
  return place.empty() ? row.fields.query : place;
}

/// Memory and time of the prepared structure, from the row that prepares it.
using Prepared = std::map<std::tuple<std::size_t, std::string, std::string>, const RowGroup*>;

std::map<std::string, double> values_of(const RowGroup& group, const Prepared& prepared) {
  const Row& row = group.row();
  std::map<std::string, double> values = group.values;
  std::erase_if(values, [](const auto& entry) { return is_bound(entry.first); });
  const auto found = prepared.find({row.file, row.fields.pair, row.fields.algorithm});
  if (row.fields.query == "prepare" || row.fields.pair.empty() || found == prepared.end()) return values;
  if (const auto bytes = found->second->value("bytes")) values.try_emplace("bytes", *bytes);
  if (const auto ns = found->second->value(k_wall_mean)) values.try_emplace("prepare_ns", *ns);
  return values;
}

}  // namespace

DataTable metrics_table(const Results& results, const std::vector<RowGroup>& groups) {
  Prepared prepared;
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    if (row.fields.query == "prepare" && row.error.empty())
      prepared[{row.file, row.fields.pair, row.fields.algorithm}] = &group;
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
    if (row.fields.algorithm == "null" || all[i].empty()) continue;
    table.rows.push_back({run_name(results, row.file), row.fields.query, where_of(groups[i]), groups[i].algorithm(),
                          row.fields.settings, to_string(mistakes(groups[i].faults)),
                          reproduction(row, results.files[row.file]), row.outliers.command_of("max_least_ns")});
    std::vector<Cell>& cells = table.rows.back();
    for (const std::string& name : names) {
      cells.emplace_back();
      if (const auto found = all[i].find(name); found != all[i].end()) cells.back() = found->second;
    }
  }
  return table;
}

}  // namespace sixdof::report
