#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include "bench/harness/cache_eviction.h"
#include "bench/harness/check.h"
#include "bench/harness/failure_counters.h"
#include "bench/harness/hull_truth.h"
#include "bench/harness/motion.h"
#include "bench/harness/own_law.h"
#include "bench/harness/query_command.h"
#include "bench/harness/query_kind.h"
#include "bench/harness/response_error.h"
#include "bench/harness/timing.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

std::array<double, 3> numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// How often a row asks each configuration, for its trial: once in the check, in one or two timed rounds, and in the
/// passes that time single queries.
constexpr double k_passes = 3.0 + k_latency_passes;
/// The same on cold caches: in the check, and in the timed round.
constexpr double k_cold_passes = 2.0;
/// Configurations of a trial, and the part of the row's time that it may take.
constexpr std::size_t k_trial = 8;
constexpr double k_trial_time = 0.1;
/// Most configurations on cold caches: emptying them takes far longer than most queries.
constexpr std::size_t k_most_cold = 64;
/// Overlapping configurations whose mean force is what forces of bodies that are apart are compared with.
constexpr std::size_t k_scale_poses = 32;
/// As `contacts` declares, contacts are judged by depth.
constexpr ResponseLaw judged_law(ResponseLaw own) { return own == ResponseLaw::contacts ? ResponseLaw::depth : own; }

/// Count of a footprint, and counter of a row; bench/rivals/python/sixdof_rival.py measures it.
constexpr const char* k_empty_call = "empty_call_ns";

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// How a row's poses follow each other.
enum class Order {
  random,
  path,    ///< In the grid's own order.
  motion,  ///< From a few of the configurations on, in small steps: poses_of_motions().
};

constexpr const char* to_string(Order order) {
  constexpr const char* k_names[] = {"random", "path", "motion"};
  return k_names[static_cast<std::size_t>(order)];
}

/// One row, and what its first call measured.
struct QueryRow {
  const Resources& resources;
  const Algorithm& algorithm;
  const CatalogueEntry& pair;
  BucketKey key;
  QueryKind question;
  Order order;
  /// Called before each query; empty for a row on warm caches.
  std::shared_ptr<CacheEviction> evict;
  Failures failures = {};
  bool timed_outside = false;  ///< By this process, of an algorithm in another one that does not say how long it took.
  std::optional<Check> check = {};
  std::vector<Pose> poses = {};  ///< That are timed.
  Latency latency = {};
  std::optional<Latency> least = {};  ///< Of several passes; none on cold caches.
  /// Of the force and of the torque about the centre of B's box, to the exact responses.
  std::optional<std::array<VectorError, 2>> errors = {};
  OwnLawErrors own = {};
  results::Outliers worst = {};
  std::vector<Response> hull_responses = {};  ///< Of `exact`, where the row is about convex hulls.
  /// Mean force of this algorithm at the pair's least overlap, 1 % in most sets; empty where it is not needed.
  std::optional<double> force_scale = {};
  std::optional<double> empty_call_ns = {};  ///< That a call from Python takes without the library's work.

  results::RowFields fields() const {
    return {.query = std::string(to_string(question)),
            .algorithm = algorithm.traits().name,
            .settings = resources.settings_of(algorithm).to_string(),
            .pair = pair.pair,
            .bucket = key,
            .order = to_string(order),
            .body = is_about_meshes() ? "" : std::string(to_string(algorithm.traits().body)),
            .runtime = algorithm.traits().runtime,
            .cache = evict ? "cold" : "warm",
            .law = law_word(),
            .isolated = is_isolated(algorithm),
            .approximates = algorithm.traits().approximates};
  }

  std::string name() const {
    std::string bucket = key.name();
    bucket.at(bucket.find('/')) = ':';
    return fmt::format("{}/algorithm:{}/pair:{}/{}{}{}", to_string(question), algorithm.traits().name, pair.pair,
                       bucket, order == Order::random ? "" : fmt::format("/order:{}", to_string(order)),
                       evict ? "/cache:cold" : "");
  }

