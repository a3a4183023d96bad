#include <algorithm>
#include <set>

#include <fmt/format.h>

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

std::size_t PrecisionStudy::undecided() const {
  const std::vector<bool> open = uncertain(tradeoffs().tradeoffs);
  return static_cast<std::size_t>(std::ranges::count(open, true));
}

StudyRow PrecisionStudy::row(const PrecisionPoint& point, OnFrontier on) const {
  const std::string question(to_string(sample_.question));
  StudyRow row{
      .name = fmt::format("precision/{}/algorithm:{}/pair:{}", question, point.algorithm->traits().name, pair_.pair),
      .fields = {.query = "precision",
                 .algorithm = point.algorithm->traits().name,
                 .settings = point.sweep.settings.to_string(),
                 .pair = pair_.pair,
                 .question = question,
                 .configurations = sample_.poses.size()}};
  for (std::string assignment : point.sweep.assignments) {
    std::ranges::replace(assignment, '=', ':');
    row.name += "/" + assignment;
  }
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
  row.counters.emplace_back("timing_rounds", static_cast<double>(point.times.count()));
  row.counters.emplace_back("on_frontier", on.overall ? 1.0 : 0.0);
  row.counters.emplace_back("on_own_frontier", on.own ? 1.0 : 0.0);
  return row;
}

std::vector<StudyRow> PrecisionStudy::rows() const {
  std::vector<StudyRow> list;
  const std::vector<OnFrontier> on = frontiers();
  for (std::size_t i = 0; i < points_.size(); ++i) list.push_back(row(points_[i], on[i]));
  return list;
}

std::vector<ErrorOrder> error_orders(const PrecisionStudy& study) {
  std::vector<ErrorOrder> orders;
  for (const Algorithm* const algorithm : study.plan().algorithms) {
    std::string parameter;
    std::vector<double> resolutions, errors;
    for (const PrecisionPoint& point : study.points()) {
      if (point.algorithm != algorithm || !point.measured() || point.faulty() || point.sweep.assignments.empty())
        continue;
      const std::string& first = point.sweep.assignments.front();
      parameter = first.substr(0, first.find('='));
      const auto error = point.metric(study.plan().error);
      const double resolution = point.sweep.settings.number(parameter);
      if (!error || !(error->value > k_rounding)) continue;
      resolutions.push_back(resolution);
      errors.push_back(error->value);
    }
    const std::set<double> distinct(resolutions.begin(), resolutions.end());
    if (distinct.size() != resolutions.size()) continue;  // a grid of several parameters
    if (const auto fit = fit_order(resolutions, errors)) {
      orders.push_back({algorithm->traits().name, parameter, fit->order, fit->standard_error, errors.size()});
    }
  }
  return orders;
}

}  // namespace sixdof::study
