#include "bench/study/precision.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/process/remote_algorithm.h>
#include "bench/common/duration.h"
#include "bench/common/interrupt.h"

namespace sixdof::study {
namespace {

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::optional<Estimate> percentile(const std::optional<double>& value) {
  return value ? std::optional(Estimate::exactly(*value)) : std::nullopt;
}

}  // namespace

std::vector<std::string> cost_metrics() {
  return {"cpu_time", "real_time",    "bytes",         "prepare_ns",   "p50_ns", "p99_ns",
          "p999_ns",  "p99_least_ns", "p999_least_ns", "max_least_ns", "max_ns", "over_1ms"};
}

std::vector<results::Fault> PrecisionPoint::faults(std::size_t asked) const {
  results::Row row{.name = {}, .fields = {.query = "precision", .algorithm = {}, .configurations = asked}};
  for (const auto& [name, estimate] : errors.values) row.values[name] = estimate.value;
  return results::own_faults(row);
}

std::optional<Estimate> PrecisionPoint::metric(const std::string& name) const {
  if (name == "cpu_time") return times.cpu_ns();
  if (name == "real_time") return times.wall_ns();
  if (name == "bytes") return Estimate::exactly(static_cast<double>(bytes));
  if (name == "prepare_ns") return Estimate::exactly(1e9 * prepare_s);
  if (single) {
    if (name == "p50_ns") return Estimate::exactly(single->once.p50);
    if (name == "p99_ns") return percentile(single->once.p99);
    if (name == "p999_ns") return percentile(single->once.p999);
    if (name == "max_ns") return Estimate::exactly(single->once.max);
    if (name == "late") return Estimate::exactly(static_cast<double>(single->late));
    if (name == "timed") return Estimate::exactly(static_cast<double>(single->timed));
    if (name == "idle_late") return Estimate::exactly(static_cast<double>(single->idle_late));
    if (name == "over_1ms") return Estimate::exactly(single->once.over_deadline);
    if (name == "p99_least_ns") return percentile(single->least.p99);
    if (name == "p999_least_ns") return percentile(single->least.p999);
    if (name == "max_least_ns") return Estimate::exactly(single->least.max);
  }
  const auto found = errors.values.find(name);
  return found == errors.values.end() ? std::nullopt : std::optional(found->second);
}

StudySample draw_affordable_sample(const PrecisionPlan& plan, bench::PairCache& cache, const CatalogueEntry& pair,
                                   std::size_t count) {
  // A query of the finest point of a sweep takes some k_finer times as long as one of the coarsest, their mean half.
  constexpr double k_finer = 8.0;
  constexpr double k_share = 0.5;  // of the budget; the rest is for preparation and further rounds
  constexpr std::size_t k_trial = 8;
  if (std::isinf(plan.budget_s)) return draw_sample(cache, pair, plan.question, pair.buckets, count);
  const StudySample trial = draw_sample(cache, pair, plan.question, pair.buckets, k_trial);
  double seconds_each = 0.0;  // of a configuration, over all points and rounds
  for (const Algorithm* const algorithm : plan.algorithms) {
    const std::vector<SweepPoint> points = sweep_points(*algorithm, plan.values);
    try {
      // Not kept, so that the study sees how long preparation takes.
      const auto query = cache.prepare(*algorithm, points.front().settings, cache.mesh(pair.a), cache.mesh(pair.b));
      TimingRounds times;
      times.add(*query, plan.question, trial.poses);
      const double finer = points.size() > 1 ? 0.5 * (1.0 + k_finer) : 1.0;
      seconds_each += 1e-9 * times.wall_ns().value * finer * static_cast<double>(points.size() * (1 + plan.rounds));
    } catch (const Interrupted&) {
      throw;
    } catch (const std::exception&) {  // the study says so itself
    }
  }
  std::size_t affordable = count;
  while (affordable / 2 >= k_fewest_configurations &&
         static_cast<double>(affordable) * seconds_each > k_share * plan.budget_s) {
    affordable /= 2;
  }
  return draw_sample(cache, pair, plan.question, pair.buckets, affordable);
}

PrecisionStudy::PrecisionStudy(PrecisionPlan plan, bench::PairCache& cache, const CatalogueEntry& pair,
                               const StudySample& sample)
    : plan_(std::move(plan)), cache_(cache), pair_(pair), sample_(sample) {
  for (const Algorithm* const algorithm : plan_.algorithms) {
    for (SweepPoint& point : sweep_points(*algorithm, plan_.values)) {
      points_.push_back({.algorithm = algorithm, .sweep = std::move(point)});
    }
  }
}

double PrecisionStudy::left_s() const { return plan_.budget_s - (now_s() - started_s_); }

Query& PrecisionStudy::query_of(const PrecisionPoint& point) {
  return cache_.query(*point.algorithm, point.sweep.settings, pair_.a, pair_.b);
}

/// Of the points with the settings of this one: algorithms of one family share structures through the cache on disk, so
/// the first of them tells how long a finer one will take.
double PrecisionStudy::slowest_preparation(const PrecisionPoint& point) const {
  double slowest = 0.0;
  for (const PrecisionPoint& other : points_) {
    if (other.sweep.assignments == point.sweep.assignments) slowest = std::max(slowest, other.prepare_s);
  }
  return slowest;
}

/// A finer structure takes as much longer to prepare as the last one did, within k_growth and k_most_growth (the cache
/// on disk makes some of them fast); a query of it k_growth times as long.
std::string PrecisionStudy::why_left_out(const PrecisionPoint& point) const {
  constexpr double k_growth = 2.0, k_most_growth = 8.0;
  const PrecisionPoint* last = nullptr;
  const PrecisionPoint* before = nullptr;
  for (const PrecisionPoint& other : points_) {
    if (&other == &point) break;
    if (other.algorithm != point.algorithm) continue;
    before = last;
    last = &other;
  }
  const double left = left_s();
  if (left <= 0.0) return "the budget was spent";
  if (last == nullptr) return {};
  if (!last->left_out.empty()) return last->left_out;
  const double last_s = slowest_preparation(*last);
  const double growth =
      before == nullptr ? k_growth
                        : std::clamp(last_s / std::max(1e-9, slowest_preparation(*before)), k_growth, k_most_growth);
  const double queries = static_cast<double>(sample_.poses.size()) * static_cast<double>(1 + plan_.rounds);
  const double needed = growth * last_s + k_growth * queries * 1e-9 * last->times.cpu_ns().value;
  if (needed <= left) return {};
  return fmt::format("it would take about {:.0f} s, and {:.0f} s of the budget were left", needed, left);
}

/// @throws Error if the plan's deadline cannot be kept, or if the point does not fit into the budget
void PrecisionStudy::check_first_queries(Query& query) const {
  if (std::isinf(plan_.deadline_ns)) return;
  constexpr std::size_t k_trial = 16, k_trial_motions = 2;
  constexpr double k_hopeless = 20.0;  // times the deadline: one query says enough
  const TimedPoses one = TimedPoses{sample_.poses}.first(1);
  if (const double ns = time_single_queries(query, sample_.question, one, plan_.deadline_ns).least.p50;
      ns > k_hopeless * plan_.deadline_ns) {
    throw Error(fmt::format("its first query takes {}, over the deadline", duration_text(1e-9 * ns)));
  }
  const TimedPoses first =
      sample_.motions.poses.empty() ? TimedPoses{sample_.poses}.first(k_trial) : sample_.motions.first(k_trial_motions);
  const double p50 = time_single_queries(query, sample_.question, first, plan_.deadline_ns).least.p50;
  if (p50 > plan_.deadline_ns) {
    throw Error(fmt::format("half of its queries take longer than {}, over the deadline", duration_text(1e-9 * p50)));
  }
  constexpr double k_passes = 6.0;  // errors, three of single queries, the idle loop, the mean
  const double needed = 1e-9 * p50 * k_passes * static_cast<double>(sample_.asked());
  if (left_s() <= 0.0) throw Error("the budget was spent");
  if (needed > left_s()) {
    throw Error(fmt::format("it would take about {:.1f} s, and {:.1f} s of the budget were left", needed, left_s()));
  }
}

void PrecisionStudy::measure(PrecisionPoint& point) {
  point.left_out = why_left_out(point);
  if (!point.left_out.empty()) return;
  try {
    const double start = now_s();
    Query& query = query_of(point);
    point.prepare_s = now_s() - start;
    if (const RemoteQuery* const remote = as_remote(query); remote != nullptr && remote->prepared().wall_ns) {
      point.prepare_s = 1e-9 * *remote->prepared().wall_ns;
    }
    point.bytes = query.footprint().bytes;
    check_first_queries(query);
    point.errors = measure_errors(query, sample_, plan_.seed);
    if (point.errors.answered.empty()) {
      throw Error(fmt::format("no configuration has an answer: {}", point.errors.first_failure));
    }
    if (plan_.single_queries) {
      point.single = time_single_queries(query, sample_.question, timed_poses(point), plan_.deadline_ns);
      point.errors.add_failures(point.single->failed, point.single->first_failure);
    }
    time_once(point);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& e) {
    point.left_out = e.what();
  }
}

/// Whether a round of timing fits into the budget. A structure that was dropped for want of memory is prepared again
/// only if that takes a small part of what is left.
bool PrecisionStudy::affordable(const PrecisionPoint& point) const {
  constexpr double k_small = 0.1;
  const double round_s = 1e-9 * point.times.wall_ns().value * static_cast<double>(timed_poses(point).poses.size());
  const bool prepared = cache_.is_prepared(*point.algorithm, point.sweep.settings, pair_.a, pair_.b);
  return round_s <= left_s() && (prepared || point.prepare_s <= k_small * left_s());
}

void PrecisionStudy::time_once(PrecisionPoint& point) {
  point.times.add(query_of(point), sample_.question, timed_poses(point).poses);
}

TimedPoses PrecisionStudy::timed_poses(const PrecisionPoint& point) const {
  return sample_.motions.poses.empty() ? TimedPoses{point.errors.answered} : sample_.motions;
}

std::vector<std::size_t> PrecisionStudy::timed_points() const {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (points_[i].measured()) places.push_back(i);
  }
  return places;
}

