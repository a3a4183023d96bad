#include <sixdof/results/choice.h>

#include <algorithm>
#include <functional>
#include <utility>

#include <sixdof/results/fault.h>

namespace sixdof::results {
namespace {

/// A tail, and the metrics of it in one pass and of the least of three times.
struct Tail {
  const char *name, *once, *least;
};
constexpr Tail k_tails[] = {
    {"p99.9", "p999_ns", "p999_least_ns"}, {"p99", "p99_ns", "p99_least_ns"}, {"max", "max_ns", "max_least_ns"}};

}  // namespace

Choice choose(std::span<const Row> points, const std::string& error, double deadline_ns) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Row& point = points[i];
    if (own_faults(point).empty() && point.value("max_least_ns") && point.value("max_ns") && point.value(error)) {
      places.push_back(i);
    }
  }
  const auto has = [&](const Tail& tail) {
    return std::ranges::all_of(
        places, [&](std::size_t i) { return points[i].value(tail.least) && points[i].value(tail.once); });
  };
  const Tail& tail = *std::ranges::find_if(k_tails, has);  // all have the last
  Choice result{.tail = tail.name, .best = {}, .second = {}, .too_slow = {}};
  std::vector<Candidate> candidates;
  for (const std::size_t i : places) {
    const double tail_ns = points[i].count(tail.least);
    candidates.push_back({i, tail_ns, points[i].count(tail.once), *points[i].estimate(error), tail_ns <= deadline_ns});
  }
  // Of equal errors, rounding aside, the faster one.
  const auto key = [](const Candidate& c) {
    return std::pair(c.error.value <= k_rounding ? 0.0 : c.error.value, c.tail_ns);
  };
  std::ranges::stable_sort(candidates, std::less<>(), key);
  for (const Candidate& candidate : candidates) {
    if (!candidate.keeps_deadline) {
      if (!result.best) result.too_slow.push_back(candidate);
    } else if (!result.best) {
      result.best = candidate;
    } else if (!result.second &&
               points[candidate.place].fields.algorithm != points[result.best->place].fields.algorithm) {
      result.second = candidate;
    }
  }
  return result;
}

}  // namespace sixdof::results
