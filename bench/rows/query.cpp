#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include "bench/harness/check.h"
#include "bench/harness/timing.h"
#include "bench/rows/families.h"
#include <sixdof/measure/direction.h>

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

/// A row asks each configuration about six times: once to check, in up to two timed rounds, and in the passes that time
/// each query by itself. Its first pass gets that share of the row's time.
constexpr double k_passes = 3.0 + k_latency_passes;

/// One row, and what it did in its first call.
class QueryRow {
 public:
  QueryRow(Suite& suite, const Algorithm& algorithm, const CatalogueEntry& pair, BucketKey key, Question question,
           Order order)
      : suite_(suite), algorithm_(algorithm), pair_(pair), key_(key), question_(question), order_(order) {}

  std::string name() const {
    std::string bucket = key_.name();
    bucket.at(bucket.find('/')) = ':';
    return fmt::format("{}/algorithm:{}/pair:{}/{}{}", to_string(question_), algorithm_.traits().name, pair_.pair,
                       bucket, order_ == Order::path ? "/order:path" : "");
  }

  void run(benchmark::State& state) {
    const BucketSample& bucket = suite_.stock().bucket(pair_, key_);
    constexpr double k_share_of_truth = 0.1;  // of the row's time
    const std::vector<Response>* const truth =
        question_ == Question::respond
            ? &suite_.stock().true_responses(pair_, key_, k_share_of_truth * suite_.row_budget_s())
            : nullptr;
    Query& query = suite_.stock().query(algorithm_, suite_.settings(algorithm_), pair_.a, pair_.b);
    if (bucket.poses.empty()) throw BadArgument(key_.name() + ": no configuration of this bucket can be reached");
    if (question_ == Question::collide) {
      run(state, bucket, query, [&query](const Pose& pose) { return query.collide(pose); });
    } else if (question_ == Question::distance) {
      run(state, bucket, query, [&query](const Pose& pose) { return query.distance(pose); });
    } else {
      if (!directions_) compare_directions(bucket, *truth, query);
      run(state, bucket, query, [&query](const Pose& pose) { return query.respond(pose); });
    }
  }

 private:
  template <class Ask>
  void run(benchmark::State& state, const BucketSample& bucket, const Query& query, Ask ask) {
    if (!check_) prepare(bucket, query, ask);
    time_mean(state, poses_, ask);
    if (!latency_) latency_ = time_each(poses_, ask);
    report(state, bucket);
  }

  template <class Ask>
  void prepare(const BucketSample& bucket, const Query& query, Ask ask) {
    check_ = check_answers(bucket, ask, query, suite_.row_budget_s() / k_passes);
    poses_ = order_ == Order::shuffled
                 ? shuffled(bucket.poses, check_->asked, suite_.options().seed)
                 : std::vector<Pose>(bucket.poses.begin(),
                                     bucket.poses.begin() + static_cast<std::ptrdiff_t>(check_->asked));
  }

  /// A configuration without an answer counts as one without force and torque. Torques are about the centre of B's box.
  void compare_directions(const BucketSample& bucket, const std::vector<Response>& truth, Query& query) {
    std::vector<Eigen::Vector3d> true_forces, true_torques, forces, torques;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const Outcome<Response> answer = query.respond(bucket.poses[i]);
      const Response response = answer.ok() ? answer.value.about(truth[i].reference) : Response{};
      true_forces.push_back(truth[i].force);
      true_torques.push_back(truth[i].torque);
      forces.push_back(response.force);
      torques.push_back(response.torque);
    }
    directions_ = {direction_error(true_forces, forces), direction_error(true_torques, torques)};
  }

  void report(benchmark::State& state, const BucketSample& bucket) const {
    const auto count = [&](const char* name, auto value) { state.counters[name] = static_cast<double>(value); };
    count("p50_ns", latency_->p50_ns);
    count("p99_ns", latency_->p99_ns);
    count("p999_ns", latency_->p999_ns);
    count("max_ns", latency_->max_ns);
    count("over_1ms", latency_->over_1ms);
    count("configurations", check_->asked);
    count("reachable", bucket.reachable);
    count("failed", check_->failed);
    count("judged", check_->judged);
    count("mismatch", check_->mismatch);
    check_->work.report(state.counters);
    if (question_ == Question::distance) {
      count("error_rms", check_->rms_error());
      count("error_max", check_->largest_error);
    }
    if (question_ == Question::respond) {
      count("misses", check_->misses);
      if (check_->judged > 0) {
        count("volume_error_mean", check_->mean_error());
        count("volume_error_max", check_->largest_error);
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
    std::string label = suite_.settings(algorithm_).to_string();
    if (check_->failed > 0) label += fmt::format("{}first failure: {}", label.empty() ? "" : "; ", check_->diagnosis);
    state.SetLabel(label);
  }

  Suite& suite_;
  const Algorithm& algorithm_;
  const CatalogueEntry& pair_;
  const BucketKey key_;
  const Question question_;
  const Order order_;
  std::optional<Check> check_;
  std::vector<Pose> poses_;  ///< Those that were checked, in this row's order.
  std::optional<Latency> latency_;
  struct Directions {
    DirectionError force, torque;
  };
  std::optional<Directions> directions_;  ///< Against the exact ones.
};

void add_row(Suite& suite, const Algorithm& algorithm, const CatalogueEntry& pair, BucketKey key, Question question) {
  for (const Order order : {Order::shuffled, Order::path}) {
    const auto row = std::make_shared<QueryRow>(suite, algorithm, pair, key, question, order);
    suite.add(row->name(), [row](benchmark::State& state) { row->run(state); });
  }
}

}  // namespace

void add_query_rows(Suite& suite) {
  for (const CatalogueEntry& pair : suite.catalogue().sets()) {
    for (const auto& algorithm : suite.registry().all()) {
      if (!algorithm->traits().timed) continue;
      const QuerySet& answers = algorithm->traits().answers;
      for (const BucketKey key : pair.buckets) {
        if (answers.collide) add_row(suite, *algorithm, pair, key, Question::collide);
        // The distance of overlapping bodies is 0 by definition: nothing to measure.
        if (answers.distance && key.kind == BucketKind::distance) {
          add_row(suite, *algorithm, pair, key, Question::distance);
        }
        // Bodies that only touch do not push.
        if (answers.respond && key.kind == BucketKind::volume && key.percent > 0) {
          add_row(suite, *algorithm, pair, key, Question::respond);
        }
      }
    }
  }
}

}  // namespace sixdof::bench