  void run(benchmark::State& state, const Share& share) {
    const BucketSample& bucket = sample();
    const std::size_t most = evict ? k_most_cold : bucket.poses.size();
    const std::size_t count = std::min({share.configurations, most, bucket.poses.size()});
    std::span<const Response> exact;
    if (has_exact()) exact = exact_responses(bucket, count);
    with_query(failures, [&](auto query) {
      if (!check) {
        if constexpr (requires { query.ask(poses[0]).value.force; }) {
          if (has_exact()) {
            compare_with_exact(bucket, exact, query);
            compare_with_own(bucket, exact.size(), query);
          }
        }
        check = check_answers(bucket, count, query, hulls(), resolution_of(algorithm, query.query()));
        empty_call_ns = footprint_count(query.query(), k_empty_call);
        poses = poses_to_time(bucket, count);
        if (!evict) {
          const SingleTimes times = time_each(poses, query);
          latency = times.once;
          least = times.least;
          if (!poses.empty()) {
            worst.add("max_ns", poses[times.slowest_once]);
            worst.add("max_least_ns", poses[times.slowest_least]);
          }
        }
      }
      if (poses.empty()) throw Error(fmt::format("no configuration has an answer: {}", failures.first()));
      timed_outside = query.remote() != nullptr && !query.remote()->is_timed_inside();
      if (evict) {
        latency = time_cold(state, poses, query, *evict);
      } else {
        time_mean(state, poses, query);
      }
    });
    if (check->phantoms > 0 && !force_scale) force_scale = force_at_least_overlap();
    report(state, sample());
  }

  /// PlannedRow::outliers.
  results::Outliers outliers() const {
    const auto word_of = [&](const std::string& name) {
      const CatalogueMesh* const mesh = resources.catalogue.mesh(name);
      return mesh == nullptr || mesh->identity.path.empty() ? name : mesh->identity.path;
    };
    results::Outliers found = worst;
    found.a = word_of(pair.a);
    found.b = word_of(pair.b);
    found.command = query_command(found.a, found.b, algorithm, resources.settings_of(algorithm));
    found.add("failed", failures.first_pose());
    found.add("mismatch", check->first_wrong);
    found.add("misses", check->first_missed);
    found.add(question == QueryKind::distance ? "error_max" : "volume_error_max", check->largest_error);
    found.add("phantom_force_max", check->largest_phantom);
    return found;
  }

  /// PlannedRow::trial.
  double trial(double seconds) {
    const BucketSample& bucket = sample();
    double each = has_exact() && is_about_meshes() ? time_exact() : 0.0;
    Failures ignored;
    with_query(ignored, [&](auto query) {
      const auto start = std::chrono::steady_clock::now();
      double answers_ns = 0.0;
      std::size_t answers = 0;
      for (const Pose& pose : std::span(bucket.poses).first(std::min(k_trial, bucket.poses.size()))) {
        const auto [answer, took_ns] = ask_with_clock(pose, query);
        if (answer.ok()) {
          answers_ns += took_ns;
          ++answers;
        }
        if (seconds_since(start) > k_trial_time * seconds) break;
      }
      // A response is asked once more, to be compared with the exact one.
      const double passes = (evict ? k_cold_passes : k_passes) + (has_exact() ? 1.0 : 0.0);
      if (answers > 0) each += passes * 1e-9 * answers_ns / static_cast<double>(answers);
    });
    if (evict) each += time_eviction();
    if (!is_about_meshes()) each += time_truth_of_hulls(bucket);
    return each;
  }

 private:
  /// Whether answers are compared with exact responses: bodies that are apart have none.
  bool has_exact() const { return question == QueryKind::respond && key.kind == BucketKind::volume; }

