#include "bench/harness/judge.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "bench/harness/check.h"
#include "bench/study/answer_errors.h"

namespace sixdof::bench {
namespace {

constexpr double k_tolerance = 1e-3, k_diagonal = 10.0, k_allowed = k_tolerance + k_distance_slack * k_diagonal;
constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

KnownAnswer known(BucketKind kind, double percent, double target) {
  return {.key = {kind, percent}, .target = target, .tolerance = k_tolerance, .diagonal = k_diagonal};
}

const KnownAnswer k_apart = known(BucketKind::distance, 5, 0.5), k_touching = known(BucketKind::distance, 0, 1e-9),
                  k_overlapping = known(BucketKind::volume, 3, 0.5);

Separation at(double distance) { return {.distance = distance}; }

TEST(Judge, YesAndNoByKindOfBucket) {
  for (const bool answer : {false, true}) {
    EXPECT_EQ(judge(k_apart, answer).wrong, answer);
    EXPECT_EQ(judge(k_overlapping, answer).wrong, !answer);
    EXPECT_TRUE(judge(k_apart, answer).judged);
    EXPECT_FALSE(judge(k_touching, answer).judged) << "touching bodies may be called either way";
    EXPECT_FALSE(judge(k_touching, answer).wrong);
  }
}

TEST(Judge, DistancesWithinTheSetsToleranceAndTheSlack) {
  for (const double off : {0.0, k_tolerance, -k_tolerance, 0.999999 * k_allowed, -0.999999 * k_allowed}) {
    EXPECT_FALSE(judge(k_apart, at(0.5 + off)).wrong) << off;
  }
  for (const double off : {1.000001 * k_allowed, -1.000001 * k_allowed, -0.5, k_nan}) {
    EXPECT_TRUE(judge(k_apart, at(0.5 + off)).wrong) << off;
  }
  EXPECT_TRUE(judge(k_touching, at(0.0)).judged);
  EXPECT_FALSE(judge(k_overlapping, at(0.0)).wrong);
  EXPECT_TRUE(judge(k_overlapping, at(0.5)).wrong);
}

TEST(Judge, ErrorsHaveASignAndAreRelative) {
  EXPECT_DOUBLE_EQ(*judge(k_apart, at(0.9)).error, 0.4 / k_diagonal);
  EXPECT_DOUBLE_EQ(*judge(k_apart, at(0.2)).error, -0.3 / k_diagonal);
  EXPECT_EQ(judge(k_apart, at(1e308)).error, k_largest_error);
  EXPECT_FALSE(judge(k_apart, true).error);
}

TEST(Judge, ResponsesInOverlapBuckets) {
  Response answer;
  EXPECT_TRUE(judge(k_overlapping, answer).missed);
  EXPECT_FALSE(judge(k_overlapping, answer).judged) << "no volume is no error of a volume";
  answer.force = {0.0, 1e-9, 0.0};
  answer.volume = 0.3;
  const Judgement judgement = judge(k_overlapping, answer);
  EXPECT_TRUE(judgement.judged);
  EXPECT_FALSE(judgement.missed || judgement.wrong);
  EXPECT_DOUBLE_EQ(*judgement.error, -0.4);
  EXPECT_FALSE(judge(known(BucketKind::volume, 0, 0.0), answer).judged);
  EXPECT_FALSE(judge(k_apart, Response{}).missed);
}

TEST(Judge, ForcesOfBodiesThatAreApart) {
  Response answer;
  EXPECT_TRUE(judge(k_apart, answer).judged);
  EXPECT_FALSE(judge(k_apart, answer).wrong || judge(k_apart, answer).phantom_force);
  answer.force = {0.0, -3e-9, 4e-9};
  EXPECT_TRUE(judge(k_apart, answer).wrong) << "the bodies as they are";
  EXPECT_DOUBLE_EQ(*judge(k_apart, answer).phantom_force, 5e-9);
  KnownAnswer approximated = k_apart;
  approximated.resolution = k_apart.target;
  EXPECT_FALSE(judge(approximated, answer).wrong) << "within the resolution";
  EXPECT_TRUE(judge(approximated, answer).phantom_force);
  approximated.resolution = k_apart.target - 2.0 * k_tolerance;
  EXPECT_TRUE(judge(approximated, answer).wrong);
  EXPECT_FALSE(judge(k_touching, answer).judged || judge(k_touching, answer).wrong) << "both answers are right";
  EXPECT_TRUE(judge(k_touching, answer).phantom_force);
  answer.force.setZero();
  answer.torque = {0.0, 1e-300, 0.0};
  EXPECT_TRUE(judge(k_apart, answer).wrong) << "a torque alone";
  answer.force = {1e308, 1e308, 0.0};
  EXPECT_EQ(judge(k_apart, answer).phantom_force, k_largest_error);
}

TEST(Errors, HaveFiniteMeans) {
  Errors errors;
  EXPECT_EQ(errors.mean(), 0.0);
  EXPECT_EQ(errors.largest(), 0.0);
  for (const double error : {3.0, -4.0}) errors.add(error);
  EXPECT_EQ(errors.mean(), 3.5);
  EXPECT_DOUBLE_EQ(errors.rms(), std::sqrt(12.5));
  for (int i = 0; i < 2; ++i) errors.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(errors.largest(), k_largest_error);
  EXPECT_DOUBLE_EQ(errors.mean(), 0.5 * k_largest_error);
  EXPECT_DOUBLE_EQ(errors.rms(), k_largest_error * std::sqrt(0.5));
}

/// Answers that are right, just within or beyond the tolerance, or none, by the pose's x: 0, 1, 2, ...
class Answers final : public Query {
 public:
  static constexpr std::size_t k_count = 60;

