#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include <sixdof/measure/direction.h>
#include <sixdof/process/remote_algorithm.h>
#include "bench/study/order_fit.h"
#include "bench/study/precision.h"

namespace sixdof::study {

std::vector<results::OnFrontier> PrecisionStudy::frontiers() const {
  return results::frontiers(measured_rows(), plan_.cost, plan_.error);
}

std::vector<std::size_t> PrecisionStudy::uncertain_places() const {
  std::vector<std::size_t> places;
  std::vector<results::Tradeoff> tradeoffs;
  const std::vector<results::Row> rows = measured_rows();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto tradeoff = results::tradeoff_of(rows[i], plan_.cost, plan_.error);
    if (!tradeoff) continue;
    places.push_back(i);
    tradeoffs.push_back(*tradeoff);
  }
  const std::vector<bool> open = results::uncertain(tradeoffs);
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (open[k]) result.push_back(places[k]);
  }
  return result;
}

std::vector<std::optional<double>> PrecisionStudy::angles_to_finest() const {
  std::map<const Algorithm*, const PrecisionPoint*> finest;
  for (const PrecisionPoint& point : points_) {
    if (point.measured() && !point.faulty()) finest[point.algorithm] = &point;
  }
  std::vector<std::optional<double>> angles(points_.size());
  if (sample_.question != bench::QueryKind::respond) return angles;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PrecisionPoint* const best = finest[points_[i].algorithm];
    if (!points_[i].measured() || best == nullptr || best == &points_[i]) continue;
    angles[i] = direction_error(best->errors.forces, points_[i].errors.forces).gamma_degrees;
  }
  return angles;
}

std::size_t PrecisionStudy::undecided() const { return uncertain_places().size(); }

results::Row PrecisionStudy::row(const PrecisionPoint& point) const {
  const std::string question(to_string(sample_.question));
  results::Row row{
      .name = fmt::format("precision/{}/algorithm:{}/pair:{}", question, point.algorithm->traits().name, pair_.pair),
      .fields = {.query = "precision",
                 .algorithm = point.algorithm->traits().name,
                 .settings = point.sweep.settings.to_string(),
                 .pair = pair_.pair,
                 .runtime = point.algorithm->traits().runtime,
                 .isolated = is_isolated(*point.algorithm),
                 .approximates = point.algorithm->traits().approximates,
                 .question = question,
                 .configurations = sample_.poses.size()}};
  for (std::string assignment : point.sweep.assignments) {
    std::ranges::replace(assignment, '=', ':');
    row.name += "/" + assignment;
  }
  if (!sample_.motions.poses.empty()) row.name += "/order:motion";
  if (!point.measured()) {
    row.error = "left out: " + (point.left_out.empty() ? "the run was interrupted" : point.left_out);
    return row;
  }
  row.label = point.errors.failed > 0 ? "first failure: " + point.errors.first_failure : std::string();
  const auto add = [&](const std::string& name, const std::optional<Estimate>& estimate) {
    if (!estimate) return;
    row.values[name] = estimate->value;
    if (estimate->low == estimate->high) return;
    row.values[name + "_low"] = estimate->low;
    row.values[name + "_high"] = estimate->high;
  };
  add(results::k_processor_mean, point.times.cpu_ns());
  add(results::k_wall_mean, point.times.wall_ns());
  for (const auto& [name, estimate] : point.errors.values) add(name, estimate);
  for (const char* const name : {"bytes", "prepare_ns", "p50_ns", "p99_ns", "p999_ns", "max_ns", "over_1ms",
                                 "p99_least_ns", "p999_least_ns", "max_least_ns", "late", "timed", "idle_late"}) {
    add(name, point.metric(name));
  }
  row.values["timing_rounds"] = static_cast<double>(point.times.count());
  return row;
}

std::vector<results::Row> PrecisionStudy::measured_rows() const {
  std::vector<results::Row> list;
  for (const PrecisionPoint& point : points_) list.push_back(row(point));
  return list;
}

std::vector<results::Row> PrecisionStudy::rows() const {
  std::vector<results::Row> list = measured_rows();
  const std::vector<results::OnFrontier> on = results::frontiers(list, plan_.cost, plan_.error);
  const auto to_finest = angles_to_finest();
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].error.empty()) continue;
    if (to_finest[i]) list[i].values["gamma_F_finest_deg"] = *to_finest[i];
    list[i].values["on_frontier"] = on[i].overall ? 1.0 : 0.0;
    list[i].values["on_own_frontier"] = on[i].own ? 1.0 : 0.0;
  }
  return list;
}

namespace {

/// The order of one error of an algorithm. @param errors per point of the study, empty where there is none
std::optional<ErrorOrder> order_of(const PrecisionStudy& study, const Algorithm& algorithm, const std::string& metric,
                                   const std::vector<std::optional<double>>& errors) {
  ErrorOrder order{.algorithm = algorithm.traits().name, .metric = metric};
  std::vector<double> resolutions, values;
  for (std::size_t i = 0; i < study.points().size(); ++i) {
    const PrecisionPoint& point = study.points()[i];
    const auto& assignments = point.sweep.assignments;
    if (point.algorithm != &algorithm || assignments.empty() || point.faulty() || !errors[i]) continue;
    if (!(*errors[i] > results::k_rounding)) continue;
    order.parameter = assignments.front().substr(0, assignments.front().find('='));
    resolutions.push_back(point.sweep.settings.number(order.parameter));
    values.push_back(*errors[i]);
  }
  const std::set<double> distinct(resolutions.begin(), resolutions.end());
  const auto fit = fit_order(resolutions, values);
  if (distinct.size() != resolutions.size() || !fit) return std::nullopt;  // e.g. a grid of several parameters
  order.order = fit->order;
  order.standard_error = fit->standard_error;
  order.points = values.size();
  return order;
}

}  // namespace

std::vector<ErrorOrder> error_orders(const PrecisionStudy& study) {
  std::vector<std::optional<double>> errors;
  for (const PrecisionPoint& point : study.points()) {
    const auto error = point.measured() ? point.metric(study.plan().error) : std::nullopt;
    errors.push_back(error ? std::optional(error->value) : std::nullopt);
  }
  std::vector<ErrorOrder> orders;
  for (const Algorithm* const algorithm : study.plan().algorithms) {
    for (const auto& order : {order_of(study, *algorithm, study.plan().error, errors),
                              order_of(study, *algorithm, "gamma_F_finest_deg", study.angles_to_finest())}) {
      if (order) orders.push_back(*order);
    }
  }
  return orders;
}

}  // namespace sixdof::study