  /// Of the first configurations with a force at the pair's least overlap; empty where the set has no overlaps.
  std::optional<double> force_at_least_overlap() const {
    std::optional<BucketKey> shallowest;
    for (const BucketKey each : pair.buckets) {
      const bool overlaps = each.kind == BucketKind::volume && each.percent > 0;
      if (overlaps && (!shallowest || each.percent < shallowest->percent)) shallowest = each;
    }
    if (!shallowest) return std::nullopt;
    const std::vector<Pose>& there = resources.cache.bucket(pair, *shallowest).poses;
    Query& query = resources.cache.query(algorithm, resources.settings_of(algorithm), pair.a, pair.b);
    Errors forces;
    Failures ignored;
    with_query_kind(query, QueryKind::respond, ignored, [&](auto guarded) {
      for (const Pose& pose : std::span(there).first(std::min(k_scale_poses, there.size()))) {
        const auto answer = guarded.ask(pose);
        if constexpr (requires { answer.value.force; }) {
          if (answer.ok()) forces.add(answer.value.force.stableNorm());
        }
      }
    });
    return forces.mean() > 0.0 ? std::optional(forces.mean()) : std::nullopt;
  }

  bool is_about_meshes() const { return algorithm.traits().body == Body::mesh; }

  /// RowFields::law.
  std::string law_word() const {
    const ResponseLaw law = algorithm.traits().law;
    return question == QueryKind::respond && law != ResponseLaw::none ? std::string(to_string(law)) : std::string();
  }

  /// The truth of answers that are not about the meshes, as the set's truth is; null of others.
  HullTruth* hulls() const { return is_about_meshes() ? nullptr : &resources.cache.hull_truth(pair); }

  /// Those of `exact` to the first configurations, about the bodies that the algorithm answers for.
  std::span<const Response> exact_responses(const BucketSample& bucket, std::size_t count) {
    if (is_about_meshes()) return resources.cache.exact_responses(pair, key, count);
    if (hull_responses.empty()) {
      hull_responses = hulls()->responses(std::span(bucket.poses).first(std::min(count, PairCache::k_most_exact)));
    }
    return hull_responses;
  }

  /// @throws BadArgument for an empty bucket, NeedsSolid
  const BucketSample& sample() const {
    const BucketSample& bucket = resources.cache.bucket(pair, key);
    if (bucket.poses.empty()) throw BadArgument(key.name() + ": no configuration of this bucket can be reached");
    if (key.kind == BucketKind::volume || question == QueryKind::respond)
      require_solids(resources.cache.mesh(pair.a), resources.cache.mesh(pair.b));
    return bucket;
  }

  /// Of the first `count` configurations those with an answer, in this row's order; or of as many poses of motions from
  /// some of them. Of these, too, those without an answer count as failed.
  std::vector<Pose> poses_to_time(const BucketSample& bucket, std::size_t count) {
    std::vector<Pose> found;
    for (const std::size_t i : order == Order::path ? grid_order(bucket, count) : random_order(count, resources.seed)) {
      if (order == Order::motion || check->answered[i]) found.push_back(bucket.poses[i]);
    }
    if (order != Order::motion) return found;
    const std::size_t size = found.size(), motions = (size + Motion::k_poses - 1) / Motion::k_poses;
    found = poses_of_motions(std::span(found).first(motions), Motion::k_poses, resources.cache.mesh(pair.a),
                             resources.cache.mesh(pair.b), resources.seed);
    found.resize(size);
    with_query(failures, [&](auto query) { std::erase_if(found, [&](const Pose& x) { return !query.ask(x).ok(); }); });
    return found;
  }

  /// Calls use(GuardedQuery) with this row's question.
  template <class Use>
  void with_query(Failures& counted, Use use) const {
    Query& query = resources.cache.query(algorithm, resources.settings_of(algorithm), pair.a, pair.b);
    with_query_kind(query, question, counted, use);
  }

