// Searches that are killed and continued, or that have too little time.

#include "bench/study/equivalent_run.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

#include "../cli/scratch_folder.h"

namespace sixdof::study {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::SizeIs;
using ::testing::StartsWith;

constexpr double k_tau = 2e4;
constexpr double k_moment_s = 1e-9;     // a budget that is spent at once
constexpr std::size_t k_settings = 10;  // nine of the grid, and the defaults

/// Algorithms whose time and error are known functions of their resolutions. After `allowed` measurements the run ends.
struct Fake {
  std::size_t calls = 0;
  std::size_t allowed = std::numeric_limits<std::size_t>::max();

  SearchTask task(const std::string& scenario, const std::string& algorithm) {
    const auto axis = [](const char* name) {
      return ResolutionAxis{.parameter = name, .grid = {0.03, 0.01, 0.003}, .low = 0.0015, .high = 0.06};
    };
    const auto parameter = [](const char* name) {
      return Parameter::number(name, "a length", "1", "0.02", 0.001, 1.0);
    };
    return {.scenario = scenario,
            .algorithm = algorithm,
            .settings = Settings({parameter("x"), parameter("y")}),
            .law = "depth",
            .axes = {axis("x"), axis("y")},
            .targets = {{.target = k_tau}, {.target = 3.0 * k_tau}},
            .with_defaults = true,
            .measure = [this](const Resolution& at) { return measure(at); }};
  }

  Measurement measure(const Resolution& at) {
    if (calls == allowed) throw Interrupted("killed");
    ++calls;
    // The constant hides the power law of the grid's coarse points, so that predictions are refined.
    const double time_ns = 5e3 + 1.0 / (at[0] * at[1] * at[1]);
    return {.at = at, .time_ns = time_ns, .eta = at[0] + at[1], .bytes = 7.0};
  }
};

/// All rows of a run as text.
std::string table(const EquivalentRun& run) {
  std::string text;
  for (const EquivalentResult& result : run.results) {
    for (const results::Row& row : equivalent_rows(result)) text += to_json_object(row).dump() + "\n";
  }
  return text;
}

class EquivalentRuns : public test::ScratchFolder {
 protected:
  EquivalentRun run(const std::vector<SearchTask>& tasks, MeasurementStore& store,
                    double budget_s = StudyProgress::k_no_limit) {
    lines_.clear();
    StudyProgress progress("equivalent", budget_s, [this](const std::string& line) { lines_.push_back(line); });
    EquivalentRun searched = run_searches(tasks, store, progress, [this](const EquivalentRun&) { ++tasks_ended_; });
    progress.end();
    return searched;
  }

