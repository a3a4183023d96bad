#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include <sixdof/measure/metrics.h>
#include <sixdof/report/tables.h>

namespace sixdof::report {
namespace {

/// What a measure is called in a figure, with its unit.
struct Measure {
  const char* value;
  const char* title;
};

constexpr std::array k_response_errors{
    Measure{"gamma_F_deg", "force direction, mean (degrees)"},
    Measure{"gamma_max_F_deg", "force direction, largest (degrees)"},
    Measure{"gamma_T_deg", "torque direction, mean (degrees)"},
    Measure{"gamma_max_T_deg", "torque direction, largest (degrees)"},
    Measure{"magnitude_error_F", "force magnitude (fraction)"},
    Measure{"magnitude_error_T", "torque magnitude (fraction)"},
    Measure{"volume_error_mean", "overlap volume, mean (fraction)"},
};

constexpr std::array k_scenario_measures{
    Measure{"sigma_F", "force magnitude: sigma (paper's formula 1)"},
    Measure{"sigma_T", "torque magnitude: sigma (paper's formula 1)"},
    Measure{"gamma_F_deg", "force direction: gamma, degrees (formula 2)"},
    Measure{"gamma_T_deg", "torque direction: gamma, degrees (formula 2)"},
    Measure{"nu_F", "force spectrum: nu, ideal 1 (formula 3)"},
    Measure{"nu_T", "torque spectrum: nu, ideal 1 (formula 3)"},
    Measure{"noise_F", "force noise above 50 Hz (energy)"},
    Measure{"noise_T", "torque noise above 50 Hz (energy)"},
    Measure{"leakage", "leakage: unwanted over wanted part"},
    Measure{"jump_F", "largest jump of the force, over its peak"},
    Measure{"jump_T", "largest jump of the torque, over its peak"},
    Measure{"loop_work", "work on a closed path (energy made)"},
    Measure{"misses", "steps without a force (tunnelling)"},
    Measure{"lag", "lag (steps)"},
};

constexpr std::array k_frontier_errors{
    Measure{"gamma_F_deg", "force direction, mean (degrees)"},
    Measure{"gamma_F_p95_deg", "force direction, 95 % (degrees)"},
    Measure{"magnitude_error_F", "force magnitude (fraction)"},
    Measure{"gamma_T_deg", "torque direction, mean (degrees)"},
    Measure{"magnitude_error_T", "torque magnitude (fraction)"},
    Measure{"penalty_error", "penalty (fraction)"},
    Measure{"error_rms", "distance, RMS (diagonals of A)"},
    Measure{"error_max", "distance, largest (diagonals of A)"},
};

Cell cell_of(std::optional<double> value) { return value ? Cell(*value) : Cell(); }

/// A point of a plot of time against error.
struct Point {
  const Row* row;
  std::string source;
  Estimate us;
  double error;
  std::optional<double> low, high;
  std::string worst_pose;
  bool may_lead;  ///< Has no fault.
  bool leads = false;
};

/// Of the points of one plot: no other is at most as slow and as wrong, and better in one of them.
void mark_frontier(std::vector<Point>& points) {
  for (Point& point : points) {
    point.leads = point.may_lead && std::ranges::none_of(points, [&](const Point& other) {
                    return other.may_lead && other.us.value <= point.us.value && other.error <= point.error &&
                           (other.us.value < point.us.value || other.error < point.error);
                  });
  }
}

Estimate in_microseconds(const Estimate& ns) { return {ns.value / 1e3, ns.low / 1e3, ns.high / 1e3}; }

/// Slashes in the name of an answer: "equivalent/scenario:Ia/algorithm:vps/tau:0.9ms". Steps of the search have more.
constexpr std::ptrdiff_t k_parts_of_answer = 3;

/// Values that the paper's table of equal times prints, of vps and ist (lib/sixdof/scenario/README.md).
struct PaperValue {
  std::string_view scenario, algorithm, measure;
  double value;
};
constexpr std::array k_paper_values{
    PaperValue{"Ia", "vps", "sigma_F", 0.043},   PaperValue{"Ia", "ist", "sigma_F", 0.176},
    PaperValue{"II", "vps", "gamma_F_deg", 2.4}, PaperValue{"II", "ist", "gamma_F_deg", 7.64},
    PaperValue{"III", "vps", "sigma_T", 0.169},  PaperValue{"III", "ist", "sigma_T", 0.112},
    PaperValue{"III", "vps", "nu_T", 0.62},      PaperValue{"III", "ist", "nu_T", 1.12},
};

}  // namespace

DataTable response_errors_table(const Results& results, const std::vector<RowGroup>& groups) {
  DataTable table{.name = "response_errors",
                  .title = "Errors of responses against the exact ones, by overlap volume",
                  .columns = {"run", "pair", "measure", "algorithm", "percent", "error", "command", "worst_pose"},
                  .rows = {}};
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    if (row.query != "respond" || !row.percent || row.algorithm == "null") continue;
    for (const Measure& measure : k_response_errors) {
      const auto value = row.value(measure.value);
      if (!value) continue;
      table.rows.push_back({run_name(results, row.file), row.pair, std::string(measure.title), group.algorithm(),
                            *row.percent, *value, reproduction(row, results.files[row.file]),
                            row.outliers.command_of(measure.value)});
    }
  }
  return table;
}

