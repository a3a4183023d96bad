#include "bench/harness/sample_plan.h"

#include <limits>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof::bench {
namespace {

constexpr std::size_t k_no_limit = std::numeric_limits<std::size_t>::max();

results::RowFields fields(const std::string& algorithm, double percent) {
  return {.query = "distance",
          .algorithm = algorithm,
          .pair = "ship",
          .bucket = BucketKey{BucketKind::distance, percent},
          .order = "random",
          .cache = "warm"};
}

/// A row whose configurations take the same time each.
PlannedRow row(const std::string& algorithm, double percent, double seconds) {
  return {.name = algorithm, .run = {}, .fields = fields(algorithm, percent), .trial = [=](double) { return seconds; }};
}

PlannedRow broken_row(double percent) {
  return {.name = "broken", .run = {}, .fields = fields("broken", percent), .trial = [](double) -> double {
            throw Error("cannot be prepared");
          }};
}

std::function<double()> each(double seconds) {
  return [seconds] { return seconds; };
}

TEST(GroupOf, DiffersInAllButTheAlgorithm) {
  const results::RowFields one = fields("exact", 5);
  EXPECT_EQ(group_of(one), group_of(fields("fcl-rss", 5)));
  EXPECT_NE(group_of(one), group_of(fields("exact", 6)));
  results::RowFields other = one;
  other.cache = "cold";
  EXPECT_NE(group_of(one), group_of(other));
  other = one;
  other.order = "path";
  EXPECT_NE(group_of(one), group_of(other));
  EXPECT_EQ(group_of({.query = "prepare", .algorithm = "exact", .pair = "ship"}), "");
}

TEST(SamplePlan, RowsWithALimitAreAGroupOfTheirOwn) {
  const PlannedRow free = row("free", 5, 1e-3);
  PlannedRow limited = row("limited", 5, 1.0);
  limited.fields.sample_limit = 64;
  SamplePlan plan({&free, &limited});
  EXPECT_EQ(plan.configurations(limited, each(1e9)), 64u);
  EXPECT_EQ(plan.configurations(free, each(0.2)), 200u) << "the slow row takes nothing of its time";
  SamplePlan unbounded({&free, &limited});
  EXPECT_EQ(unbounded.configurations(limited, each(std::numeric_limits<double>::infinity())), 64u);
  EXPECT_EQ(unbounded.configurations(free, each(std::numeric_limits<double>::infinity())), k_no_limit);
}

TEST(SamplePlan, FitsTheRowsOfAGroupIntoTheirPartsTogether) {
  const PlannedRow fast = row("fast", 5, 1e-3), slow = row("slow", 5, 0.1), alone = row("alone", 6, 1e-3);
  SamplePlan plan({&fast, &slow, &alone});
  // 2 rows of 10.1 s each.
  EXPECT_EQ(plan.configurations(slow, each(10.11)), 200u);
  EXPECT_EQ(plan.configurations(fast, each(1e-6)), 200u) << "chosen before the first row";
  EXPECT_EQ(plan.configurations(slow, each(1e6)), 200u);
  EXPECT_EQ(plan.configurations(alone, each(10.0005)), 10000u);
}

TEST(SamplePlan, AsksAFewWhateverTheTime) {
  const PlannedRow slow = row("slow", 5, 0.1);
  EXPECT_EQ(SamplePlan({&slow}).configurations(slow, each(0.0)), SamplePlan::k_fewest);
}

TEST(SamplePlan, TriesNothingWithoutALimit) {
  const PlannedRow row = broken_row(5);
  EXPECT_EQ(SamplePlan({&row}).configurations(row, each(std::numeric_limits<double>::infinity())), k_no_limit);
  const PlannedRow prepare{.name = "prepare", .run = {}, .fields = {.query = "prepare", .algorithm = "exact"}};
  EXPECT_EQ(SamplePlan({&prepare}).configurations(prepare, each(1.0)), k_no_limit);
}

TEST(SamplePlan, CountsNoTimeOfRowsThatCannotBeRun) {
  const PlannedRow broken = broken_row(5), slow = row("slow", 5, 0.1), silent = row("silent", 6, 0.0);
  EXPECT_EQ(SamplePlan({&broken, &slow}).configurations(broken, each(10.001)), 200u);
  EXPECT_EQ(SamplePlan({&silent}).configurations(silent, each(1.0)), k_no_limit) << "nothing has an answer";
}

TEST(SamplePlan, EndsWhenInterrupted) {
  PlannedRow row = broken_row(5);
  row.trial = [](double) -> double { throw Interrupted("Ctrl-C"); };
  SamplePlan plan({&row});
  EXPECT_THROW(plan.configurations(row, each(1.0)), Interrupted);
}

TEST(SamplePlan, KeepsTheNumberOfAnEarlierRun) {
  const PlannedRow slow = row("slow", 5, 0.1), other = row("slow", 6, 0.1);
  SamplePlan plan({&slow, &other});
  results::RowFields measured = fields("fast", 5);
  plan.keep(measured);
  measured.configurations = 777;
  plan.keep(measured);
  plan.keep({.query = "generate", .algorithm = "fcl", .configurations = 5});
  EXPECT_EQ(plan.configurations(slow, each(10.001)), 777u);
  EXPECT_EQ(plan.configurations(other, each(10.001)), 100u);
}

}  // namespace
}  // namespace sixdof::bench
