#include <sixdof/report/page.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/measure/metrics.h>
#include <sixdof/report/history.h>
#include <sixdof/report/tables.h>

namespace sixdof::report {
namespace {

using Json = nlohmann::ordered_json;

/// In the order in which they run.
constexpr const char* k_libraries[] = {"vega.min.js", "vega-lite.min.js", "vega-embed.min.js", "three.min.js"};
constexpr const char* k_scripts[] = {"figure_spec.js", "figure_text.js", "elements.js",
                                     "figure_card.js", "scene_view.js",  "app.js"};

std::string read_text(const std::filesystem::path& path, const std::string& missing) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw BadFile(path.string(), missing);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Numbers are rounded, since a reader of a figure sees no more.
Json as_json(const Cell& cell) {
  if (const auto* const number = std::get_if<double>(&cell)) {
    if (!std::isfinite(*number)) return nullptr;
    return Json::parse(number_text(*number));
  }
  const auto* const text = std::get_if<std::string>(&cell);
  return text == nullptr ? Json(nullptr) : Json(*text);
}

/// Texts of a column stand once, in `texts`, and its cells hold their indices there (or null), so that a table of a
/// hundred thousand lines stays small. No column has both texts and numbers.
Json as_json(const DataTable& table) {
  Json texts = Json::object(), rows = Json::array();
  std::vector<std::map<std::string, std::size_t>> index(table.columns.size());
  std::vector<bool> is_text(table.columns.size(), false);
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) is_text[i] = is_text[i] || std::holds_alternative<std::string>(row[i]);
  }
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (is_text[i]) texts[table.columns[i]] = Json::array();
  }
  for (const auto& row : table.rows) {
    Json cells = Json::array();
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto* const text = std::get_if<std::string>(&row[i]);
      if (text == nullptr) {
        cells.push_back(as_json(row[i]));
        continue;
      }
      const auto [place, is_new] = index[i].try_emplace(*text, index[i].size());
      if (is_new) texts[table.columns[i]].push_back(*text);
      cells.push_back(place->second);
    }
    rows.push_back(std::move(cells));
  }
  return {{"title", table.title}, {"columns", table.columns}, {"texts", std::move(texts)}, {"rows", std::move(rows)}};
}

/// Coordinates with five digits: a tenth of a pixel on a large screen.
Json as_json(const DrawnMesh& mesh) {
  Json vertices = Json::array(), triangles = Json::array();
  for (const auto& p : mesh.vertices) {
    for (const float x : p) vertices.push_back(Json::parse(fmt::format("{:.5g}", x)));
  }
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t vertex : t) triangles.push_back(vertex);
  }
  return {{"name", mesh.name},
          {"before", mesh.triangles_before},
          {"vertices", std::move(vertices)},
          {"triangles", std::move(triangles)}};
}

Json as_json(const Scene& scene) {
  Json moments = Json::array();
  for (const Moment& moment : scene.moments) {
    Json numbers = Json::array();
    const auto add = [&](const auto& values) {
      for (const double value : values) numbers.push_back(as_json(Cell(value)));
    };
    add(moment.pose);
    for (const auto* const vector : {&moment.force, &moment.ideal_force, &moment.torque, &moment.ideal_torque})
      add(*vector);
    moments.push_back(std::move(numbers));
  }
  return {{"name", scene.name},
          {"algorithm", scene.algorithm},
          {"kind", scene.kind},
          {"command", scene.command},
          {"a", scene.a},
          {"b", scene.b},
          {"reference", scene.reference},
          {"rate_hz", scene.rate_hz},
          {"stride", scene.stride},
          {"contacts", scene.contacts},
          {"curve", scene.curve},
          {"moments", std::move(moments)}};
}

/// What a reader needs to know of the numbers in the table of metrics, by their columns.
Json metrics_json(const Report& report) {
  Json described = Json::object();
  for (const DataTable& table : report.tables) {
    if (table.name != "metrics") continue;
    for (const std::string& column : table.columns) {
      const bool is_mean = column == k_processor_mean || column == k_wall_mean;
      if (is_mean) {
        described[column] = {{"unit", "ns"},
                             {"better", "lower"},
                             {"meaning", column == k_wall_mean ? "mean time by wall clock" : "mean processor time"}};
      } else if (const Metric* const metric = find_metric(column)) {
        described[column] = {
            {"unit", metric->unit}, {"better", to_string(metric->better)}, {"meaning", metric->meaning}};
      }
    }
  }
  return described;
}

