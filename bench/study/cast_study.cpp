#include "bench/study/cast_study.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/generation/stored_impacts.h>
#include <sixdof/measure/latency.h>
#include <sixdof/process/remote_algorithm.h>
#include <sixdof/query/timed_loop.h>
#include "bench/common/duration.h"
#include "bench/common/interrupt.h"
#include "bench/study/timing_rounds.h"

namespace sixdof::study {
namespace {

constexpr double k_steps[] = {1.0, 10.0};  // percent of A's diagonal
constexpr std::size_t k_trial = 8;
constexpr std::size_t k_mean_passes = 3;

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// An answer with its wall time in ns, inside the process where the algorithm has one of its own.
std::pair<Outcome<Impact>, double> ask_with_clock(Query& query, const Motion& motion, std::string& words) {
  auto [answer, ns] = with_clock([&] { return bench::ask_cast(query, motion, words); });
  const RemoteQuery* const remote = as_remote(query);
  return {answer, remote == nullptr ? ns : remote->last_ns()};
}

class Measurement {
 public:
  Measurement(const CastPlan& plan, bench::PairCache& cache, const CatalogueEntry& pair, const CastSample& sample,
              double end_s)
      : plan_(plan), cache_(cache), pair_(pair), sample_(sample), end_s_(end_s) {}

  /// @throws Error if the setting is left out
  void fill(const CastPoint& point, results::Row& row) {
    if (now_s() >= end_s_) throw Error("the budget was spent");
    const double start = now_s();
    Query& query = cache_.query(*point.algorithm, point.sweep.settings, pair_.a, pair_.b);
    row.values["prepare_ns"] = 1e9 * (now_s() - start);
    row.values["bytes"] = static_cast<double>(query.footprint().bytes);
    check_first(query);
    judge(query, row);
    time_mean(query, row);
  }

 private:
  void check_first(Query& query) const {
    std::vector<double> times;
    std::string words;
    for (std::size_t i = 0; i < std::min(k_trial, sample_.motions.size()); ++i) {
      times.push_back(ask_with_clock(query, sample_.motions[i], words).second);
      InterruptGuard::check();
    }
    const double p50 = latency(times).p50;
    if (p50 > plan_.deadline_ns) {
      throw Error(
          fmt::format("half of its first motions take longer than {}, over the deadline", duration_text(1e-9 * p50)));
    }
    const double needed = 1e-9 * p50 * static_cast<double>((2 + k_mean_passes) * sample_.motions.size());
    const double left = end_s_ - now_s();
    if (needed > left) {
      throw Error(fmt::format("it would take about {:.1f} s, and {:.1f} s of the budget were left", needed,
                              std::max(0.0, left)));
    }
  }

  void judge(Query& query, results::Row& row) {
    bench::CastJudge judge(cache_.mesh(pair_.a), cache_.mesh(pair_.b));
    bench::CastCounts counts;
    std::vector<double> times;
    for (std::size_t i = 0; i < sample_.motions.size(); ++i) {
      std::string words;
      const auto [answer, ns] = ask_with_clock(query, sample_.motions[i], words);
      counts.add(sample_.truths[i], answer, judge.judge(sample_.motions[i], sample_.truths[i], answer), words);
      if (answer.ok()) times.push_back(ns);
      InterruptGuard::check();
    }
    if (times.empty()) throw Error(fmt::format("no motion has an answer: {}", counts.first_failure));
    if (!counts.first_failure.empty()) row.label = "first failure: " + counts.first_failure;
    for (const auto& [name, value] : counts.values()) row.values[name] = value;
    const Latency once = latency(times);
    const auto late = std::ranges::count_if(times, [&](double ns) { return ns > plan_.deadline_ns; });
    row.values["p50_ns"] = once.p50;
    row.values["max_ns"] = once.max;
    if (once.p99) row.values["p99_ns"] = *once.p99;
    row.values["timed"] = static_cast<double>(times.size());
    row.values["late"] = static_cast<double>(late);
    if (once.p50 < plan_.deadline_ns && std::isfinite(plan_.deadline_ns)) {
      row.values["idle_late"] = static_cast<double>(late_waits(times.size(), once.p50, plan_.deadline_ns));
    }
  }

  void time_mean(Query& query, results::Row& row) const {
    std::vector<double> wall_ns, cpu_ns;
    std::string words;
    const auto count = static_cast<double>(sample_.motions.size());
    for (std::size_t pass = 0; pass < k_mean_passes; ++pass) {
      double wall = 0.0;
      const double cpu_start = processor_ns();
      for (const Motion& motion : sample_.motions) wall += ask_with_clock(query, motion, words).second;
      wall_ns.push_back(wall / count);
      // Of another process only the wall time is known.
      cpu_ns.push_back(as_remote(query) == nullptr ? (processor_ns() - cpu_start) / count : wall / count);
      InterruptGuard::check();
    }
    add(results::k_wall_mean, results::median_of_rounds(wall_ns), row);
    add(results::k_processor_mean, results::median_of_rounds(cpu_ns), row);
  }

