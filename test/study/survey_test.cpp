#include "bench/study/survey.h"

#include <memory>

#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/models/model_catalogue.h>

#include "../configuration/small_suite.h"

namespace sixdof::study {
namespace {

using bench::QueryKind;

constexpr BucketKey k_apart{BucketKind::distance, 5}, k_overlapping{BucketKind::volume, 3};
constexpr double k_rounding = 1e-12;  // of sums in another order

/// Answers as `exact`, but with a force of 2 and 1 more volume where B's centre is above A's, and not at all at one
/// pose.
class Wrong final : public Query {
 public:
  Wrong(const Mesh& a, const Mesh& b, const Pose& silent) : exact_(prepared(a, b)), silent_(silent) {}

  Outcome<Response> respond(const Pose& X_AB) override {
    ++asked;
    if (X_AB.t == silent_.t && X_AB.R == silent_.R) return fail(Status::failed, "gave up");
    Outcome<Response> answer = exact_->respond(X_AB);
    if (X_AB.t.z() > 0.0) answer.value.force = {0.0, 2.0, 0.0};
    return answer;
  }
  Outcome<Separation> distance(const Pose& X_AB) override { return exact_->distance(X_AB); }

  std::size_t asked = 0;

  static std::unique_ptr<Query> prepared(const Mesh& a, const Mesh& b) {
    const auto exact = make_exact_algorithm();
    return exact->prepare(a, b, exact->settings());
  }

 private:
  std::unique_ptr<Query> exact_;
  const Pose silent_;
};

struct Survey : ::testing::Test {
  const ConfigurationSet set{SIXDOF_SMALL_SUITE "/torus-1k.h5"};
  const Mesh mesh = load_model("torus-1k");
  const BucketSample all_apart = sample_bucket(set, k_apart, mesh, mesh, 0, 7);
  Wrong query{mesh, mesh, all_apart.poses.at(3)};

  SurveyCell ask(BucketKey key, QueryKind question, ShardNumber shard = {}, std::size_t sample = 0) {
    return survey_bucket(set, key, question, mesh, mesh, query, {.shard = shard, .sample = sample});
  }
};

TEST_F(Survey, AsksEveryConfigurationAndFindsWhatIsWrong) {
  const SurveyCell cell = ask(k_apart, QueryKind::respond);
  std::size_t above = 0;
  const Pose& silent = all_apart.poses[3];
  for (const Pose& X_AB : all_apart.poses) {
    above += X_AB.t.z() > 0.0 && (X_AB.t != silent.t || X_AB.R != silent.R);
  }
  EXPECT_EQ(cell.configurations, test::SmallSuite::k_configurations);
  EXPECT_EQ(cell.reachable, all_apart.poses.size());
  EXPECT_EQ(cell.asked, cell.reachable);
  EXPECT_EQ(cell.failed, 1u);
  EXPECT_EQ(cell.phantoms, above);
  EXPECT_EQ(cell.wrong, above) << "the bodies are as they are";
  EXPECT_EQ(cell.phantom_max, 2.0);
  EXPECT_NEAR(cell.phantom_sum, 2.0 * static_cast<double>(above), k_rounding);
  EXPECT_GT(cell.sum_ns, 0.0);
  EXPECT_GE(cell.max_ns, cell.sum_ns / static_cast<double>(cell.answered()));
  EXPECT_LE(cell.max_least_ns, cell.max_ns);
  for (const char* const counter : {"max_ns", "max_least_ns", "mismatch", "phantom_force_max", "failed"}) {
    EXPECT_TRUE(cell.poses.contains(counter)) << counter;
  }
  const SurveyCell distances = ask(k_apart, QueryKind::distance);
  EXPECT_EQ(distances.judged, distances.reachable);
  EXPECT_EQ(distances.wrong, 0u);
}

TEST_F(Survey, ShardsAddUpToTheWhole) {
  for (const BucketKey key : {k_apart, k_overlapping}) {
    const SurveyCell whole = ask(key, QueryKind::respond);
    SurveyCell sum = ask(key, QueryKind::respond, {1, 5});
    for (std::size_t number = 2; number <= 5; ++number) add_to(sum, ask(key, QueryKind::respond, {number, 5}));
    EXPECT_EQ(sum.configurations, whole.configurations);
    EXPECT_EQ(sum.asked, whole.asked);
    EXPECT_EQ(sum.failed, whole.failed);
    EXPECT_EQ(sum.judged, whole.judged);
    EXPECT_EQ(sum.wrong, whole.wrong);
    EXPECT_EQ(sum.phantoms, whole.phantoms);
    EXPECT_NEAR(sum.error_max, whole.error_max, k_rounding);
    EXPECT_NEAR(sum.force_sum, whole.force_sum, k_rounding * whole.force_sum);
    EXPECT_NEAR(sum.error_squares, whole.error_squares, k_rounding * whole.error_squares);
    EXPECT_EQ(sum.poses.contains("volume_error_max"), key == k_overlapping);
  }
}

TEST_F(Survey, AsksASampleWhereItIsTold) {
  const SurveyCell cell = ask(k_overlapping, QueryKind::respond, {2, 3}, 10);
  EXPECT_EQ(cell.asked, 10u);
  EXPECT_GT(cell.reachable, 10u);
  EXPECT_EQ(cell.configurations, test::SmallSuite::k_configurations / 3);
  EXPECT_GE(query.asked, 10u);
  EXPECT_LE(query.asked, 30u) << "what seems the longest is asked three times";
}

}  // namespace
}  // namespace sixdof::study