/// Without '<', nothing in a script element can end it or open a comment.
std::string inert(const std::string& json) {
  std::string text;
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

/// three comes as a module only, whose names another script of a file on disk cannot import: its list of exports,
/// "export{a as A,b as B};" at the end, becomes an object.
std::string script_of_module(const std::string& module, const std::string& name) {
  const std::size_t begin = module.rfind("export{"), end = module.find('}', begin);
  if (begin == std::string::npos || end == std::string::npos) throw Error(name + " has no list of exports");
  std::istringstream exports(module.substr(begin + 7, end - begin - 7));
  std::string members;
  for (std::string item; std::getline(exports, item, ',');) {
    const std::size_t as = item.find(" as ");
    members += as == std::string::npos ? item + ":" + item + "," : item.substr(as + 4) + ":" + item.substr(0, as) + ",";
  }
  return "var " + name + "=(function(){" + module.substr(0, begin) + "return{" + members + "};})();";
}

/// "</script" inside a library ends no element.
std::string script_element(std::string text) {
  for (std::size_t at = 0; (at = text.find("</script", at)) != std::string::npos;) text.replace(at, 2, "<\\/");
  return "<script>\n" + text + "\n</script>\n";
}

void replace(std::string& text, const std::string& place, const std::string& with) {
  const std::size_t at = text.find(place);
  if (at == std::string::npos) throw Error(fmt::format("page.html has no {}", place));
  text.replace(at, place.size(), with);
}

std::vector<std::string> algorithms_of(const Results& results, const std::vector<Series>& series) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const Row& row : results.rows) {
    if (row.fields.algorithm != "null") add(row.fields.algorithm);
  }
  for (const HardCase& cell : results.hard_cases) add(cell.algorithm);
  for (const Series& each : series) add(each.algorithm);
  for (const CollectionCell& cell : results.collection.cells) add(cell.algorithm);
  for (const GrowthSeries& each : results.growth) add(each.algorithm);
  return names;
}

/// Names of the runs, with how busy the machine was where it did other work.
std::vector<RunLoad> loads_of(const Results& results) {
  std::vector<RunLoad> loads;
  for (std::size_t file = 0; file < results.files.size(); ++file) {
    const nlohmann::json load = nlohmann::json::parse(results.files[file].at("load_avg"), nullptr, false);
    const nlohmann::json processors = nlohmann::json::parse(results.files[file].at("num_cpus"), nullptr, false);
    RunLoad run{.name = run_name(results, file)};
    if (load.is_array() && !load.empty() && load[0].is_number() && processors.is_number()) {
      run.load = load[0].get<double>();
      run.processors = processors.get<double>();
    }
    loads.push_back(std::move(run));
  }
  return loads;
}

std::string made_from(const Results& results, const std::vector<Series>& series) {
  std::string text;
  for (std::size_t file = 0; file < results.files.size(); ++file) {
    const Source& source = results.files[file];
    text += fmt::format("{}{}", text.empty() ? "" : " · ", run_name(results, file));
    if (const std::string date = source.at("date"); !date.empty()) text += ", " + date.substr(0, 10);
    if (const std::string commit = source.at("commit"); !commit.empty()) text += ", commit " + commit.substr(0, 12);
  }
  if (!series.empty()) text += fmt::format("{}{} series", text.empty() ? "" : " · ", series.size());
  return text;
}

}  // namespace

Report make_report(const Results& results, const std::vector<Series>& series) {
  const std::vector<RowGroup> groups = row_groups(results);
  Report report{.summary = summarise(results, groups),
                .comparisons = comparisons(results, groups),
                .tables = {times_table(results, groups),
                           libraries_table(results, groups),
                           response_errors_table(results, groups),
                           scenario_measures_table(results, groups),
                           metrics_table(results, groups),
                           casts_table(results, groups),
                           many_bodies_table(results, groups),
                           contacts_table(results, groups),
                           depths_table(results, groups),
                           deforming_table(results, groups),
                           refit_payoff_table(results, groups),
                           collection_table(results),
                           collection_ratios_table(results),
                           growth_table(results),
                           growth_exponents_table(results),
                           signals_table(series),
                           spectra_table(series),
                           frontier_table(results, groups),
                           equal_time_table(results, groups),
                           stability_table(results),
                           objects_table(results),
                           perception_table(series),
                           perception_thresholds_table(series),
                           update_rates_table(results, groups),
                           failures_table(results, groups),
                           settings_table(results),
                           runs_table(results, series)},
                .scenes = make_scenes(results, series),
                .algorithms = algorithms_of(results, series),
                .runs = loads_of(results),
                .made_from = made_from(results, series)};
  report.tables.push_back(report.summary.winners);
  DataTable changes{.name = "changes", .title = "Times that changed", .columns = {}, .rows = {}};
  DataTable answers{.name = "answers", .title = "Answers that changed", .columns = {}, .rows = {}};
  for (const Comparison& comparison : report.comparisons) {
    for (const auto& [part, whole] :
         {std::pair(&comparison.changes, &changes), std::pair(&comparison.answers, &answers)}) {
      whole->columns = part->columns;
      whole->rows.insert(whole->rows.end(), part->rows.begin(), part->rows.end());
    }
  }
  report.tables.push_back(std::move(changes));
  report.tables.push_back(std::move(answers));
  return report;
}

