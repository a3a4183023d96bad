#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <map>

#include <sixdof/report/tables.h>
#include <sixdof/results/frontier.h>
#include <sixdof/results/paper.h>

namespace sixdof::report {
namespace {

/// What a measure is called in a figure, with its unit.
struct Measure {
  const char* value;
  const char* title;
};

constexpr std::array k_response_errors{
    Measure{"gamma_own_F_deg", "force direction to the own law, mean (degrees)"},
    Measure{"magnitude_error_own_F", "force magnitude to the own law (fraction)"},
    Measure{"gamma_own_T_deg", "torque direction to the own law, mean (degrees)"},
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
    Measure{"nu_direction_F", "force direction's spectrum: nu, ideal 1"},
    Measure{"nu_direction_T", "torque direction's spectrum: nu, ideal 1"},
    Measure{"sigma_q", "penalty: sigma (paper's formula 1)"},
    Measure{"noise_F", "force noise above 50 Hz (energy)"},
    Measure{"noise_T", "torque noise above 50 Hz (energy)"},
    Measure{"leakage", "leakage: unwanted over wanted part"},
    Measure{"jump_F", "largest jump of the force, over its peak"},
    Measure{"jump_T", "largest jump of the torque, over its peak"},
    Measure{"loop_work", "work on a closed path (energy created)"},
    Measure{"misses", "steps without a force (tunnelling)"},
    Measure{"lag", "lag (steps)"},
};

constexpr std::array k_frontier_errors{
    Measure{"gamma_own_F_deg", "force direction to the own law, mean (degrees)"},
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

/// What a point of the frontier costs.
struct Cost {
  const char* value;
  const char* title;
  double unit;  ///< Of the title.
};
constexpr std::array k_costs{
    Cost{k_processor_mean, "mean processor time of a query, µs", 1e3},
    Cost{"p99_ns", "99th percentile of query times, µs", 1e3},
    Cost{"bytes", "memory, bytes", 1.0},
    Cost{"prepare_ns", "time to prepare, s", 1e9},
};

/// Of the plots of the frontier: those of studies first, then responses, then distances.
struct Plot {
  int order;
  std::string measured, pair, run;
  std::size_t cost;  ///< Place in k_costs.
  std::string measure;
  auto operator<=>(const Plot&) const = default;
};

/// A row in a plot.
struct Point {
  const RowGroup* group;
  Tradeoff tradeoff;
  std::string worst_pose;
};

/// A plot for each cost and error that the group has; none for a group that answers neither with a distance nor with a
/// response.
void add_points(const Results& results, const RowGroup& group, std::map<Plot, std::vector<Point>>& plots) {
  const RowFields& fields = group.fields();
  const bool is_study = fields.query == "precision", is_response = fields.query == "respond";
  const bool is_query = fields.bucket && (is_response || fields.query == "distance");
  if (fields.algorithm == "null" || (!is_study && !is_query)) return;
  std::string measured = is_study ? fields.question + ", every resolution" : fields.query + ", " + place_of(fields);
  if (group.is_special()) measured += group.algorithm().substr(fields.algorithm.size());
  for (std::size_t cost = 0; cost < k_costs.size(); ++cost) {
    const bool is_mean = k_costs[cost].value == std::string(k_processor_mean);
    const auto x = is_mean ? group.mean_time() : group.estimate(k_costs[cost].value);
    for (const Measure& measure : k_frontier_errors) {
      const auto y = group.estimate(measure.value);
      if (!x || !y) continue;
      plots[{is_study      ? 0
             : is_response ? 1
                           : 2,
             measured, bodies_of(fields), run_name(results, group.row().file), cost, measure.title}]
          .push_back(
              {&group, {*x, *y, !mistakes(group.faults).empty()}, group.row().outliers.command_of(measure.value)});
    }
  }
}

/// Slashes in the name of an answer: "equivalent/scenario:Ia/algorithm:vps/tau:0.9ms". Steps of the search have more.
constexpr std::ptrdiff_t k_parts_of_answer = 3;

}  // namespace

DataTable response_errors_table(const Results& results, const std::vector<RowGroup>& groups) {
  DataTable table{
      .name = "response_errors",
      .title = "Errors of responses against the exact ones and against each algorithm's own law, by overlap volume",
      .columns = {"run", "pair", "measure", "algorithm", "law", "percent", "error", "command", "worst_pose"},
      .rows = {}};
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    if (row.fields.query != "respond" || !row.fields.bucket || row.fields.algorithm == "null") continue;
    for (const Measure& measure : k_response_errors) {
      const auto value = group.value(measure.value);
      if (!value) continue;
      table.rows.push_back({run_name(results, row.file), bodies_of(row.fields), std::string(measure.title),
                            group.algorithm(), row.fields.law, row.fields.bucket->percent, *value,
                            reproduction(row, results.files[row.file]), row.outliers.command_of(measure.value)});
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
    if (row.fields.query != "scenario" || row.fields.algorithm == "null") continue;
    for (const Measure& measure : k_scenario_measures) {
      const auto value = group.value(measure.value);
      if (!value) continue;
      table.rows.push_back({run_name(results, row.file), std::string(measure.title), row.fields.scenario,
                            group.algorithm(), *value, cell_of(group.value("steps")),
                            reproduction(row, results.files[row.file])});
    }
  }
  return table;
}

DataTable frontier_table(const Results& results, const std::vector<RowGroup>& groups) {
  DataTable table{
      .name = "frontier",
      .title = "Cost against error",
      .columns = {"run", "pair", "measured", "cost", "measure", "algorithm", "settings", "spent", "spent_low",
                  "spent_high", "error", "low", "high", "frontier", "faults", "command", "worst_pose"},
      .rows = {}};
  std::map<Plot, std::vector<Point>> plots;
  for (const RowGroup& group : groups) add_points(results, group, plots);
  for (const auto& [plot, points] : plots) {
    std::vector<Tradeoff> tradeoffs;
    for (const Point& point : points) tradeoffs.push_back(point.tradeoff);
    const std::vector<bool> leads = frontier(tradeoffs);
    const auto& [value, title, unit] = k_costs[plot.cost];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto& [cost, error, faulty] = points[i].tradeoff;
      const Row& row = points[i].group->row();
      const bool has_bounds = error.low < error.high;
      const auto bound = [has_bounds](double at) { return has_bounds ? Cell(at) : Cell(); };
      table.rows.push_back({plot.run, plot.pair, plot.measured, std::string(title), plot.measure, row.fields.algorithm,
                            row.fields.settings, cost.value / unit, cost.low / unit, cost.high / unit, error.value,
                            bound(error.low), bound(error.high), std::string(leads[i] ? "yes" : "no"),
                            to_string(mistakes(points[i].group->faults)), reproduction(row, results.files[row.file]),
                            points[i].worst_pose});
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
    if (row.fields.query != "equivalent" || !group.value("tau_ns") || !is_answer) continue;
    for (const char* const measure : {"sigma_F", "gamma_F_deg", "sigma_T", "gamma_T_deg", "nu_T"}) {
      const auto value = group.value(measure);
      if (!value) continue;
      table.rows.push_back({run_name(results, row.file), row.fields.scenario, row.fields.algorithm,
                            std::string(measure), group.count("tau_ns") / 1e6, group.count("measured_ns") / 1e6, *value,
                            cell_of(paper_value(row.fields.scenario, row.fields.algorithm, measure)),
                            row.fields.settings});
    }
  }
  return table;
}

}  // namespace sixdof::report
