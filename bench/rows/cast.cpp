#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/generation/motions.h>
#include <sixdof/generation/stored_impacts.h>
#include "bench/common/hulls.h"
#include "bench/harness/cast_check.h"
#include "bench/harness/timing.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

/// Passes that time single queries; each motion counts with its least time, except in the mean.
constexpr int k_passes = k_latency_passes;

/// Motions of a trial.
constexpr std::size_t k_trial = 4;

struct CastRow {
  const Resources& resources;
  const Algorithm& algorithm;
  const CatalogueEntry& pair;
  MotionKind kind;
  double percent;
  std::optional<CastCounts> counts = {};
  Latency latency = {}, least = {};
  std::vector<Motion> answered = {};
  std::shared_ptr<const Mesh> hull_a = {}, hull_b = {};  ///< Of an algorithm about hulls, when first needed.

  bool is_about_hulls() const { return algorithm.traits().body == Body::convex_hull; }

  /// What answers are about.
  const Mesh& body(const std::string& key, std::shared_ptr<const Mesh>& hull) {
    const Mesh& mesh = resources.cache.mesh(key);
    if (!is_about_hulls()) return mesh;
    if (!hull) hull = std::make_shared<const Mesh>(hull_of(mesh));
    return *hull;
  }

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
            .body = is_about_hulls() ? std::string(to_string(Body::convex_hull)) : std::string(),
            .runtime = algorithm.traits().runtime,
            .cache = "warm",
            .isolated = is_isolated(algorithm)};
  }

  void run(benchmark::State& state, const Share& share) {
    const std::vector<Motion> motions = motions_to_ask(share.configurations);
    const auto truths = stored_impacts(body(pair.a, hull_a), body(pair.b, hull_b), motions);
    Query& query = resources.cache.query(algorithm, resources.settings_of(algorithm), pair.a, pair.b);
    if (!counts) check(motions, truths, query);
    if (answered.empty()) throw Error(fmt::format("no motion has an answer: {}", counts->first_failure));
    time_rounds(state, answered.size(), query, [&](std::size_t i) { return ask(query, answered[i]); });
    report(state);
  }

  double trial(double seconds) {
    Query& query = resources.cache.query(algorithm, resources.settings_of(algorithm), pair.a, pair.b);
    return (2.0 + k_passes) *
           seconds_of_one(motions_to_ask(k_trial), seconds, [&](const Motion& motion) { return ask(query, motion); });
  }

 private:
  static Outcome<Impact> ask(Query& query, const Motion& motion) {
    return ask_guarded([&] { return query.cast(motion); }, [](const std::string&) {});
  }

  std::vector<Motion> motions_to_ask(std::size_t most) const {
    return motions_from_contacts(resources.cache, pair, kind, percent, most, resources.seed);
  }

  /// Judges one answer to every motion and times single queries.
  void check(const std::vector<Motion>& motions, const std::vector<ImpactBracket>& truths, Query& query) {
    CastCounts found;
    CastJudge judge(body(pair.a, hull_a), body(pair.b, hull_b));
    for (std::size_t i = 0; i < motions.size(); ++i) {
      std::string words;
      const Outcome<Impact> answer = ask_cast(query, motions[i], words);
      if (answer.ok()) answered.push_back(motions[i]);
      found.add(truths[i], answer, judge.judge(motions[i], truths[i], answer), words);
    }
    counts = std::move(found);
    time_each(query);
  }

  void time_each(Query& query) {
    const PassTimes times =
        time_singles(answered.size(), query, [&](std::size_t i) { return ask(query, answered[i]); });
    latency = sixdof::latency(times.once_ns);
    least = sixdof::latency(times.least_ns);
  }

  void report(benchmark::State& state) const {
    const auto count = [&](const char* name, double value) { state.counters[name] = value; };
    for (const auto& [name, value] : counts->values()) state.counters[name] = value;
    count("p50_ns", latency.p50);
    if (latency.p99) count("p99_ns", *latency.p99);
    count("max_ns", latency.max);
    count("max_least_ns", least.max);
    std::string label = resources.settings_of(algorithm).to_string();
    if (!counts->first_failure.empty())
      label += fmt::format("{}first failure: {}", label.empty() ? "" : "; ", counts->first_failure);
    state.SetLabel(label);
  }
};

}  // namespace

std::vector<PlannedRow> cast_rows(const Resources& resources) {
  std::vector<PlannedRow> rows;
  for (const CatalogueEntry& pair : resources.catalogue.sets()) {
    if (!has_contacts(pair)) continue;
    for (const auto& algorithm : resources.registry.all()) {
      const Traits& traits = algorithm->traits();
      if (!traits.timed || !traits.answers.cast) continue;
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
