#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/measure/direction.h>
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

const char* to_string(Question question) {
  switch (question) {
    case Question::collide:
      return "collide";
    case Question::distance:
      return "distance";
    case Question::respond:
      return "respond";
  }
  return "";
}

enum class Order {
  shuffled,
  path
};

/// A row asks each configuration about six times: once in the check, in one or two timed rounds, and in the passes that
/// time single queries. The check gets this part of the row's time.
constexpr double k_passes = 3.0 + k_latency_passes;
/// Fraction of the row's time for the exact responses that answers are compared with.
constexpr double k_exact_time = 0.1;

/// The same wrench about another point, scaled down where moving the torque might overflow; directions do not change.
Response about(Response response, const Eigen::Vector3d& point) {
  constexpr double k_large = 1e100;
  const double largest = std::max(response.force.cwiseAbs().maxCoeff(), response.torque.cwiseAbs().maxCoeff());
  if (largest > k_large) {
    response.force /= largest;
    response.torque /= largest;
  }
  return response.about(point);
}

/// One row, and what its first call measured.
class QueryRow {
 public:
  QueryRow(const Resources& resources, const Algorithm& algorithm, const CatalogueEntry& pair, BucketKey key,
           Question question, Order order)
      : resources_(resources), algorithm_(algorithm), pair_(pair), key_(key), question_(question), order_(order) {}

  std::string name() const {
    std::string bucket = key_.name();
    bucket.at(bucket.find('/')) = ':';
    return fmt::format("{}/algorithm:{}/pair:{}/{}{}", to_string(question_), algorithm_.traits().name, pair_.pair,
                       bucket, order_ == Order::path ? "/order:path" : "");
  }

  void run(benchmark::State& state, double seconds) {
    PairCache& cache = resources_.cache;
    const BucketSample& bucket = cache.bucket(pair_, key_);
    if (bucket.poses.empty()) throw BadArgument(key_.name() + ": no configuration of this bucket can be reached");
    if (key_.kind == BucketKind::volume) require_solids(cache.mesh(pair_.a), cache.mesh(pair_.b));
    const std::vector<Response>* const exact =
        question_ == Question::respond ? &cache.exact_responses(pair_, key_, k_exact_time * seconds) : nullptr;
    Query& query = cache.query(algorithm_, resources_.settings_of(algorithm_), pair_.a, pair_.b);
    if (question_ == Question::collide) {
      const auto ask = [&query](const Pose& pose) { return query.collide(pose); };
      run(state, bucket, GuardedQuery(query, ask, failures_), seconds);
    } else if (question_ == Question::distance) {
      const auto ask = [&query](const Pose& pose) { return query.distance(pose); };
      run(state, bucket, GuardedQuery(query, ask, failures_), seconds);
    } else {
      const auto ask = [&query](const Pose& pose) { return query.respond(pose); };
      GuardedQuery guarded(query, ask, failures_);
      if (!directions_) compare_directions(bucket, *exact, guarded);
      run(state, bucket, guarded, seconds);
    }
  }

 private:
  template <class Ask>
  void run(benchmark::State& state, const BucketSample& bucket, GuardedQuery<Ask> query, double seconds) {
    if (!check_) {
      check_ = check_answers(bucket, query, seconds / k_passes);
      poses_ = order_ == Order::path ? check_->answered
                                     : shuffled(check_->answered, check_->answered.size(), resources_.seed);
      check_->answered.clear();
      latency_ = time_each(poses_, query);
    }
    if (poses_.empty()) throw Error(fmt::format("no configuration has an answer: {}", failures_.first()));
    time_mean(state, poses_, query);
    report(state, bucket);
  }

