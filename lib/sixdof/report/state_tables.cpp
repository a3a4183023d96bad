#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/report/tables.h>

namespace sixdof::report {
namespace {

/// Keys of the context that stand in the table of settings.
bool is_setting(const std::string& key) { return key.starts_with("settings:") || key.starts_with("algorithm:"); }

}  // namespace

std::string run_name(const Results& results, std::size_t file) {
  return fmt::format("[{}] {}", file + 1, std::filesystem::path(results.files[file].path).stem().string());
}

DataTable stability_table(const Results& results) {
  DataTable table{
      .name = "stability",
      .title = "Hard cases: the worst verdict of each family",
      .columns = {"run", "family", "algorithm", "verdict", "cases", "worst", "unit", "case", "words", "command"},
      .rows = {}};
  for (const HardCase& cell : results.hard_cases) {
    table.rows.push_back({run_name(results, cell.file), cell.family, cell.algorithm, cell.verdict, cell.cases,
                          cell.worst, cell.unit, cell.name, cell.words, cell.reproduction});
  }
  return table;
}

DataTable objects_table(const Results& results) {
  DataTable table{.name = "objects",
                  .title = "Objects that the rows are about",
                  .columns = {"object", "triangles", "vertices", "content_hash"},
                  .rows = {}};
  std::set<std::string> seen;
  for (const Source& file : results.files) {
    for (const auto& [key, hash] : file.context) {
      if (!key.starts_with("mesh:") || !seen.insert(key).second) continue;
      const std::string name = key.substr(std::string("mesh:").size());
      try {
        if (names_file(name)) throw BadArgument(name);
        const Mesh mesh = load_model(name);
        table.rows.push_back(
            {name, static_cast<double>(mesh.triangles().size()), static_cast<double>(mesh.vertices().size()), hash});
      } catch (const Error&) {  // A mesh of the user's, or a model that is not fetched here: its hash is all there is.
        table.rows.push_back({name, Cell(), Cell(), hash});
      }
    }
  }
  return table;
}

DataTable failures_table(const Results& results, const std::vector<RowGroup>& groups) {
  DataTable table{
      .name = "failures",
      .title = "Rows with failures or wrong answers",
      .columns = {"run", "query", "question", "pair", "algorithm", "bucket", "fault", "command", "worst_pose"},
      .rows = {}};
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    if (row.fields.algorithm == "null") continue;  // answers nothing, by design
    for (const Fault& fault : mistakes(group.faults)) {
      table.rows.push_back({run_name(results, row.file), row.fields.query, row.fields.question, bodies_of(row.fields),
                            group.algorithm(), place_of(row.fields), to_string(fault),
                            reproduction(row, results.files[row.file]), row.outliers.command_of(fault.counter)});
    }
  }
  return table;
}

DataTable settings_table(const Results& results) {
  DataTable table{.name = "settings",
                  .title = "Versions and settings of the algorithms",
                  .columns = {"run", "algorithm", "version", "settings", "in_rows"},
                  .rows = {}};
  for (std::size_t file = 0; file < results.files.size(); ++file) {
    for (const auto& [key, version] : results.files[file].context) {
      if (!key.starts_with("algorithm:")) continue;
      const std::string name = key.substr(std::string("algorithm:").size());
      const std::string usual = results::settings_as_read(results.files[file].at("settings:" + name));
      std::map<std::string, double> counts{{usual, 0.0}};  // rows may have others, such as those of scenarios
      for (const Row& row : results.rows) {
        if (row.file != file || row.fields.algorithm != name) continue;
        ++counts[row.fields.settings.empty() ? usual : row.fields.settings];
      }
      for (const auto& [settings, rows] : counts) {
        table.rows.push_back({run_name(results, file), name, version, settings, rows});
      }
    }
  }
  return table;
}

DataTable runs_table(const Results& results, const std::vector<Series>& series) {
  DataTable table{.name = "runs",
                  .title = "Machine, build and inputs of every file",
                  .columns = {"run", "key", "value"},
                  .rows = {}};
  for (std::size_t file = 0; file < results.files.size(); ++file) {
    table.rows.push_back({run_name(results, file), std::string("file"), results.files[file].path});
    for (const auto& [key, value] : results.files[file].context) {
      if (!is_setting(key)) table.rows.push_back({run_name(results, file), key, value});
    }
  }
  for (const Series& each : series) {
    table.rows.push_back({fmt::format("{}: {}", each.scenario, each.algorithm), std::string("series"),
                          fmt::format("{} {}, law {}, {}, {}", each.algorithm, each.version, each.law,
                                      each.settings.empty() ? "no settings" : each.settings, each.shape)});
  }
  return table;
}

}  // namespace sixdof::report
