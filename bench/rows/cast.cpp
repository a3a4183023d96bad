#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/generation/motions.h>
#include <sixdof/generation/stored_impacts.h>
#include <sixdof/oracle/impact_verdict.h>
#include "bench/harness/timing.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

constexpr BucketKey k_contact{BucketKind::distance, 0};

/// Passes that time single queries; each motion counts with its least time, except in the mean.
constexpr int k_passes = k_latency_passes;

/// Motions of a trial.
constexpr std::size_t k_trial = 4;

/// Verdicts of a row's answers.
struct Tally {
  std::size_t of[8] = {};
  std::size_t failures[std::size(k_counted_statuses)] = {};
  std::size_t hits = 0;
  double early_max = 0.0, late_max = 0.0, normal_max = -1.0;
  std::string first_failure;

  std::size_t count(ImpactVerdict verdict) const { return of[static_cast<std::size_t>(verdict)]; }
  std::size_t faults() const {
    return count(ImpactVerdict::late) + count(ImpactVerdict::missed) + count(ImpactVerdict::phantom) +
           count(ImpactVerdict::false_contact);
  }
};

struct CastRow {
  const Resources& resources;
  const Algorithm& algorithm;
  const CatalogueEntry& pair;
  MotionKind kind;
  double percent;
  std::optional<Tally> tally = {};
  Latency latency = {}, least = {};
  std::vector<Motion> answered = {};

  std::string motion() const { return fmt::format("{}/{}", to_string(kind), percent); }
  std::string name() const {
    return fmt::format("cast/algorithm:{}/pair:{}/motion:{}/step:{}", algorithm.traits().name, pair.pair,
                       to_string(kind), percent);
  }
  results::RowFields fields() const {
    return {.query = "cast",
            .algorithm = algorithm.traits().name,
            .settings = resources.settings_of(algorithm).to_string(),
            .pair = pair.pair,
            .bucket = k_contact,
            .order = motion(),
            .runtime = algorithm.traits().runtime,
            .cache = "warm",
            .isolated = is_isolated(algorithm)};
  }

  void run(benchmark::State& state, const Share& share) {
    const Mesh& a = resources.cache.mesh(pair.a);
    const Mesh& b = resources.cache.mesh(pair.b);
    const std::vector<Motion> motions = motions_to_ask(share.configurations);
    const auto truths = stored_impacts(a, b, motions);
    Query& query = resources.cache.query(algorithm, resources.settings_of(algorithm), pair.a, pair.b);
    if (!tally) check(motions, truths, query);
    if (answered.empty()) throw Error(fmt::format("no motion has an answer: {}", tally->first_failure));
    const auto round = static_cast<benchmark::IterationCount>(answered.size());
    RemoteQuery* const remote = as_remote(query);
    while (state.KeepRunningBatch(round)) {
      double inside_ns = 0.0;
      ask_all(answered.size(), [&](std::size_t i) {
        auto answer = ask(query, answered[i]);
        if (remote != nullptr) inside_ns += remote->last_ns();
        return answer;
      });
      if (remote != nullptr) state.SetIterationTime(1e-9 * inside_ns);
    }
    report(state, motions.size());
  }

  double trial(double seconds) {
    Query& query = resources.cache.query(algorithm, resources.settings_of(algorithm), pair.a, pair.b);
    const auto start = std::chrono::steady_clock::now();
    const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
    std::size_t asked = 0;
    for (const Motion& motion : motions_to_ask(k_trial)) {
      static_cast<void>(ask(query, motion));
      ++asked;
      if (passed() > 0.1 * seconds) break;
    }
    return asked == 0 ? 0.0 : (2.0 + k_passes) * passed() / static_cast<double>(asked);
  }

 private:
  static Outcome<Impact> ask(Query& query, const Motion& motion) {
    return ask_guarded([&] { return query.cast(motion); }, [](const std::string&) {});
  }

  std::vector<Motion> motions_to_ask(std::size_t most) const {
    const BucketSample& bucket = resources.cache.bucket(pair, k_contact);
    const std::size_t count = std::min(most, bucket.poses.size());
    return motions_of(std::span(bucket.poses).first(count), resources.cache.mesh(pair.a), resources.cache.mesh(pair.b),
                      kind, percent, resources.seed);
  }

