#include "bench/cli/precision_table.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/measure/metrics.h>

namespace sixdof::cli {
namespace {

using results::Estimate;
using study::PrecisionPoint;
using study::PrecisionStudy;

/// Metrics shown beside the plane of the frontier, by the question.
std::vector<std::string> shown_metrics(bench::QueryKind question) {
  if (question == bench::QueryKind::collide) return {"false_positives", "false_negatives", "touching_yes"};
  if (question == bench::QueryKind::distance) return {"error_mean", "error_max", "too_small", "too_large"};
  return {"gamma_F_p95_deg", "gamma_max_F_deg", "gamma_T_deg", "magnitude_error_F", "gain_F", "misses"};
}

std::string number(double value) {
  if (value == 0.0) return "0";
  return fmt::format("{:.3g}", value);
}

/// "12.3 [12.1, 12.6]"; the interval only where there is one.
std::string with_interval(const std::optional<Estimate>& estimate, double factor = 1.0) {
  if (!estimate) return "-";
  const std::string value = number(factor * estimate->value);
  if (estimate->low == estimate->high) return value;
  return fmt::format("{} [{}, {}]", value, number(factor * estimate->low), number(factor * estimate->high));
}

std::string title_of_cost(const std::string& metric) {
  if (metric == "cpu_time") return "processor, us";
  if (metric == "real_time") return "wall clock, us";
  return metric;
}

double factor_of_cost(const std::string& metric) { return metric == "cpu_time" || metric == "real_time" ? 1e-3 : 1.0; }

std::string settings_of(const PrecisionPoint& point) {
  return fmt::format("{}", fmt::join(point.sweep.assignments, " "));
}

std::string interpreter_of(const PrecisionPoint& point) {
  const Traits& traits = point.algorithm->traits();
  return results::interpreter_of({.query = "precision", .algorithm = traits.name, .runtime = traits.runtime});
}

/// "vps", "coal (python)".
std::string label_of(const PrecisionPoint& point) {
  const std::string name = point.algorithm->traits().name, interpreter = interpreter_of(point);
  return interpreter.empty() ? name : fmt::format("{} ({})", name, interpreter);
}

void add_notes(const PrecisionStudy& study, Sheet& sheet) {
  for (const study::ErrorOrder& order : study::error_orders(study)) {
    sheet.notes.push_back(fmt::format("{} of {}: proportional to {}^{:.2f} (standard error {:.2f}, {} points)",
                                      order.metric, order.algorithm, order.parameter, order.order, order.standard_error,
                                      order.points));
  }
  for (const PrecisionPoint& point : study.points()) {
    const std::string name = fmt::format("{} {}", point.algorithm->traits().name, settings_of(point));
    if (!point.left_out.empty()) sheet.notes.push_back(fmt::format("left out: {}: {}", name, point.left_out));
    if (point.measured() && point.errors.failed > 0) {
      sheet.notes.push_back(fmt::format("! {}: {} of {} failed, first: {}", name, point.errors.failed,
                                        study.sample().asked(), point.errors.first_failure));
    }
  }
  if (std::ranges::any_of(study.points(), [](const PrecisionPoint& point) { return !interpreter_of(point).empty(); })) {
    sheet.notes.emplace_back("algorithms of Python and Node have frontiers of their own");
  }
  if (const std::size_t undecided = study.undecided(); undecided > 0) {
    sheet.notes.push_back(fmt::format("{} points of the frontier have costs whose intervals overlap", undecided));
  }
}

}  // namespace

Sheet precision_sheet(const PrecisionStudy& study) {
  std::vector<std::string> buckets;
  for (const BucketKey key : study.sample().buckets) buckets.push_back(key.name());
  Sheet sheet{
      .title = fmt::format("{}: {}, {} configurations of {}; [95 % interval], * frontier, + of the algorithm, ! fault",
                           study.pair().pair, to_string(study.sample().question), study.sample().poses.size(),
                           fmt::join(buckets, " "))};
  const std::string& cost = study.plan().cost;
  const std::string& error = study.plan().error;
  sheet.columns = {{.title = "", .left = true},         {.title = "algorithm", .left = true},
                   {.title = "settings", .left = true}, {.title = "prepare, s"},
                   {.title = title_of_cost(cost)},      {.title = error}};
  std::vector<std::string> others = shown_metrics(study.sample().question);
  std::erase(others, error);
  for (const std::string& metric : others) sheet.columns.push_back({.title = metric});
  const auto to_finest = study.angles_to_finest();
  const bool shows_finest = std::ranges::any_of(to_finest, [](const auto& angle) { return angle.has_value(); });
  if (shows_finest) sheet.columns.push_back({.title = "gamma_F_finest_deg"});
  const auto on = study.frontiers();
  for (std::size_t i = 0; i < study.points().size(); ++i) {
    const PrecisionPoint& point = study.points()[i];
    if (!point.measured()) continue;
    std::vector<std::string> line{
        point.faulty() ? "!" : fmt::format("{}{}", on[i].overall ? "*" : "", on[i].own ? "+" : ""),
        label_of(point),
        settings_of(point),
        fmt::format("{:.2f}", point.prepare_s),
        with_interval(point.metric(cost), factor_of_cost(cost)),
        with_interval(point.metric(error))};
    for (const std::string& metric : others) {
      const auto value = point.metric(metric);
      line.push_back(value ? number(value->value) : "-");
    }
    if (shows_finest) line.push_back(to_finest[i] ? number(*to_finest[i]) : "-");
    sheet.lines.push_back(std::move(line));
  }
  add_notes(study, sheet);
  return sheet;
}

std::vector<std::string> gain_spreads(const std::vector<const PrecisionStudy*>& studies) {
  std::map<std::string, std::vector<double>> gains;
  std::vector<std::string> order;
  for (const PrecisionStudy* const study : studies) {
    for (const PrecisionPoint& point : study->points()) {
      const auto gain = point.metric("gain_F");
      if (!point.measured() || !gain || !(gain->value > 0.0)) continue;
      const std::string name = fmt::format("{} {}", point.algorithm->traits().name, settings_of(point));
      if (!gains.contains(name)) order.push_back(name);
      gains[name].push_back(gain->value);
    }
  }
  std::vector<std::string> lines;
  for (const std::string& name : order) {
    const auto& values = gains[name];
    if (values.size() < 2) continue;
    const auto [least, largest] = std::ranges::minmax(values);
    lines.push_back(fmt::format("gain_F of {} over {} pairs: {} to {}, ratio {:.3g}", name, values.size(),
                                number(least), number(largest), largest / least));
  }
  return lines;
}

}  // namespace sixdof::cli