  /// A configuration without an answer counts as one without force and torque.
  template <class Ask>
  void compare_directions(const BucketSample& bucket, const std::vector<Response>& exact, GuardedQuery<Ask>& query) {
    std::vector<Eigen::Vector3d> exact_forces, exact_torques, forces, torques;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const Outcome<Response> answer = query.ask(bucket.poses[i]);
      const Response response = answer.ok() ? about(answer.value, exact[i].reference) : Response{};
      exact_forces.push_back(exact[i].force);
      exact_torques.push_back(exact[i].torque);
      forces.push_back(response.force);
      torques.push_back(response.torque);
    }
    directions_ = {direction_error(exact_forces, forces), direction_error(exact_torques, torques)};
  }

  void report(benchmark::State& state, const BucketSample& bucket) const {
    const auto count = [&](const char* name, auto value) { state.counters[name] = static_cast<double>(value); };
    count("p50_ns", latency_.p50);
    count("p99_ns", latency_.p99);
    count("p999_ns", latency_.p999);
    count("max_ns", latency_.max);
    count("over_1ms", latency_.over_deadline);
    count("configurations", check_->asked);
    count("reachable", bucket.reachable);
    count("failed", failures_.count());
    count("judged", check_->judged);
    count("mismatch", check_->mismatch);
    check_->work.report(state.counters);
    if (question_ == Question::distance) {
      count("error_rms", check_->errors.rms());
      count("error_max", check_->errors.largest());
    }
    if (question_ == Question::respond) {
      count("misses", check_->misses);
      if (check_->judged > 0) {
        count("volume_error_mean", check_->errors.mean());
        count("volume_error_max", check_->errors.largest());
      }
      const auto& [force, torque] = *directions_;
      if (force.gamma_degrees) {
        count("gamma_F_deg", *force.gamma_degrees);
        count("gamma_max_F_deg", force.largest_degrees);
      }
      if (torque.gamma_degrees) {
        count("gamma_T_deg", *torque.gamma_degrees);
        count("gamma_max_T_deg", torque.largest_degrees);
      }
      count("compared", force.compared);
    }
    std::string label = resources_.settings_of(algorithm_).to_string();
    if (failures_.count() > 0) {
      label += fmt::format("{}first failure: {}", label.empty() ? "" : "; ", failures_.first());
    }
    state.SetLabel(label);
  }

  const Resources& resources_;
  const Algorithm& algorithm_;
  const CatalogueEntry& pair_;
  const BucketKey key_;
  const Question question_;
  const Order order_;
  Failures failures_;
  std::optional<Check> check_;
  std::vector<Pose> poses_;  ///< Those with an answer, in this row's order.
  Latency latency_;
  struct Directions {
    DirectionError force, torque;
  };
  std::optional<Directions> directions_;  ///< To the exact responses; torques about the centre of B's box.
};

void add_rows(const Resources& resources, const Algorithm& algorithm, const CatalogueEntry& pair, BucketKey key,
              Question question, std::vector<Row>& rows) {
  for (const Order order : {Order::shuffled, Order::path}) {
    const auto row = std::make_shared<QueryRow>(resources, algorithm, pair, key, question, order);
    rows.push_back(
        {.name = row->name(), .run = [row](benchmark::State& state, double seconds) { row->run(state, seconds); }});
  }
}

}  // namespace

std::vector<Row> query_rows(const Resources& resources) {
  std::vector<Row> rows;
  for (const CatalogueEntry& pair : resources.catalogue.sets()) {
    for (const auto& algorithm : resources.registry.all()) {
      if (!algorithm->traits().timed) continue;
      const QuerySet& answers = algorithm->traits().answers;
      for (const BucketKey key : pair.buckets) {
        if (answers.collide) add_rows(resources, *algorithm, pair, key, Question::collide, rows);
        // The distance of overlapping bodies is 0 by definition: nothing to measure.
        if (answers.distance && key.kind == BucketKind::distance) {
          add_rows(resources, *algorithm, pair, key, Question::distance, rows);
        }
        // Bodies that only touch have no force.
        if (answers.respond && key.kind == BucketKind::volume && key.percent > 0) {
          add_rows(resources, *algorithm, pair, key, Question::respond, rows);
        }
      }
    }
  }
  return rows;
}

}  // namespace sixdof::bench
