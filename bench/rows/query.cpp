#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/measure/direction.h>
#include <sixdof/measure/magnitude.h>
#include "bench/harness/check.h"
#include "bench/harness/timing.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

enum class Question {
  collide,
  distance,
  respond
};
constexpr const char* k_questions[] = {"collide", "distance", "respond"};

/// A row asks each configuration about six times: once in the check, in one or two timed rounds, and in the passes that
/// time single queries. The check gets this part of the row's time.
constexpr double k_passes = 3.0 + k_latency_passes;
/// Fraction of the row's time for the exact responses that answers are compared with.
constexpr double k_exact_time = 0.1;

/// Directions and magnitudes of forces or torques against those of the exact responses.
struct VectorError {
  DirectionError direction;
  std::optional<MagnitudeError> magnitude;
};

/// A series of forces or torques with the exact ones.
struct VectorSeries {
  std::vector<Eigen::Vector3d> exact, measured;
  std::vector<double> exact_magnitudes, magnitudes;

  /// @param scale of `vector`: its true length is |vector| / scale
  void add(const Eigen::Vector3d& exact_vector, const Eigen::Vector3d& vector, double scale) {
    exact.push_back(exact_vector);
    measured.push_back(vector);
    exact_magnitudes.push_back(exact_vector.norm());
    magnitudes.push_back(std::min(vector.stableNorm() / scale, Errors::k_largest));
  }
  VectorError error() const {
    return {direction_error(exact, measured), magnitude_error(exact_magnitudes, magnitudes)};
  }
};

/// The same wrench about another point, times `scale`, which is less than 1 where moving the torque might overflow.
struct ScaledResponse {
  Response response;
  double scale = 1.0;
};

ScaledResponse about(Response response, const Eigen::Vector3d& point) {
  constexpr double k_large = 1e100;
  const double largest = std::max(response.force.cwiseAbs().maxCoeff(), response.torque.cwiseAbs().maxCoeff());
  const double scale = largest > k_large ? 1.0 / largest : 1.0;
  response.force *= scale;
  response.torque *= scale;
  return {response.about(point), scale};
}

/// One row, and what its first call measured.
struct QueryRow {
  const Resources& resources;
  const Algorithm& algorithm;
  const CatalogueEntry& pair;
  BucketKey key;
  Question question;
  bool path;  ///< In the grid's own order instead of a random one.
  Failures failures = {};
  std::optional<Check> check = {};
  std::vector<Pose> poses = {};  ///< Those with an answer, in this row's order.
  Latency latency = {};
  /// Of the force and of the torque about the centre of B's box, to the exact responses.
  std::optional<std::array<VectorError, 2>> errors = {};

  RowFields fields() const {
    return {.query = k_questions[static_cast<std::size_t>(question)],
            .algorithm = algorithm.traits().name,
            .settings = resources.settings_of(algorithm).to_string(),
            .pair = pair.pair,
            .bucket = key,
            .order = path ? "path" : "random"};
  }

  std::string name() const {
    std::string bucket = key.name();
    bucket.at(bucket.find('/')) = ':';
    return fmt::format("{}/algorithm:{}/pair:{}/{}{}", k_questions[static_cast<std::size_t>(question)],
                       algorithm.traits().name, pair.pair, bucket, path ? "/order:path" : "");
  }

  void run(benchmark::State& state, double seconds) {
    PairCache& cache = resources.cache;
    const BucketSample& bucket = cache.bucket(pair, key);
    if (bucket.poses.empty()) throw BadArgument(key.name() + ": no configuration of this bucket can be reached");
    if (key.kind == BucketKind::volume) require_solids(cache.mesh(pair.a), cache.mesh(pair.b));
    const std::vector<Response>* const exact =
        question == Question::respond ? &cache.exact_responses(pair, key, k_exact_time * seconds) : nullptr;
    Query& query = cache.query(algorithm, resources.settings_of(algorithm), pair.a, pair.b);
    if (question == Question::collide) {
      const auto ask = [&query](const Pose& pose) { return query.collide(pose); };
      run(state, bucket, GuardedQuery(query, ask, failures), seconds);
    } else if (question == Question::distance) {
      const auto ask = [&query](const Pose& pose) { return query.distance(pose); };
      run(state, bucket, GuardedQuery(query, ask, failures), seconds);
    } else {
      const auto ask = [&query](const Pose& pose) { return query.respond(pose); };
      GuardedQuery guarded(query, ask, failures);
      if (!errors) compare_with_exact(bucket, *exact, guarded);
      run(state, bucket, guarded, seconds);
    }
  }

