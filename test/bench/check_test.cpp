#include "bench/harness/check.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof::bench {
namespace {

BucketSample bucket(BucketKind kind, double percent, double target) {
  return {.key = {kind, percent}, .target = target, .tolerance = 1e-3, .diagonal = 10.0};
}

Check judged(const BucketSample& sample, auto answer) {
  Check check;
  judge(sample, answer, check);
  return check;
}

Separation at(double distance) { return {.distance = distance}; }

TEST(Judge, YesAndNoByKindOfBucket) {
  EXPECT_EQ(judged(bucket(BucketKind::distance, 5, 0.5), true).mismatch, 1u);
  EXPECT_EQ(judged(bucket(BucketKind::distance, 5, 0.5), false).mismatch, 0u);
  EXPECT_EQ(judged(bucket(BucketKind::volume, 3, 0.5), true).mismatch, 0u);
  EXPECT_EQ(judged(bucket(BucketKind::volume, 3, 0.5), false).mismatch, 1u);
}

TEST(Judge, TouchingMayBeCalledEitherWay) {
  for (const bool answer : {false, true}) {
    EXPECT_EQ(judged(bucket(BucketKind::distance, 0, 1e-9), answer).judged, 0u);
  }
}

TEST(Judge, DistancesWithinTheSetsToleranceAndTheSlack) {
  const BucketSample sample = bucket(BucketKind::distance, 5, 0.5);
  // Tolerance 1e-3 and slack 1e-9 of a diagonal of 10.
  for (const double right : {0.5, 0.501, 0.499, 0.501 + 0.9e-8}) EXPECT_EQ(judged(sample, at(right)).mismatch, 0u);
  for (const double wrong : {0.501 + 1.1e-8, 0.4989, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(judged(sample, at(wrong)).mismatch, 1u) << wrong;
  }
  EXPECT_EQ(judged(bucket(BucketKind::distance, 0, 1e-9), at(0.0)).judged, 1u);
  EXPECT_EQ(judged(bucket(BucketKind::volume, 3, 0.5), at(0.5)).mismatch, 1u);
}

TEST(Judge, ErrorsAreInDiagonals) {
  Check check;
  const BucketSample sample = bucket(BucketKind::distance, 5, 0.5);
  judge(sample, at(0.9), check);
  judge(sample, at(0.2), check);
  EXPECT_DOUBLE_EQ(check.errors.largest(), 0.04);
  EXPECT_DOUBLE_EQ(check.errors.rms(), std::sqrt((0.04 * 0.04 + 0.03 * 0.03) / 2));
}

TEST(Errors, HaveFiniteMeans) {
  Errors errors;
  EXPECT_EQ(errors.mean(), 0.0);
  EXPECT_EQ(errors.largest(), 0.0);
  for (const double error : {3.0, 4.0}) errors.add(error);
  EXPECT_EQ(errors.mean(), 3.5);
  EXPECT_DOUBLE_EQ(errors.rms(), std::sqrt(12.5));
  for (int i = 0; i < 2; ++i) errors.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(errors.largest(), Errors::k_largest);
  EXPECT_DOUBLE_EQ(errors.mean(), 0.5 * Errors::k_largest);
  EXPECT_DOUBLE_EQ(errors.rms(), Errors::k_largest * std::sqrt(0.5));
}

TEST(Judge, ResponsesInOverlapBuckets) {
  const BucketSample sample = bucket(BucketKind::volume, 3, 0.5);
  Response answer;
  Check check;
  judge(sample, answer, check);
  EXPECT_EQ(check.misses, 1u);
  EXPECT_EQ(check.judged, 0u) << "no volume is no error of a volume";
  answer.force = {0.0, 1e-9, 0.0};
  for (const double volume : {0.6, 0.3}) {
    answer.volume = volume;
    judge(sample, answer, check);
  }
  EXPECT_EQ(check.misses, 1u);
  EXPECT_EQ(check.judged, 2u);
  EXPECT_DOUBLE_EQ(check.errors.largest(), 0.4);
  EXPECT_DOUBLE_EQ(check.errors.mean(), 0.3);
  EXPECT_EQ(judged(bucket(BucketKind::volume, 0, 0.0), answer).judged, 0u);
  EXPECT_EQ(judged(bucket(BucketKind::distance, 5, 0.5), answer).judged, 0u);
}

/// Gives up at the first two poses; counts one unit of work a pose.
class GivesUpEarly final : public Query {
 public:
  Outcome<bool> collide(const Pose& pose) override {
    tested_ = pose.t.x();
    return pose.t.x() < 2 ? Outcome<bool>(fail(Status::failed, "gave up")) : Outcome<bool>(true);
  }
  std::vector<Work> work() const override { return {{"nodes", tested_, 7.0}}; }

 private:
  double tested_ = 0.0;
};

TEST(CheckAnswers, CountsFailuresAndAsksTheFirstConfigurations) {
  BucketSample sample = bucket(BucketKind::distance, 5, 0.5);
  for (int i = 0; i < 100; ++i) {
    sample.poses.emplace_back();
    sample.poses.back().t.x() = i;
  }
  GivesUpEarly query;
  Failures failures;
  GuardedQuery guarded(
      query, [&](const Pose& pose) { return query.collide(pose); }, failures);
  const Check all = check_answers(sample, 100, guarded);
  ASSERT_EQ(all.answered.size(), 100u);
  EXPECT_EQ(failures.count(), 2u);
  EXPECT_EQ(failures.first(), "gave up");
  EXPECT_EQ(all.mismatch, 98u);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(all.answered[i], i >= 2) << i;
  benchmark::UserCounters counters;
  all.work.report(counters);
  ASSERT_EQ(counters.size(), 3u);
  EXPECT_DOUBLE_EQ(counters.at("nodes_tested"), 0.5 * (2 + 99)) << "over the answers, without the two failures";
  EXPECT_DOUBLE_EQ(counters.at("nodes_total"), 7.0);
  EXPECT_DOUBLE_EQ(counters.at("ns_per_nodes"), 1e-9 * 0.5 * (2 + 99)) << "inverted and timed by Google Benchmark";
  const Check some = check_answers(sample, 7, guarded);
  EXPECT_EQ(some.answered.size(), 7u);
  EXPECT_EQ(some.mismatch, 5u);
}

TEST(MeanWork, RefusesOtherUnits) {
  MeanWork work;
  work.add({{"nodes", 1.0, 2.0}});
  EXPECT_THROW(work.add({}), Error);
}

}  // namespace
}  // namespace sixdof::bench
