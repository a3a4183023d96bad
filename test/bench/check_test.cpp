#include "bench/harness/check.h"

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof::bench {
namespace {

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
  BucketSample sample{.key = {BucketKind::distance, 5}, .target = 0.5, .diagonal = 10.0};
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
  EXPECT_EQ(all.wrong, 98u);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(all.answered[i], i >= 2) << i;
  benchmark::UserCounters counters;
  all.work.report(counters);
  ASSERT_EQ(counters.size(), 3u);
  EXPECT_DOUBLE_EQ(counters.at("nodes_tested"), 0.5 * (2 + 99)) << "over the answers, without the two failures";
  EXPECT_DOUBLE_EQ(counters.at("nodes_total"), 7.0);
  EXPECT_DOUBLE_EQ(counters.at("ns_per_nodes"), 1e-9 * 0.5 * (2 + 99)) << "inverted and timed by Google Benchmark";
  const Check some = check_answers(sample, 7, guarded);
  EXPECT_EQ(some.answered.size(), 7u);
  EXPECT_EQ(some.wrong, 5u);
}

TEST(MeanWork, RefusesOtherUnits) {
  MeanWork work;
  work.add({{"nodes", 1.0, 2.0}});
  EXPECT_THROW(work.add({}), Error);
}

}  // namespace
}  // namespace sixdof::bench
