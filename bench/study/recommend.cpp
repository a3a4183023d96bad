#include "bench/study/recommend.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace sixdof::study {
namespace {

double tail_of(const Latency& latency, const std::string& tail) {
  return tail == "p99.9" ? *latency.p999 : tail == "p99" ? *latency.p99 : latency.max;
}

/// The highest percentile that every point has.
std::string common_tail(const std::vector<const PrecisionPoint*>& points) {
  const auto all = [&](auto has) {
    return std::ranges::all_of(points, [&](const auto* p) { return has(p->single->once); });
  };
  if (all([](const Latency& latency) { return latency.p999.has_value(); })) return "p99.9";
  if (all([](const Latency& latency) { return latency.p99.has_value(); })) return "p99";
  return "max";
}

}  // namespace

Recommendation recommend(const PrecisionStudy& study, double deadline_s) {
  std::vector<const PrecisionPoint*> points;
  for (const PrecisionPoint& point : study.points()) {
    if (point.measured() && point.single && !point.faulty() && point.metric(study.plan().error))
      points.push_back(&point);
  }
  Recommendation result{.tail = common_tail(points)};
  std::vector<Candidate> candidates;
  for (const PrecisionPoint* const point : points) {
    Candidate candidate{.point = point,
                        .tail_ns = tail_of(point->single->least, result.tail),
                        .tail_once_ns = tail_of(point->single->once, result.tail),
                        .error = *point->metric(study.plan().error)};
    candidate.keeps_deadline = candidate.tail_ns <= 1e9 * deadline_s;
    candidates.push_back(candidate);
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
    } else if (!result.second && candidate.point->algorithm != result.best->point->algorithm) {
      result.second = candidate;
    }
  }
  return result;
}

}  // namespace sixdof::study