  /// Seconds of an exact response. Near 0 in the second trial of a bucket: the cache has them.
  double time_exact() const {
    resources.cache.exact_responses(pair, key, 1);  // prepares
    const auto start = std::chrono::steady_clock::now();
    resources.cache.exact_responses(pair, key, k_trial);
    return seconds_since(start) / (k_trial - 1.0);
  }

  /// Seconds for a configuration.
  double time_truth_of_hulls(const BucketSample& bucket) const {
    HullTruth& truth = *hulls();  // prepares
    const std::size_t count = std::min(k_trial, bucket.poses.size());
    const auto start = std::chrono::steady_clock::now();
    for (const Pose& pose : std::span(bucket.poses).first(count)) static_cast<void>(truth.at(bucket, pose));
    return seconds_since(start) / static_cast<double>(count);
  }

  double time_eviction() const {
    (*evict)();  // makes the buffer
    const auto start = std::chrono::steady_clock::now();
    (*evict)();
    return seconds_since(start);
  }

  /// Configurations without an answer are left out: they count as failed.
  template <class Ask>
  void compare_with_exact(const BucketSample& bucket, std::span<const Response> exact, GuardedQuery<Ask>& query) {
    VectorSeries forces, torques;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const Outcome<Response> answer = query.ask(bucket.poses[i]);
      if (!answer.ok()) continue;
      const auto [response, scale] = scaled_about(answer.value, exact[i].reference);
      forces.add(exact[i].force, response.force, scale);
      torques.add(exact[i].torque, response.torque, scale);
      places.push_back(i);
    }
    errors = {forces.error(), torques.error()};
    const auto add = [&](const std::string& counter, std::optional<std::size_t> k) {
      if (!k) return;
      const Response& truth = exact[places[*k]];
      worst.add(counter, bucket.poses[places[*k]]);
      worst.responses[counter] = {.force = numbers(forces.measured[*k]),
                                  .torque = numbers(torques.measured[*k]),
                                  .exact_force = numbers(truth.force),
                                  .exact_torque = numbers(truth.torque),
                                  .reference = numbers(truth.reference)};
    };
    add("gamma_max_F_deg", forces.largest_angle(errors->at(0).direction));
    add("gamma_max_T_deg", torques.largest_angle(errors->at(1).direction));
    if (errors->at(0).magnitude) add("magnitude_error_F", forces.largest_difference(errors->at(0).magnitude->gain));
    if (errors->at(1).magnitude) add("magnitude_error_T", torques.largest_difference(errors->at(1).magnitude->gain));
  }

  void report_phantoms(benchmark::State& state) const {
    state.counters["phantoms"] = static_cast<double>(check->phantoms);
    if (check->phantoms > 0 && !force_scale) return;
    const double scale = force_scale.value_or(1.0);
    state.counters["phantom_force_mean"] = check->phantom_forces.mean() / scale;
    state.counters["phantom_force_max"] = check->phantom_forces.largest() / scale;
  }

  /// After compare_with_exact(): the truth of an algorithm of the volume is the same.
  /// @param count configurations that were compared there
  template <class Ask>
  void compare_with_own(const BucketSample& bucket, std::size_t count, GuardedQuery<Ask>& query) {
    const ResponseLaw law = judged_law(algorithm.traits().law);
    if (law == ResponseLaw::volume) own = {.errors = errors};
    if (!is_of_depth(law) || !is_about_meshes() || key.kind != BucketKind::volume) return;
    const std::span<const Pose> compared = std::span(bucket.poses).first(count);
    own = compare_with_law(resources.cache.depth_truths(pair).at(compared, law),
                           [&](std::size_t i) { return query.ask(compared[i]); });
  }

  void report(benchmark::State& state, const BucketSample& bucket) const {
    const auto count = [&](const std::string& counter, auto value) {
      state.counters[counter] = static_cast<double>(value);
    };
    count("p10_ns", latency.p10);
    count("p25_ns", latency.p25);
    count("p50_ns", latency.p50);
    count("p75_ns", latency.p75);
    count("p90_ns", latency.p90);
    if (latency.p99) count("p99_ns", *latency.p99);
    if (latency.p999) count("p999_ns", *latency.p999);
    count("max_ns", latency.max);
    count("over_1ms", latency.over_deadline);
    if (least && least->p99) count("p99_least_ns", *least->p99);
    if (least) count("max_least_ns", least->max);
    count("configurations", check->answered.size());
    count("reachable", bucket.reachable);
    count("failed", failures.count());
    count_statuses(state.counters, failures);
    count("judged", check->judged);
    count("mismatch", check->wrong);
    if (empty_call_ns) count(k_empty_call, *empty_call_ns);
    check->work.report(state.counters);
    if (question == QueryKind::distance) {
      count("error_rms", check->errors.rms());
      count("error_max", check->errors.largest());
    }
    if (question == QueryKind::respond && !has_exact()) report_phantoms(state);
    if (has_exact()) {
      count("misses", check->missed);
      if (check->judged > 0) {
        count("volume_error_mean", check->errors.mean());
        count("volume_error_max", check->errors.largest());
      }
      for (const auto& [error, suffix] : {std::pair(&errors->at(0), "F"), {&errors->at(1), "T"}}) {
        if (error->magnitude) {
          count(fmt::format("gain_{}", suffix), error->magnitude->gain);
          count(fmt::format("magnitude_error_{}", suffix), error->magnitude->relative);
        }
        if (!error->direction.gamma_degrees) continue;
        count(fmt::format("gamma_{}_deg", suffix), *error->direction.gamma_degrees);
        count(fmt::format("gamma_max_{}_deg", suffix), error->direction.largest_degrees);
      }
      count("compared", errors->at(0).direction.compared);
      own.report(state.counters);
    }
    std::string label = resources.settings_of(algorithm).to_string();
    if (!is_about_meshes()) {
      label += fmt::format("{}{} instead of the mesh, judged by the hulls", label.empty() ? "" : "; ",
                           to_string(algorithm.traits().body));
    }
    if (failures.count() > 0) {
      label += fmt::format("{}first failure: {}", label.empty() ? "" : "; ", failures.first());
    }
    if (empty_call_ns) {
      label += fmt::format("{}an empty call takes {:.2g} us", label.empty() ? "" : "; ", 1e-3 * *empty_call_ns);
    }
    if (timed_outside) label += fmt::format("{}times include communication", label.empty() ? "" : "; ");
    state.SetLabel(label);
  }
};

}  // namespace