  /// Judges one answer to every motion and times single queries.
  void check(const std::vector<Motion>& motions, const std::vector<ImpactBracket>& truths, Query& query) {
    const Mesh& a = resources.cache.mesh(pair.a);
    const Mesh& b = resources.cache.mesh(pair.b);
    Tally found;
    DistanceCheck distance(a, b);
    for (std::size_t i = 0; i < motions.size(); ++i) {
      Outcome<Impact> answer = ask(query, motions[i]);
      examine(query, answer, [&](const std::string& words) {
        if (found.first_failure.empty()) found.first_failure = words;
      });
      if (answer.ok()) answered.push_back(motions[i]);
      const double gap = answer.ok() && answer.value.hit && truths[i].kind == ImpactBracket::Kind::none
                             ? distance(motions[i], answer.value.t)
                             : -1.0;
      const JudgedImpact judged = judge_impact(truths[i], answer, impact_tolerance(motions[i], b.box(), a.diagonal()),
                                               gap, k_impact_slack * a.diagonal());
      ++found.of[static_cast<std::size_t>(judged.verdict)];
      const bool hit = truths[i].kind == ImpactBracket::Kind::hit || truths[i].kind == ImpactBracket::Kind::at_start;
      found.hits += hit ? 1 : 0;
      found.early_max = std::max(found.early_max, judged.early);
      found.late_max = std::max(found.late_max, judged.late);
      if (judged.verdict == ImpactVerdict::right) found.normal_max = std::max(found.normal_max, judged.normal_angle);
      for (std::size_t k = 0; k < k_counted_statuses.size(); ++k) {
        if (answer.status == k_counted_statuses[k]) ++found.failures[k];
      }
    }
    tally = std::move(found);
    time_each(query);
  }

  void time_each(Query& query) {
    RemoteQuery* const remote = as_remote(query);
    std::vector<double> inside_once(answered.size()), inside_least(answered.size());
    int pass = 0;
    PassTimes times = time_passes(
        answered.size(), k_passes, [](std::size_t) {}, [&](std::size_t i) { return ask(query, answered[i]); },
        [&](std::size_t i, Outcome<Impact>&) {
          if (remote == nullptr) return;
          const double ns = remote->last_ns();
          if (pass == 0) inside_once[i] = ns;
          inside_least[i] = pass == 0 ? ns : std::min(inside_least[i], ns);
          if (i + 1 == answered.size()) ++pass;
        });
    latency = sixdof::latency(remote == nullptr ? times.once_ns : inside_once);
    least = sixdof::latency(remote == nullptr ? times.least_ns : inside_least);
  }

  /// Exact distances, for hits where there are none; made when first asked.
  class DistanceCheck {
   public:
    DistanceCheck(const Mesh& a, const Mesh& b) : a_(a), b_(b) {}
    double operator()(const Motion& motion, double t) {
      if (!oracle_) query_.emplace(oracle_.emplace(a_, b_));
      return query_->distance(motion.pose_at(t)).distance;
    }

   private:
    const Mesh& a_;
    const Mesh& b_;
    std::optional<DistanceOracle> oracle_;
    std::optional<DistanceQuery> query_;
  };

  void report(benchmark::State& state, std::size_t asked) const {
    const auto count = [&](const char* name, auto value) { state.counters[name] = static_cast<double>(value); };
    const Tally& t = *tally;
    count("configurations", asked);
    count("hits", t.hits);
    count("failed", t.count(ImpactVerdict::failed));
    for (std::size_t k = 0; k < k_counted_statuses.size(); ++k) {
      if (t.failures[k] > 0)
        state.counters[std::string(to_string(k_counted_statuses[k]))] = static_cast<double>(t.failures[k]);
    }
    count("judged", asked - t.count(ImpactVerdict::failed) - t.count(ImpactVerdict::not_judged));
    count("mismatch", t.faults());
    count("grazing", t.count(ImpactVerdict::not_judged));
    count("early", t.count(ImpactVerdict::early));
    count("early_max", t.early_max);
    count("late_hits", t.count(ImpactVerdict::late));
    count("late_max", t.late_max);
    count("missed_hits", t.count(ImpactVerdict::missed));
    count("phantom_hits", t.count(ImpactVerdict::phantom));
    count("false_starts", t.count(ImpactVerdict::false_contact));
    if (t.normal_max >= 0.0) count("normal_max_deg", t.normal_max);
    count("p50_ns", latency.p50);
    if (latency.p99) count("p99_ns", *latency.p99);
    count("max_ns", latency.max);
    count("max_least_ns", least.max);
    std::string label = resources.settings_of(algorithm).to_string();
    if (!t.first_failure.empty())
      label += fmt::format("{}first failure: {}", label.empty() ? "" : "; ", t.first_failure);
    state.SetLabel(label);
  }
};

}  // namespace

std::vector<PlannedRow> cast_rows(const Resources& resources) {
  std::vector<PlannedRow> rows;
  for (const CatalogueEntry& pair : resources.catalogue.sets()) {
    if (std::ranges::find(pair.buckets, k_contact) == pair.buckets.end()) continue;
    for (const auto& algorithm : resources.registry.all()) {
      const Traits& traits = algorithm->traits();
      if (!traits.timed || !traits.answers.cast || traits.body != Body::mesh) continue;
      for (const MotionKind kind : k_motion_kinds) {
        for (const double percent : k_motion_steps) {
          const auto row = std::make_shared<CastRow>(CastRow{resources, *algorithm, pair, kind, percent});
          rows.push_back({.name = row->name(),
                          .run = [row](benchmark::State& state, const Share& share) { row->run(state, share); },
                          .fields = row->fields(),
                          .trial = [row](double seconds) { return row->trial(seconds); },
                          .manual_time = is_isolated(*algorithm)});
        }
      }
    }
  }
  return rows;
}

}  // namespace sixdof::bench