std::vector<std::size_t> PrecisionStudy::uncertain_points() const {
  std::vector<std::size_t> places = uncertain_places();
  std::erase_if(places, [&](std::size_t place) { return points_[place].times.count() >= plan_.most_rounds; });
  return places;
}

void PrecisionStudy::run(const Progress& progress, const std::function<void()>& finished) {
  started_s_ = now_s();
  // The coarse points of all algorithms come first, so that a short budget leaves out the fine ones.
  std::map<const Algorithm*, std::size_t> next;
  std::vector<std::pair<std::size_t, std::size_t>> order;
  for (std::size_t i = 0; i < points_.size(); ++i) order.emplace_back(next[points_[i].algorithm]++, i);
  std::ranges::sort(order);
  std::size_t done = 0;
  for (const auto& [step, place] : order) {
    InterruptGuard::check();
    progress(points_[place].algorithm->traits().name, done++, points_.size());
    measure(points_[place]);
    finished();
  }
  for (std::size_t round = 1; round < plan_.rounds; ++round) {
    for (const std::size_t place : timed_points()) {
      if (!affordable(points_[place])) continue;
      progress(fmt::format("round {} of timing", round + 1), place, points_.size());
      time_once(points_[place]);
    }
    finished();
  }
  for (bool timed = true; timed;) {
    timed = false;
    for (const std::size_t place : uncertain_points()) {
      if (!affordable(points_[place])) continue;
      progress("repeating points whose intervals overlap", place, points_.size());
      time_once(points_[place]);
      timed = true;
    }
    finished();
  }
}

}  // namespace sixdof::study