  static void add(const std::string& name, const results::Estimate& estimate, results::Row& row) {
    row.values[name] = estimate.value;
    if (estimate.low == estimate.high) return;
    row.values[name + "_low"] = estimate.low;
    row.values[name + "_high"] = estimate.high;
  }

  const CastPlan& plan_;
  bench::PairCache& cache_;
  const CatalogueEntry& pair_;
  const CastSample& sample_;
  const double end_s_;
};

results::Row empty_row(const CastPoint& point, const CatalogueEntry& pair, std::size_t motions) {
  const Traits& traits = point.algorithm->traits();
  results::Row row{.name = fmt::format("precision/cast/algorithm:{}/pair:{}", traits.name, pair.pair),
                   .fields = {.query = "precision",
                              .algorithm = traits.name,
                              .settings = point.sweep.settings.to_string(),
                              .pair = pair.pair,
                              .runtime = traits.runtime,
                              .isolated = is_isolated(*point.algorithm),
                              .approximates = traits.approximates,
                              .question = results::k_cast,
                              .configurations = motions}};
  for (std::string assignment : point.sweep.assignments) {
    std::ranges::replace(assignment, '=', ':');
    row.name += "/" + assignment;
  }
  return row;
}

}  // namespace

std::size_t CastSample::hits() const {
  return static_cast<std::size_t>(std::ranges::count_if(truths, [](const ImpactBracket& truth) {
    return truth.kind == ImpactBracket::Kind::hit || truth.kind == ImpactBracket::Kind::at_start;
  }));
}

CastSample draw_cast_sample(bench::PairCache& cache, const CatalogueEntry& pair, std::size_t count,
                            std::uint64_t seed) {
  if (!bench::has_contacts(pair)) {
    throw BadArgument(
        fmt::format("{}: its set has no poses of contact (distance 0 %), where motions begin", pair.pair));
  }
  constexpr std::size_t k_groups = k_motion_kinds.size() * std::size(k_steps);
  std::vector<std::vector<Motion>> groups;
  for (const MotionKind kind : k_motion_kinds) {
    for (const double percent : k_steps) {
      const std::size_t most = (count + k_groups - 1) / k_groups;
      groups.push_back(bench::motions_from_contacts(cache, pair, kind, percent, most, seed));
    }
  }
  CastSample sample;
  for (std::size_t i = 0; i < groups.front().size(); ++i) {
    for (const std::vector<Motion>& group : groups) sample.motions.push_back(group[i]);
  }
  if (sample.motions.empty()) throw BadArgument(fmt::format("{}: its set has no poses of contact", pair.pair));
  sample.truths = stored_impacts(cache.mesh(pair.a), cache.mesh(pair.b), sample.motions);
  return sample;
}

std::string motions_text(const CastSample& sample) {
  const auto grazing = static_cast<std::size_t>(std::ranges::count_if(
      sample.truths, [](const ImpactBracket& truth) { return truth.kind == ImpactBracket::Kind::grazing; }));
  const std::size_t judged = sample.motions.size() - grazing;
  return fmt::format(
      "{} judged motions: {} with a first contact, {} without; translations, rotations and both at once by {:g} and "
      "{:g} % "
      "of the diagonal of A's box",
      judged, sample.hits(), judged - sample.hits(), k_steps[0], k_steps[1]);
}

std::vector<std::string> cast_error_metrics() { return {"early_max", "normal_max_deg", "failed"}; }

std::vector<CastPoint> measure_casts(const CastPlan& plan, bench::PairCache& cache, const CatalogueEntry& pair,
                                     const CastSample& sample,
                                     const std::function<void(const std::string&, std::size_t, std::size_t)>& progress,
                                     const std::function<void(const std::vector<CastPoint>&)>& finished) {
  std::vector<CastPoint> points;
  for (const Algorithm* const algorithm : plan.algorithms) {
    for (SweepPoint& sweep : sweep_points(*algorithm, plan.values)) points.push_back({algorithm, std::move(sweep), {}});
  }
  Measurement measurement(plan, cache, pair, sample, now_s() + plan.budget_s);
  for (std::size_t i = 0; i < points.size(); ++i) {
    InterruptGuard::check();
    CastPoint& point = points[i];
    progress(point.algorithm->traits().name, i, points.size());
    point.row = empty_row(point, pair, sample.motions.size());
    try {
      measurement.fill(point, point.row);
    } catch (const Interrupted&) {
      throw;
    } catch (const std::exception& e) {
      point.row.values.clear();
      point.row.error = fmt::format("left out: {}", e.what());
    }
    finished({points.begin(), points.begin() + static_cast<std::ptrdiff_t>(i) + 1});
  }
  return points;
}

}  // namespace sixdof::study