  template <class Ask>
  void run(benchmark::State& state, const BucketSample& bucket, GuardedQuery<Ask> query, double seconds) {
    if (!check) {
      check = check_answers(bucket, query, seconds / k_passes);
      poses = path ? check->answered : shuffled(check->answered, check->answered.size(), resources.seed);
      check->answered.clear();
      latency = time_each(poses, query);
    }
    if (poses.empty()) throw Error(fmt::format("no configuration has an answer: {}", failures.first()));
    time_mean(state, poses, query);
    report(state, bucket);
  }

  /// Configurations without an answer are left out: they count as failed.
  template <class Ask>
  void compare_with_exact(const BucketSample& bucket, const std::vector<Response>& exact, GuardedQuery<Ask>& query) {
    VectorSeries forces, torques;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const Outcome<Response> answer = query.ask(bucket.poses[i]);
      if (!answer.ok()) continue;
      const auto [response, scale] = about(answer.value, exact[i].reference);
      forces.add(exact[i].force, response.force, scale);
      torques.add(exact[i].torque, response.torque, scale);
    }
    errors = {forces.error(), torques.error()};
  }

  void report(benchmark::State& state, const BucketSample& bucket) const {
    const auto count = [&](const std::string& counter, auto value) {
      state.counters[counter] = static_cast<double>(value);
    };
    count("p50_ns", latency.p50);
    count("p99_ns", latency.p99);
    count("p999_ns", latency.p999);
    count("max_ns", latency.max);
    count("over_1ms", latency.over_deadline);
    count("configurations", check->asked);
    count("reachable", bucket.reachable);
    count("failed", failures.count());
    count("judged", check->judged);
    count("mismatch", check->mismatch);
    check->work.report(state.counters);
    if (question == Question::distance) {
      count("error_rms", check->errors.rms());
      count("error_max", check->errors.largest());
    }
    if (question == Question::respond) {
      count("misses", check->misses);
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
    }
    std::string label = resources.settings_of(algorithm).to_string();
    if (failures.count() > 0) {
      label += fmt::format("{}first failure: {}", label.empty() ? "" : "; ", failures.first());
    }
    state.SetLabel(label);
  }
};

}  // namespace

std::vector<Row> query_rows(const Resources& resources) {
  std::vector<Row> rows;
  for (const CatalogueEntry& pair : resources.catalogue.sets()) {
    for (const auto& algorithm : resources.registry.all()) {
      if (!algorithm->traits().timed) continue;
      const auto add = [&](BucketKey key, Question question) {
        for (const bool path : {false, true}) {
          const auto row = std::make_shared<QueryRow>(resources, *algorithm, pair, key, question, path);
          rows.push_back({.name = row->name(),
                          .run = [row](benchmark::State& state, double seconds) { row->run(state, seconds); },
                          .fields = row->fields()});
        }
      };
      const QuerySet& answers = algorithm->traits().answers;
      for (const BucketKey key : pair.buckets) {
        if (answers.collide) add(key, Question::collide);
        // The distance of overlapping bodies is 0 by definition: nothing to measure.
        if (answers.distance && key.kind == BucketKind::distance) add(key, Question::distance);
        // Bodies that only touch have no force.
        if (answers.respond && key.kind == BucketKind::volume && key.percent > 0) add(key, Question::respond);
      }
    }
  }
  return rows;
}

}  // namespace sixdof::bench