DataTable scenario_measures_table(const Results& results, const std::vector<RowGroup>& groups) {
  DataTable table{.name = "scenario_measures",
                  .title = "Responses along the scenarios against the ideal of each algorithm's law",
                  .columns = {"run", "measure", "scenario", "algorithm", "value", "steps", "command"},
                  .rows = {}};
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    if (row.query != "scenario" || row.algorithm == "null") continue;
    for (const Measure& measure : k_scenario_measures) {
      const auto value = row.value(measure.value);
      if (!value) continue;
      table.rows.push_back({run_name(results, row.file), std::string(measure.title), row.scenario, group.algorithm(),
                            *value, cell_of(row.value("steps")),
                            fmt::format("sixdof quality --scenario {} --algorithm {}", row.scenario, row.algorithm)});
    }
  }
  return table;
}

DataTable frontier_table(const Results& results, const std::vector<RowGroup>& groups) {
  using Plot =
      std::tuple<int, std::string, std::string, std::string, std::string>;  // order, source, pair, run, measure
  std::map<Plot, std::vector<Point>> plots;
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    const bool is_point = row.query == "precision";
    const auto time = processor_time(group);
    if (!time || row.algorithm == "null" ||
        (!is_point && !(row.percent && (row.query == "respond" || row.query == "distance"))))
      continue;
    const std::string source = is_point ? row.question + ", every resolution"
                                        : fmt::format("{}, {} {:g} %", row.query, row.kind, *row.percent);
    for (const Measure& measure : k_frontier_errors) {
      const auto error = row.value(measure.value);
      if (!error) continue;
      const std::string name = measure.value;
      plots[{is_point                 ? 0
             : row.query == "respond" ? 1
                                      : 2,
             source, row.pair, run_name(results, row.file), measure.title}]
          .push_back({&row, source, in_microseconds(*time), *error, row.value(name + "_low"), row.value(name + "_high"),
                      row.outliers.command_of(name), is_ranked(group)});
    }
  }
  DataTable table{.name = "frontier",
                  .title = "Run time against error",
                  .columns = {"run", "pair", "measured", "measure", "algorithm", "settings", "time_us", "low_us",
                              "high_us", "error", "low", "high", "frontier", "command", "worst_pose"},
                  .rows = {}};
  for (auto& [plot, points] : plots) {
    mark_frontier(points);
    const auto& [order, source, pair, run, measure] = plot;
    for (const Point& point : points) {
      table.rows.push_back({run, pair, source, measure, point.row->algorithm, point.row->settings, point.us.value,
                            point.us.low, point.us.high, point.error, cell_of(point.low), cell_of(point.high),
                            std::string(point.leads ? "yes" : "no"),
                            reproduction(*point.row, results.files[point.row->file]), point.worst_pose});
    }
  }
  return table;
}

DataTable equal_time_table(const Results& results, const std::vector<RowGroup>& groups) {
  DataTable table{
      .name = "equal_time",
      .title = "Response quality at equal time",
      .columns = {"run", "scenario", "algorithm", "measure", "tau_ms", "mean_ms", "ours", "paper", "settings"},
      .rows = {}};
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    const bool is_answer = std::ranges::count(row.name, '/') == k_parts_of_answer;
    if (row.query != "equivalent" || !row.value("tau_ns") || !is_answer) continue;
    for (const char* const measure : {"sigma_F", "gamma_F_deg", "sigma_T", "gamma_T_deg", "nu_T"}) {
      const auto value = row.value(measure);
      if (!value) continue;
      const auto printed = std::ranges::find_if(k_paper_values, [&](const PaperValue& paper) {
        return paper.scenario == row.scenario && paper.algorithm == row.algorithm && paper.measure == measure;
      });
      table.rows.push_back({run_name(results, row.file), row.scenario, row.algorithm, std::string(measure),
                            row.count("tau_ns") / 1e6, row.count("measured_ns") / 1e6, *value,
                            printed == k_paper_values.end() ? Cell() : Cell(printed->value), row.settings});
    }
  }
  return table;
}

}  // namespace sixdof::report