  Outcome<bool> collide(const Pose& pose) override {
    return of(pose) == 0 ? Outcome<bool>(fail(Status::failed, "gave up")) : Outcome<bool>(of(pose) < 3);
  }
  Outcome<Separation> distance(const Pose& pose) override {
    constexpr std::array k_off{0.0, 0.9 * k_allowed, -0.9 * k_allowed, 1.1 * k_allowed, -1.1 * k_allowed, 1e300};
    return of(pose) == 2 ? Outcome<Separation>(fail(Status::failed, "gave up"))
                         : Outcome<Separation>(at(0.5 + k_off.at(of(pose))));
  }

 private:
  static std::size_t of(const Pose& pose) { return static_cast<std::size_t>(pose.t.x()) % 6; }
};

TEST(Judge, ARowAndAStudyCountTheSame) {
  BucketSample bucket{.key = k_apart.key, .target = 0.5, .tolerance = k_tolerance, .diagonal = k_diagonal};
  for (std::size_t i = 0; i < Answers::k_count; ++i) bucket.poses.emplace_back().t.x() = static_cast<double>(i);
  Answers query;
  for (const QueryKind kind : {QueryKind::collide, QueryKind::distance}) {
    const study::StudySample sample{.question = kind,
                                    .poses = bucket.poses,
                                    .references = std::vector(Answers::k_count, study::Reference{k_apart, {}})};
    const auto studied = study::measure_errors(query, sample, 1).values;
    Failures failures;
    with_query_kind(query, kind, failures, [&](auto guarded) {
      const Check check = check_answers(bucket, Answers::k_count, guarded);
      EXPECT_EQ(check.judged, Answers::k_count / 6 * 5);
      EXPECT_EQ(check.wrong, Answers::k_count / 6 * (kind == QueryKind::collide ? 2 : 3));
      const double wrong = kind == QueryKind::collide ? studied.at("mismatch").value
                                                      : studied.at("too_small").value + studied.at("too_large").value;
      EXPECT_EQ(wrong, static_cast<double>(check.wrong));
      if (kind == QueryKind::distance) {
        EXPECT_EQ(studied.at("error_rms").value, check.errors.rms());
        EXPECT_EQ(studied.at("error_max").value, check.errors.largest());
      }
    });
  }
}

}  // namespace
}  // namespace sixdof::bench
