#include <sixdof/results/frontier.h>

#include <algorithm>
#include <map>
#include <utility>

#include <sixdof/results/fault.h>

namespace sixdof::results {
namespace {

bool clearly_below(const Estimate& a, const Estimate& b) { return a.high < b.low && b.high > k_rounding; }

bool not_above(const Estimate& a, const Estimate& b) { return a.value <= b.value || a.value <= k_rounding; }

}  // namespace

bool dominates(const Tradeoff& p, const Tradeoff& q) {
  if (p.faulty) return false;
  return (clearly_below(p.cost, q.cost) && not_above(p.error, q.error)) ||
         (clearly_below(p.error, q.error) && not_above(p.cost, q.cost));
}

std::vector<bool> frontier(std::span<const Tradeoff> points) {
  std::vector<bool> on;
  for (const Tradeoff& point : points) {
    on.push_back(!point.faulty && std::ranges::none_of(points, [&](const Tradeoff& p) { return dominates(p, point); }));
  }
  return on;
}

std::vector<bool> uncertain(std::span<const Tradeoff> points) {
  const std::vector<bool> on = frontier(points);
  std::vector<bool> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; on[i] && j < points.size(); ++j) {
      const bool another_error = points[i].error.value != points[j].error.value;
      if (j != i && on[j] && another_error && overlap(points[i].cost, points[j].cost)) result[i] = true;
    }
  }
  return result;
}

std::optional<Tradeoff> tradeoff_of(const Row& point, const std::string& cost, const std::string& error) {
  const auto x = point.estimate(cost), y = point.estimate(error);
  if (!point.error.empty() || !x || !y) return std::nullopt;
  return Tradeoff{*x, *y, !mistakes(own_faults(point)).empty()};
}

std::vector<OnFrontier> frontiers(std::span<const Row> points, const std::string& cost, const std::string& error) {
  std::vector<OnFrontier> on(points.size());
  std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> places;  // interpreter, algorithm; all: ""
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!tradeoff_of(points[i], cost, error)) continue;
    const std::string interpreter = interpreter_of(points[i].fields);
    places[{interpreter, ""}].push_back(i);
    places[{interpreter, points[i].fields.algorithm}].push_back(i);
  }
  for (const auto& [key, list] : places) {
    std::vector<Tradeoff> tradeoffs;
    for (const std::size_t i : list) tradeoffs.push_back(*tradeoff_of(points[i], cost, error));
    const std::vector<bool> leads = frontier(tradeoffs);
    for (std::size_t k = 0; k < list.size(); ++k)
      (key.second.empty() ? on[list[k]].overall : on[list[k]].own) = leads[k];
  }
  return on;
}

}  // namespace sixdof::results