  std::vector<std::string> lines_;
  std::size_t tasks_ended_ = 0;
};

MeasurementStore::Json context() { return {{"sample", "1"}}; }

TEST_F(EquivalentRuns, KilledTwiceAndContinuedGiveTheTableOfOneRun) {
  Fake fake;
  const std::vector<SearchTask> tasks{fake.task("Ia", "vps"), fake.task("II", "vps"), fake.task("II", "ist")};
  MeasurementStore memory(context());
  const EquivalentRun whole = run(tasks, memory);
  ASSERT_THAT(whole.results, SizeIs(6));
  EXPECT_THAT(whole.not_searched, IsEmpty());
  EXPECT_EQ(tasks_ended_, 3u);
  const std::size_t needed = fake.calls;
  EXPECT_GT(needed, 3 * k_settings) << "with predictions";
  EXPECT_GT(whole.results[0].search.steps.size(), 1u) << "which are refined";

  const std::filesystem::path file = folder() / "equivalent.json";
  fake.calls = 0;
  for (const std::size_t killed_after : {std::size_t{5}, k_settings + 7}) {
    fake.allowed = killed_after;
    MeasurementStore store(context());
    store.open(file, killed_after > 5);
    EXPECT_THROW(run(tasks, store), Interrupted);
    EXPECT_EQ(fake.calls, killed_after);
  }
  fake.allowed = std::numeric_limits<std::size_t>::max();
  MeasurementStore store(context());
  store.open(file, true);
  EXPECT_EQ(table(run(tasks, store)), table(whole));
  EXPECT_EQ(fake.calls, needed) << "nothing is measured twice";
  run(tasks, store);
  EXPECT_EQ(fake.calls, needed) << "all is known";
}

TEST_F(EquivalentRuns, AShortBudgetNamesWhatItLeavesOut) {
  Fake fake;
  MeasurementStore store(context());
  const EquivalentRun none = run({fake.task("Ia", "vps")}, store, k_moment_s);
  EXPECT_EQ(fake.calls, 0u);
  EXPECT_THAT(none.results, IsEmpty());
  ASSERT_THAT(none.not_searched, SizeIs(2));
  EXPECT_FALSE(none.not_searched[0].needs_s);
  EXPECT_THAT(lines_, Contains("equivalent: left out: Ia vps at tau = 20us: the budget was spent"));

  // What is known needs no time; of the others it is known how long the first ones took.
  const EquivalentRun first = run({fake.task("Ia", "vps")}, store);
  const EquivalentRun some = run({fake.task("Ia", "vps"), fake.task("II", "vps")}, store, k_moment_s);
  EXPECT_EQ(table(some), table(first));
  ASSERT_THAT(some.not_searched, SizeIs(2));
  EXPECT_EQ(some.not_searched[1].scenario, "II");
  EXPECT_EQ(some.not_searched[1].options.target, 3.0 * k_tau);
  ASSERT_TRUE(some.not_searched[0].needs_s);
  EXPECT_GT(*some.not_searched[0].needs_s, 0.0);
  EXPECT_THAT(some.not_searched[0].why,
              AllOf(StartsWith("the budget was spent; about "), HasSubstr(" more are needed")));
}

TEST_F(EquivalentRuns, TellHowMuchThereIsAndEveryMeasurement) {
  Fake fake;
  MeasurementStore store(context());
  run({fake.task("Ia", "vps"), fake.task("II", "vps")}, store);
  ASSERT_GT(lines_.size(), 2u);
  EXPECT_EQ(lines_[0], "equivalent: 4 searches: 20 settings, of which 0 are measured, and about 8 predictions");
  EXPECT_THAT(lines_[1], MatchesRegex("equivalent: about .* in all"));
  const auto parts =
      std::ranges::count_if(lines_, [](const std::string& line) { return line.find("% done, ") != std::string::npos; });
  EXPECT_EQ(static_cast<std::size_t>(parts), fake.calls - 4)
      << "the coarsest and the middle ones come before the estimate";
  EXPECT_THAT(lines_, Contains(MatchesRegex("equivalent: II vps x=0.003 y=0.01: [0-9]+ % done, [0-9:]+ left")));
  EXPECT_EQ(lines_.back(), "equivalent: nothing was left out");
}

TEST_F(EquivalentRuns, EstimatesTellTheFixedPartOfTheTimeFromTheOneThatGrows) {
  Fake fake;
  const SearchTask task = fake.task("Ia", "vps");
  constexpr double k_fixed_s = 3.0, k_slope_s = 0.05;
  const auto seconds = [&](const Resolution& at) { return k_fixed_s + k_slope_s * measurement_work(task.axes, at); };
  MeasurementStore store(context());
  for (const Resolution& at : {Resolution{0.03, 0.03}, {0.01, 0.01}}) {
    store.add({"Ia", "vps", at}, {.measured = fake.measure(at), .seconds = seconds(at)});
  }
  const EquivalentRun none = run({task}, store, k_moment_s);
  ASSERT_THAT(none.not_searched, SizeIs(2));
  ASSERT_TRUE(none.not_searched[0].needs_s);
  double grid = seconds({0.02, 0.02}), left = grid;  // the defaults
  for (const double x : {0.03, 0.01, 0.003}) {
    for (const double y : {0.03, 0.01, 0.003}) {
      grid += seconds({x, y});
      if (x != y || x == 0.003) left += seconds({x, y});
    }
  }
  constexpr double k_predictions = 4.0;  // two for each of two targets
  EXPECT_NEAR(*none.not_searched[0].needs_s, left + k_predictions * grid / static_cast<double>(k_settings), 1e-6);
}

TEST(MeasurementWork, IsOneAtTheCoarsestValues) {
  const ResolutionAxis length{.parameter = "s", .grid = {0.01, 0.03, 0.003}};
  const ResolutionAxis count{.parameter = "n", .grid = {1000, 100, 10000}, .integer = true};
  EXPECT_DOUBLE_EQ(measurement_work({length, count}, {0.03, 100}), 1.0);
  EXPECT_DOUBLE_EQ(measurement_work({length, count}, {0.01, 100}), 5.0);
  EXPECT_DOUBLE_EQ(measurement_work({length, count}, {0.03, 1000}), 5.5);
  EXPECT_DOUBLE_EQ(measurement_work({length, count}, {0.03, 0}), 1.0) << "as many as of the other body";
}

}  // namespace
}  // namespace sixdof::study