Report make_history(const Results& results) {
  const std::vector<RowGroup> groups = row_groups(results);
  Report report{.summary = {.sentences = {fmt::format("{} runs.", results.files.size())}, .winners = {}},
                .comparisons = {},
                .tables = {history_table(results, groups), settings_table(results), runs_table(results, {})},
                .scenes = {},
                .algorithms = algorithms_of(results, {}),
                .runs = loads_of(results),
                .made_from = fmt::format("{} runs, {} to {}", results.files.size(),
                                         results.files.front().at("date").substr(0, 10),
                                         results.files.back().at("date").substr(0, 10))};
  if (const std::size_t files = results.files.size(); files > 1) {
    Comparison last = compare(results, groups, files - 2, files - 1);
    report.tables.push_back(last.changes);
    report.tables.push_back(last.answers);
    report.comparisons.push_back(std::move(last));
  }
  const auto changes = std::ranges::count_if(report.tables[0].rows, [](const std::vector<Cell>& row) {
    return std::holds_alternative<double>(row[k_history_change]);
  });
  report.summary.sentences.push_back(
      fmt::format("Changes of level over all rows: {}; they stand under History.", changes));
  return report;
}

PageFiles read_page_files(const std::filesystem::path& folder) {
  PageFiles files{
      .folder = folder, .html = {}, .style = {}, .libraries = {}, .scripts = {}, .pages = {}, .figures = {}};
  const std::string part = "is missing: it comes with the programs";
  files.html = read_text(folder / "page" / "page.html", part);
  files.style = read_text(folder / "page" / "style.css", part);
  files.pages = read_text(folder / "page" / "pages.json", part);
  for (const char* const name : k_scripts) files.scripts.push_back(read_text(folder / "page" / name, part));
  for (const std::string name : k_libraries) {
    const std::string text = read_text(
        folder / "vendor" / name,
        "is missing: the build takes it from npm. Run cmake/setup report, which installs npm, and build again");
    files.libraries.push_back(name.starts_with("three") ? script_of_module(text, "THREE") : text);
  }
  std::vector<std::filesystem::path> figures;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "figures")) {
    if (entry.path().extension() == ".json") figures.push_back(entry.path());
  }
  std::ranges::sort(figures);
  for (const auto& path : figures) files.figures.push_back(read_text(path, part));
  return files;
}

std::string page_data(const Report& report, const PageFiles& files) {
  Json data = {
      {"made_from", report.made_from}, {"algorithms", report.algorithms},   {"summary", report.summary.sentences},
      {"comparisons", Json::array()},  {"pages", Json::parse(files.pages)}, {"figures", Json::object()},
      {"tables", Json::object()}};
  for (const Comparison& comparison : report.comparisons) {
    data["comparisons"].push_back(
        {{"before", comparison.before}, {"after", comparison.after}, {"sentences", comparison.sentences}});
  }
  for (const std::string& figure : files.figures) {
    Json spec = Json::parse(figure);
    const std::string id = spec.at("usermeta").at("id").get<std::string>();
    data["figures"][id] = std::move(spec);
  }
  for (const DataTable& table : report.tables) data["tables"][table.name] = as_json(table);
  data["metrics"] = metrics_json(report);
  data["choices"] = report.choices;
  data["runs"] = Json::array();
  for (const RunLoad& run : report.runs) {
    data["runs"].push_back(
        {{"name", run.name}, {"load", run.load}, {"processors", run.processors}, {"is_busy", run.is_busy()}});
  }
  data["meshes"] = Json::array();
  for (const DrawnMesh& mesh : report.scenes.meshes) data["meshes"].push_back(as_json(mesh));
  data["scenes"] = Json::array();
  for (const Scene& scene : report.scenes.scenes) data["scenes"].push_back(as_json(scene));
  return data.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string page_html(const Report& report, const PageFiles& files) {
  std::string scripts;
  for (const std::string& text : files.libraries) scripts += script_element(text);
  std::string own;
  for (const std::string& text : files.scripts) own += script_element(text);
  std::string html = files.html;
  replace(html, "{{style}}", files.style);
  // The data go in last: what they hold is not searched for places.
  replace(html, "{{scripts}}", scripts + own);
  replace(html, "{{data}}", inert(page_data(report, files)));
  return html;
}

}  // namespace sixdof::report
