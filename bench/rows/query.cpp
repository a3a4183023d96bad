#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/bench/harness/check.h>
#include <sixdof/bench/harness/timing.h>
#include <sixdof/bench/rows/families.h>

namespace sixdof::bench {
namespace {

enum class Question {
  collide,
  distance
};

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
  QueryRow(Suite& suite, const Algorithm& algorithm, const CatalogueSet& pair, BucketKey key, Question question,
           Order order)
      : suite_(suite), algorithm_(algorithm), pair_(pair), key_(key), question_(question), order_(order) {}

  std::string name() const {
    std::string bucket = key_.name();
    bucket.at(bucket.find('/')) = ':';
    return fmt::format("{}/algorithm:{}/pair:{}/{}{}", question_ == Question::collide ? "collide" : "distance",
                       algorithm_.traits().name, pair_.pair, bucket, order_ == Order::path ? "/order:path" : "");
  }

  void run(benchmark::State& state) {
    Query& query = suite_.stock().query(algorithm_, suite_.settings(algorithm_), pair_.a, pair_.b);
    const BucketSample& bucket = suite_.stock().bucket(pair_, key_);
    if (bucket.poses.empty()) throw BadArgument(key_.name() + ": no configuration of this bucket can be reached");
    if (question_ == Question::collide) {
      run(state, bucket, query, [&query](const Pose& pose) { return query.collide(pose); });
    } else {
      run(state, bucket, query, [&query](const Pose& pose) { return query.distance(pose); });
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
    if (question_ == Question::distance) {
      count("error_rms", check_->rms_error());
      count("error_max", check_->largest_error);
    }
    std::string label = suite_.settings(algorithm_).to_string();
    if (check_->failed > 0) label += fmt::format("{}first failure: {}", label.empty() ? "" : "; ", check_->diagnosis);
    state.SetLabel(label);
  }

  Suite& suite_;
  const Algorithm& algorithm_;
  const CatalogueSet& pair_;
  const BucketKey key_;
  const Question question_;
  const Order order_;
  std::optional<Check> check_;
  std::vector<Pose> poses_;  ///< Those that were checked, in this row's order.
  std::optional<Latency> latency_;
};

void add_row(Suite& suite, const Algorithm& algorithm, const CatalogueSet& pair, BucketKey key, Question question) {
  for (const Order order : {Order::shuffled, Order::path}) {
    const auto row = std::make_shared<QueryRow>(suite, algorithm, pair, key, question, order);
    suite.add(row->name(), [row](benchmark::State& state) { row->run(state); });
  }
}

}  // namespace

void add_query_rows(Suite& suite) {
  for (const CatalogueSet& pair : suite.catalogue().sets()) {
    for (const auto& algorithm : suite.registry().all()) {
      const QuerySet& answers = algorithm->traits().answers;
      for (const BucketKey key : pair.buckets) {
        if (answers.collide) add_row(suite, *algorithm, pair, key, Question::collide);
        // The distance of overlapping bodies is 0 by definition: nothing to measure.
        if (answers.distance && key.kind == BucketKind::distance) {
          add_row(suite, *algorithm, pair, key, Question::distance);
        }
      }
    }
  }
}

}  // namespace sixdof::bench
