#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include <sixdof/measure/direction.h>
#include <sixdof/process/remote_algorithm.h>
#include "bench/study/order_fit.h"
#include "bench/study/precision.h"

namespace sixdof::study {

PrecisionStudy::PointTradeoffs PrecisionStudy::tradeoffs() const {
  PointTradeoffs all;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto cost = points_[i].metric(plan_.cost), error = points_[i].metric(plan_.error);
    if (!points_[i].measured() || !cost || !error) continue;
    all.places.push_back(i);
    all.tradeoffs.push_back({*cost, *error, points_[i].faulty()});
  }
  return all;
}

std::vector<PrecisionStudy::OnFrontier> PrecisionStudy::frontiers() const {
  const PointTradeoffs all = tradeoffs();
  std::vector<OnFrontier> on(points_.size());
  const std::vector<bool> overall = frontier(all.tradeoffs);
  for (std::size_t k = 0; k < overall.size(); ++k) on[all.places[k]].overall = overall[k];
  for (const Algorithm* const algorithm : plan_.algorithms) {
    PointTradeoffs own;
    for (std::size_t k = 0; k < all.places.size(); ++k) {
      if (points_[all.places[k]].algorithm != algorithm) continue;
      own.places.push_back(all.places[k]);
      own.tradeoffs.push_back(all.tradeoffs[k]);
    }
    const std::vector<bool> own_frontier = frontier(own.tradeoffs);
    for (std::size_t k = 0; k < own_frontier.size(); ++k) on[own.places[k]].own = own_frontier[k];
  }
  return on;
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

std::size_t PrecisionStudy::undecided() const {
  const std::vector<bool> open = uncertain(tradeoffs().tradeoffs);
  return static_cast<std::size_t>(std::ranges::count(open, true));
}

StudyRow PrecisionStudy::row(const PrecisionPoint& point, OnFrontier on, std::optional<double> to_finest) const {
  const std::string question(to_string(sample_.question));
  StudyRow row{
      .name = fmt::format("precision/{}/algorithm:{}/pair:{}", question, point.algorithm->traits().name, pair_.pair),
      .fields = {.query = "precision",
                 .algorithm = point.algorithm->traits().name,
                 .settings = point.sweep.settings.to_string(),
                 .pair = pair_.pair,
                 .isolated = is_isolated(*point.algorithm),
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
  row.cpu_time_ns = point.times.cpu_ns().value;
  row.real_time_ns = point.times.wall_ns().value;
  row.label = point.errors.failed > 0 ? "first failure: " + point.errors.first_failure : std::string();
  const auto add = [&](const std::string& name, const Estimate& estimate) {
    row.counters.emplace_back(name, estimate.value);
    if (estimate.low == estimate.high) return;
    row.counters.emplace_back(name + "_low", estimate.low);
    row.counters.emplace_back(name + "_high", estimate.high);
  };
  row.counters.emplace_back("cpu_time_low", point.times.cpu_ns().low);
  row.counters.emplace_back("cpu_time_high", point.times.cpu_ns().high);
  for (const auto& [name, estimate] : point.errors.values) add(name, estimate);
  for (const char* const name : {"bytes", "prepare_ns", "p50_ns", "p99_ns", "p999_ns", "max_ns", "over_1ms",
                                 "p99_least_ns", "p999_least_ns", "max_least_ns"}) {
    if (const auto value = point.metric(name)) add(name, *value);
  }
  if (to_finest) row.counters.emplace_back("gamma_F_finest_deg", *to_finest);
  row.counters.emplace_back("timing_rounds", static_cast<double>(point.times.count()));
  row.counters.emplace_back("on_frontier", on.overall ? 1.0 : 0.0);
  row.counters.emplace_back("on_own_frontier", on.own ? 1.0 : 0.0);
  return row;
}

std::vector<StudyRow> PrecisionStudy::rows() const {
  std::vector<StudyRow> list;
  const std::vector<OnFrontier> on = frontiers();
  const auto to_finest = angles_to_finest();
  for (std::size_t i = 0; i < points_.size(); ++i) list.push_back(row(points_[i], on[i], to_finest[i]));
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
    if (!(*errors[i] > k_rounding)) continue;
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
