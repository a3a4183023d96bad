#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <sixdof/base/error.h>
#include <sixdof/oracle/penetration_verdict.h>
#include <sixdof/query/ask.h>
#include "bench/harness/penetration_truth.h"
#include "bench/harness/query_command.h"
#include "bench/harness/timing.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

/// Contacts of a query: more than any library finds here.
constexpr std::size_t k_most_contacts = 65535;

/// Configurations of a trial.
constexpr std::size_t k_trial = 4;

/// Whether a depth can be read from the answers of an algorithm.
bool answers_depth(const Traits& traits) {
  return traits.answers.contacts || (traits.answers.respond && is_of_depth(traits.law));
}

/// Verdicts of a row's answers.
struct DepthTally {
  std::size_t of[5] = {};
  std::size_t failures[std::size(k_counted_statuses)] = {};
  std::size_t failed = 0;
  double shallow_max = 0.0, deep_max = 0.0;
  double ratio_sum = 0.0;  ///< Of claimed depths over hi, of those that are judged.
  double width_max = 0.0;  ///< (hi - lo) / hi of the intervals, open ones included.
  double along_sum = 0.0;  ///< Of hi over the depth along the ray of the configuration.
  std::size_t along = 0;
  std::string first_failure;

  std::size_t count(DepthVerdict verdict) const { return of[static_cast<std::size_t>(verdict)]; }
  std::size_t judged() const {
    return count(DepthVerdict::right) + count(DepthVerdict::too_shallow) + count(DepthVerdict::too_deep) +
           count(DepthVerdict::missed);
  }
};

struct DepthRow {
  const Resources& resources;
  const Algorithm& algorithm;
  const CatalogueEntry& pair;
  BucketKey key;
  std::optional<DepthTally> tally = {};
  Latency latency = {};
  std::vector<Pose> answered = {};
  results::Outliers worst = {};

  bool claims_bodies() const { return algorithm.traits().depth == ContactDepth::bodies; }
  bool is_about_meshes() const { return algorithm.traits().body == Body::mesh; }
  std::string name() const {
    std::string bucket = key.name();
    bucket.at(bucket.find('/')) = ':';
    return fmt::format("depth/algorithm:{}/pair:{}/{}", algorithm.traits().name, pair.pair, bucket);
  }
  results::RowFields fields() const {
    return {.query = "depth",
            .algorithm = algorithm.traits().name,
            .settings = resources.settings_of(algorithm).to_string(),
            .pair = pair.pair,
            .bucket = key,
            .order = "random",
            .body = is_about_meshes() ? "" : std::string(to_string(algorithm.traits().body)),
            .runtime = algorithm.traits().runtime,
            .cache = "warm",
            .isolated = is_isolated(algorithm),
            .approximates = algorithm.traits().approximates};
  }

  void run(benchmark::State& state, const Share& share) {
    const std::span<const Pose> poses = poses_to_ask(std::min(share.configurations, PenetrationTruths::k_most));
    const Mesh &a = resources.cache.mesh(pair.a), &b = resources.cache.mesh(pair.b);
    Query& query = resources.cache.query(algorithm, resources.settings_of(algorithm), pair.a, pair.b);
    if (!tally) check(poses, a, b, query);
    if (answered.empty()) throw Error(fmt::format("no configuration has an answer: {}", tally->first_failure));
    time_rounds(state, answered.size(), query, [&](std::size_t i) { return ask(query, answered[i]); });
    report(state, poses.size());
  }

  double trial(double seconds) {
    Query& query = resources.cache.query(algorithm, resources.settings_of(algorithm), pair.a, pair.b);
    return (2.0 + k_latency_passes) *
           seconds_of_one(poses_to_ask(k_trial), seconds, [&](const Pose& pose) { return ask(query, pose); });
  }

 private:
  /// The largest depth of the contacts, or the penalty of a law of depth; none: 0.
  Outcome<double> ask(Query& query, const Pose& X_AB) const {
    const auto ignore = [](const std::string&) {};
    if (!algorithm.traits().answers.contacts) {
      const Outcome<Response> answer = ask_guarded([&] { return query.respond(X_AB); }, ignore);
      return answer.ok() ? Outcome<double>(answer.value.penalty) : Outcome<double>(answer.status);
    }
    const Outcome<Contacts> answer = ask_contacts(query, X_AB, k_most_contacts, ignore);
    if (!answer.ok()) return answer.status;
    double depth = 0.0;
    for (const Contact& contact : answer.value.list) depth = std::max(depth, contact.depth);
    return depth;
  }

  std::span<const Pose> poses_to_ask(std::size_t most) const {
    const BucketSample& bucket = resources.cache.bucket(pair, key);
    require_solids(resources.cache.mesh(pair.a), resources.cache.mesh(pair.b));
    return std::span(bucket.poses).first(std::min(most, bucket.poses.size()));
  }

