#include "bench/study/frontier.h"

#include <algorithm>

namespace sixdof::study {
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

}  // namespace sixdof::study