std::vector<PlannedRow> query_rows(const Resources& resources) {
  std::vector<PlannedRow> rows;
  const auto evict = std::make_shared<CacheEviction>();
  for (const CatalogueEntry& pair : resources.catalogue.sets()) {
    for (const auto& algorithm : resources.registry.all()) {
      if (!algorithm->traits().timed) continue;
      const auto add = [&](BucketKey key, QueryKind question) {
        for (const auto& [order, cold] :
             {std::pair(Order::random, false), {Order::path, false}, {Order::motion, false}, {Order::random, true}}) {
          const auto row = std::make_shared<QueryRow>(QueryRow{resources, *algorithm, pair, key, question, order,
                                                               cold ? evict : std::shared_ptr<CacheEviction>()});
          rows.push_back({.name = row->name(),
                          .run = [row](benchmark::State& state, const Share& share) { row->run(state, share); },
                          .fields = row->fields(),
                          .trial = [row](double seconds) { return row->trial(seconds); },
                          .outliers = [row] { return row->outliers(); },
                          .one_round = cold,
                          .manual_time = is_isolated(*algorithm)});
        }
      };
      for (const BucketKey key : pair.buckets) {
        for (const QueryKind question : k_query_kinds) {
          if (answers(algorithm->traits().answers, question) && has_row(key, question)) add(key, question);
        }
      }
    }
  }
  return rows;
}

}  // namespace sixdof::bench