  /// Judges one answer to every configuration, then times single queries.
  void check(std::span<const Pose> poses, const Mesh& a, const Mesh& b, Query& query) {
    const auto word_of = [&](const std::string& mesh) {
      const CatalogueMesh* const each = resources.catalogue.mesh(mesh);
      return each == nullptr || each->identity.path.empty() ? mesh : each->identity.path;
    };
    worst.a = word_of(pair.a);
    worst.b = word_of(pair.b);
    worst.command = query_command(worst.a, worst.b, algorithm, resources.settings_of(algorithm));
    if (algorithm.traits().answers.contacts) worst.command += fmt::format(" --contacts {}", k_most_contacts);
    PenetrationTruths truths = is_about_meshes() ? PenetrationTruths(a, b) : PenetrationTruths::of_hulls(a, b);
    const std::span<const PenetrationDepth> known = truths.at(poses);
    DepthTally found;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const PenetrationDepth& truth = known[i];
      if (truth.hi > 0.0) found.width_max = std::max(found.width_max, (truth.hi - truth.lo) / truth.hi);
      const Outcome<double> answer = ask(query, poses[i]);
      if (!answer.ok()) {
        if (found.failed++ == 0) worst.add("failed", poses[i]);
        for (std::size_t k = 0; k < k_counted_statuses.size(); ++k) {
          if (answer.status == k_counted_statuses[k]) ++found.failures[k];
        }
        if (found.first_failure.empty()) found.first_failure = query.diagnosis();
        continue;
      }
      answered.push_back(poses[i]);
      const JudgedDepth judged = judge_depth(truth, answer.value, k_depth_slack * a.diagonal());
      const bool is_first = found.judged() == found.count(DepthVerdict::right);
      ++found.of[static_cast<std::size_t>(judged.verdict)];
      const bool is_wrong = claims_bodies() && found.judged() > found.count(DepthVerdict::right);
      if (is_first && is_wrong) worst.add("mismatch", poses[i]);
      if (judged.shallow > found.shallow_max) worst.add("too_shallow_max", poses[i]);
      if (judged.deep > found.deep_max) worst.add("too_deep_max", poses[i]);
      found.shallow_max = std::max(found.shallow_max, judged.shallow);
      found.deep_max = std::max(found.deep_max, judged.deep);
      if (judged.verdict != DepthVerdict::not_judged && truth.hi > 0.0) found.ratio_sum += answer.value / truth.hi;
    }
    if (is_about_meshes()) compare_with_rays(poses, a, b, known, found);
    tally = std::move(found);
    const PassTimes times =
        time_singles(answered.size(), query, [&](std::size_t i) { return ask(query, answered[i]); });
    latency = sixdof::latency(times.once_ns);
  }

  /// How much shorter the shortest way out is than that along the ray on which the configuration lies.
  static void compare_with_rays(std::span<const Pose> poses, const Mesh& a, const Mesh& b,
                                std::span<const PenetrationDepth> known, DepthTally& found) {
    const PenetrationOracle oracle(a, b);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Eigen::Vector3d ray = poses[i] * b.center() - a.center();
      if (!known[i].closed || ray.isZero(0.0)) continue;
      const std::optional<double> along = oracle.directional_depth(poses[i], ray.normalized());
      if (!along || !(*along > 0.0)) continue;
      found.along_sum += known[i].hi / *along;
      ++found.along;
    }
  }

  void report(benchmark::State& state, std::size_t asked) const {
    const auto count = [&](const char* counter, auto value) { state.counters[counter] = static_cast<double>(value); };
    const DepthTally& t = *tally;
    count("configurations", asked);
    count("failed", t.failed);
    for (std::size_t k = 0; k < k_counted_statuses.size(); ++k) {
      if (t.failures[k] > 0)
        state.counters[std::string(to_string(k_counted_statuses[k]))] = static_cast<double>(t.failures[k]);
    }
    count("judged", t.judged());
    // Who says how far B has to move is wrong otherwise; depths of triangles and of points are only compared.
    if (claims_bodies()) {
      count("mismatch", t.judged() - t.count(DepthVerdict::right));
    }
    count("open_depths", t.count(DepthVerdict::not_judged));
    count("too_shallow", t.count(DepthVerdict::too_shallow) + t.count(DepthVerdict::missed));
    count("too_deep", t.count(DepthVerdict::too_deep));
    count("missed_depths", t.count(DepthVerdict::missed));
    count("too_shallow_max", t.shallow_max);
    count("too_deep_max", t.deep_max);
    if (t.judged() > 0) count("depth_ratio", t.ratio_sum / static_cast<double>(t.judged()));
    count("depth_width_max", t.width_max);
    if (t.along > 0) count("depth_of_ray", t.along_sum / static_cast<double>(t.along));
    count("p50_ns", latency.p50);
    if (latency.p99) count("p99_ns", *latency.p99);
    count("max_ns", latency.max);
    std::string label = resources.settings_of(algorithm).to_string();
    if (!t.first_failure.empty()) {
      label += fmt::format("{}first failure: {}", label.empty() ? "" : "; ", t.first_failure);
    }
    state.SetLabel(label);
  }
};

}  // namespace

std::vector<PlannedRow> depth_rows(const Resources& resources) {
  std::vector<PlannedRow> rows;
  for (const CatalogueEntry& pair : resources.catalogue.sets()) {
    for (const auto& algorithm : resources.registry.all()) {
      if (!algorithm->traits().timed || !answers_depth(algorithm->traits())) continue;
      for (const BucketKey key : pair.buckets) {
        if (key.kind != BucketKind::volume || !(key.percent > 0)) continue;
        const auto row = std::make_shared<DepthRow>(DepthRow{resources, *algorithm, pair, key});
        rows.push_back({.name = row->name(),
                        .run = [row](benchmark::State& state, const Share& share) { row->run(state, share); },
                        .fields = row->fields(),
                        .trial = [row](double seconds) { return row->trial(seconds); },
                        .outliers = [row] { return row->worst; },
                        .manual_time = is_isolated(*algorithm)});
      }
    }
  }
  return rows;
}

}  // namespace sixdof::bench
