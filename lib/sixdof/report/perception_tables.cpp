#include <algorithm>
#include <array>
#include <string>

#include <Eigen/Core>

#include <sixdof/measure/perception.h>
#include <sixdof/measure/perception_thresholds.h>
#include <sixdof/report/tables.h>

namespace sixdof::report {
namespace {

/// Update rates in Hz: the usual haptic loop; what textures need to feel stable. Choi and Tan, "Effect of update rate
/// on perceived instability of virtual haptic texture" (IROS 2004), recommend 5 to 10 kHz. Longer delays:
/// k_delay_changes_ms.
constexpr double k_loop_hz = 1e3, k_texture_hz = 5e3;

std::vector<Eigen::Vector3d> vectors_of(const Series::Vectors& values) {
  std::vector<Eigen::Vector3d> vectors;
  for (const auto& v : values) vectors.emplace_back(v[0], v[1], v[2]);
  return vectors;
}

void add_scores(const Series& series, const std::string& wrench, const Series::Vectors& ideal_values,
                const Series::Vectors& measured_values, DataTable& table) {
  const std::vector<Eigen::Vector3d> ideal = vectors_of(ideal_values), measured = vectors_of(measured_values);
  const auto fit = fit_gain(ideal, measured);
  const auto scores = fit ? perceptual_scores(ideal, measured, fit->gain, series.rate_hz) : std::nullopt;
  if (!scores) return;
  const std::array<std::pair<const char*, double>, 5> components{{{"magnitude", scores->magnitude},
                                                                  {"direction", scores->direction},
                                                                  {"vibration", scores->vibration},
                                                                  {"jump", scores->jump},
                                                                  {"pooled", scores->pooled()}}};
  for (const auto& [name, score] : components) {
    table.rows.push_back({series.scenario, wrench, series.algorithm, std::string(name), score});
  }
}

std::string words_of(double rate_hz) {
  constexpr double k_ms = 1e3;  // per second
  if (rate_hz >= k_texture_hz) return "5 kHz: textures feel stable";
  if (rate_hz >= k_loop_hz) return "1 kHz: the usual haptic loop";
  if (k_ms / rate_hz > perception::k_delay_noticed_ms) return "less than 1 kHz; the delay is noticed";
  return k_ms / rate_hz > perception::k_delay_changes_ms ? "less than 1 kHz; the delay changes how textures feel"
                                                         : "less than 1 kHz";
}

}  // namespace

DataTable perception_table(const std::vector<Series>& all) {
  DataTable table{.name = "perception",
                  .title = "Errors along the paths in units of what can just be felt",
                  .columns = {"scenario", "wrench", "algorithm", "component", "score"},
                  .rows = {}};
  for (const Series& series : all) {
    add_scores(series, "force", series.ideal_force, series.force, table);
    add_scores(series, "torque", series.ideal_torque, series.torque, table);
  }
  return table;
}

DataTable perception_thresholds_table(const std::vector<Series>& all) {
  DataTable table{.name = "perception_thresholds",
                  .title = "What scores 1",
                  .columns = {"component", "threshold", "source"},
                  .rows = {}};
  if (all.empty()) return table;
  for (const auto& [score, unit, source] : perception::k_thresholds) {
    table.rows.push_back({std::string(score), std::string(unit), std::string(source)});
  }
  return table;
}

DataTable update_rates_table(const Results& results, const std::vector<RowGroup>& groups) {
  DataTable table{.name = "update_rates",
                  .title = "Update rates at the 99th percentile of query times",
                  .columns = {"run", "pair", "algorithm", "percent", "tail_us", "rate_hz", "keeps",
                              "stiffness_per_damping", "command", "worst_pose"},
                  .rows = {}};
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    if (row.fields.query != "respond" || !row.fields.bucket || row.fields.algorithm == "null") continue;
    if (row.fields.bucket->kind != BucketKind::volume) continue;
    const auto p99 = group.value("p99_ns"), longest = group.value("max_ns");
    const double tail_ns = p99.value_or(longest.value_or(0.0));
    if (!(tail_ns > 0.0)) continue;
    const double rate = 1e9 / tail_ns;
    table.rows.push_back({run_name(results, row.file), bodies_of(row.fields), group.algorithm(),
                          row.fields.bucket->percent, tail_ns / 1e3, rate, words_of(rate), 2.0 * rate,
                          reproduction(row, results.files[row.file]), row.outliers.command_of("max_ns")});
  }
  return table;
}

}  // namespace sixdof::report
