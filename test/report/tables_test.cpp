// What figures draw: tables of small result files whose values are computed by hand.

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/report/tables.h>

#include "result_text.h"

namespace sixdof::report {
namespace {

constexpr double k_degree_rounding = 1e-9;  // of an angle in degrees
constexpr double k_quantile = 1e-3;         // Student's t is given in six digits, times the exponential of it
constexpr double k_rounding = 1e-12;        // of exponentials of means of logarithms

using test::Json;
using test::lines_with;
using test::number_in;
using test::text_in;
using ::testing::HasSubstr;

TEST(LibrariesTable, HasTimesRatiosAndFaultsByClass) {
  const auto timed = [](const char* algorithm, const char* pair, double ns, Json counters) {
    return test::row("distance", algorithm, pair, "distance", 5.0, ns, std::move(counters));
  };
  Json interpreted = timed("fcl-rss", "a", 8000.0, {{"configurations", 10}, {"mismatch", 2}, {"judged", 10}});
  interpreted["sixdof"]["runtime"] = "python";
  const Results results = test::results_of({timed("exact", "a", 1000.0, {{"configurations", 10}, {"p99_ns", 4000.0}}),
                                            timed("exact", "b", 4000.0, {{"configurations", 10}, {"p99_ns", 9000.0}}),
                                            timed("ode", "a", 9000.0, {{"configurations", 10}}),
                                            timed("ode", "b", 9000.0, {{"configurations", 10}}), interpreted});
  const DataTable table = libraries_table(results, row_groups(results));
  ASSERT_EQ(table.rows.size(), 3u);
  const auto exact = lines_with(table, {{"algorithm", "exact"}}).at(0);
  EXPECT_NEAR(number_in(table, exact, "mean_us"), 2.0, k_rounding);
  EXPECT_NEAR(number_in(table, exact, "p99_us"), 6.0, k_rounding);
  EXPECT_EQ(number_in(table, exact, "pairs"), 2.0);
  const auto ode = lines_with(table, {{"algorithm", "ode"}}).at(0);
  EXPECT_NEAR(number_in(table, ode, "over_exact"), 4.5, k_rounding) << "9 and 9/4";
  EXPECT_EQ(text_in(table, ode, "class"), "native");
  EXPECT_EQ(number_in(table, ode, "wrong"), 0.0);
  const auto wrong = lines_with(table, {{"algorithm", "fcl-rss"}}).at(0);
  EXPECT_EQ(text_in(table, wrong, "class"), "python");
  EXPECT_EQ(number_in(table, wrong, "wrong"), 2.0);
  EXPECT_NEAR(number_in(table, wrong, "over_exact"), 8.0, k_rounding);
}

TEST(TimesTable, LineForEveryStatistic) {
  const Results results = test::results_of({test::row("distance", "exact", "bunny", "distance", 5.0, 2000.0,
                                                      {{"p999_ns", 7000.0}, {"p10_ns", 1500.0}, {"p90_ns", 2500.0}})});
  const DataTable table = times_table(results, row_groups(results));
  const auto mean = lines_with(table, {{"statistic", "mean"}});
  ASSERT_EQ(mean.size(), 1u);
  EXPECT_EQ(number_in(table, mean[0], "time_us"), 2.0);
  EXPECT_DOUBLE_EQ(number_in(table, mean[0], "low_us"), 1.8);
  EXPECT_DOUBLE_EQ(number_in(table, mean[0], "high_us"), 2.2);
  EXPECT_EQ(number_in(table, lines_with(table, {{"statistic", "median"}}).at(0), "time_us"), 1.8);
  EXPECT_EQ(number_in(table, lines_with(table, {{"statistic", "10th percentile"}}).at(0), "time_us"), 1.5);
  EXPECT_EQ(number_in(table, lines_with(table, {{"statistic", "90th percentile"}}).at(0), "time_us"), 2.5);
  EXPECT_EQ(number_in(table, lines_with(table, {{"statistic", "longest"}}).at(0), "time_us"), 18.0);
  EXPECT_EQ(number_in(table, lines_with(table, {{"statistic", "99.9th percentile"}}).at(0), "time_us"), 7.0);
  EXPECT_EQ(number_in(table, mean[0], "repetitions"), 1.0);
  EXPECT_TRUE(lines_with(table, {{"statistic", "99th percentile"}}).empty()) << "the row has none";
}

TEST(TimesTable, MeanOverObjectsIsGeometricAndOverTheSameObjects) {
  const Results results = test::results_of({test::row("distance", "exact", "a", "distance", 5.0, 1000.0),
                                            test::row("distance", "exact", "b", "distance", 5.0, 4000.0),
                                            test::row("distance", "fcl-rss", "a", "distance", 5.0, 9000.0)});
  const DataTable table = times_table(results, row_groups(results));
  const auto means = lines_with(table, {{"pair", k_all_objects}, {"statistic", "mean"}});
  ASSERT_EQ(means.size(), 1u) << "fcl-rss has one of the two objects";
  EXPECT_EQ(text_in(table, means[0], "algorithm"), "exact");
  EXPECT_NEAR(number_in(table, means[0], "time_us"), 2.0, k_rounding);
  const double spread = std::exp(std::sqrt(2.0) * std::log(2.0));  // both logarithms are log 2 from their mean
  EXPECT_NEAR(number_in(table, means[0], "high_us"), 2.0 * spread, k_rounding);
  EXPECT_NEAR(number_in(table, means[0], "low_us"), 2.0 / spread, k_rounding);
}

TEST(TimesTable, ResolutionsStandInParenthesesAsInThePaper) {
  const auto prepare = [](const char* algorithm, const Json& counts) {
    Json row = test::row("prepare", algorithm, "a", "distance", 5.0, 1e6, counts);
    row["sixdof"].erase("bucket");
    return row;
  };
  const Results results = test::results_of(
      {prepare("vps@s=1", {{"voxels_x", 728}, {"voxels_y", 24}, {"voxels_z", 303}, {"points", 15669}}),
       prepare("ist", {{"spheres_a", 10000}, {"spheres_b", 10000}}), prepare("exact", {{"bytes", 5}}),
       prepare("ist@d=1", {{"spheres_a", 500}, {"spheres_b", 1234567}}), prepare("x@d=1", {{"spheres_a", 7}}),
       prepare("x@d=2", {{"spheres_a", 7}}), test::row("respond", "vps@s=1", "a", "distance", 5.0, 1000.0),
       test::row("respond", "ist", "a", "volume", 10.0, 1000.0),
       test::row("respond", "exact", "a", "distance", 0.0, 1.0),
       test::row("respond", "ist@d=1", "a", "volume", 1.0, 9.0), test::row("respond", "x@d=1", "a", "volume", 1.0, 9.0),
       test::row("respond", "x@d=2", "a", "volume", 1.0, 9.0)});
  const DataTable table = times_table(results, row_groups(results));
  const auto of = [&](const char* algorithm) {
    return lines_with(table, {{"algorithm", algorithm}, {"statistic", "mean"}, {"pair", "a"}}).at(0);
  };
  EXPECT_EQ(text_in(table, of("vps@s=1"), "label"), "vps (728x24x303, 15,669)");
  EXPECT_EQ(text_in(table, of("ist"), "label"), "ist (10,000)");
  EXPECT_EQ(text_in(table, of("ist@d=1"), "label"), "ist (500 and 1,234,567)");
  EXPECT_EQ(text_in(table, of("exact"), "label"), "exact");
  EXPECT_EQ(text_in(table, of("x@d=2"), "label"), "x@d=2") << "another setting makes the difference";
  EXPECT_EQ(number_in(table, of("vps@s=1"), "place"), -5.0);
  EXPECT_EQ(number_in(table, of("ist"), "place"), 30.0);
  EXPECT_EQ(number_in(table, of("exact"), "place"), 0.0);
}

TEST(TimesTable, RepetitionsAreOneLineWithTheirInterval) {
  const Results results = test::results_of({test::row("distance", "exact", "a", "distance", 5.0, 1000.0),
                                            test::row("distance", "exact", "a", "distance", 5.0, 1000.0),
                                            test::row("distance", "exact", "a", "distance", 5.0, 8000.0)});
  const DataTable table = times_table(results, row_groups(results));
  const auto mean = lines_with(table, {{"statistic", "mean"}});
  ASSERT_EQ(mean.size(), 1u);
  EXPECT_NEAR(number_in(table, mean[0], "time_us"), 2.0, k_rounding) << "geometric mean";
  EXPECT_EQ(number_in(table, mean[0], "repetitions"), 3.0);
  // Student's t of two degrees of freedom at 97.5 % is 4.30265; the logarithms are 0, 0 and 3 log 2.
  const double half = 4.30265 * std::sqrt(3.0 * std::pow(std::log(2.0), 2) / 3.0);
  EXPECT_NEAR(number_in(table, mean[0], "high_us"), 2.0 * std::exp(half), k_quantile);
}

TEST(TimesTable, LongestAndOtherStatisticsHaveTheirPoses) {
  Json row = test::row("distance", "exact", "torus-1k", "distance", 5.0, 2000.0);
  row["outliers"] = test::outliers("max_ns", "1 0 0 1 0 0 0");
  row["outliers"]["poses"]["max_least_ns"] = "2 0 0 1 0 0 0";
  const Results results = test::results_of({row});
  const DataTable table = times_table(results, row_groups(results));
  const auto pose_of = [&](const char* statistic) {
    return text_in(table, lines_with(table, {{"statistic", statistic}}).at(0), "worst_pose");
  };
  EXPECT_THAT(pose_of("longest"), HasSubstr("--pose \"1 0 0 1 0 0 0\""));
  EXPECT_THAT(pose_of("mean"), HasSubstr("--pose \"2 0 0 1 0 0 0\""));
}

TEST(MetricsTable, HasEveryNumberAndThatOfPreparing) {
  Json prepare = test::row("prepare", "vps", "bunny", "distance", 5.0, 3e6, {{"bytes", 77}});
  prepare["name"] = "prepare/algorithm:vps/pair:bunny";
  prepare["sixdof"].erase("bucket");
  const Results results = test::results_of(
      {test::row("respond", "vps", "bunny", "volume", 5.0, 10.0, {{"gamma_F_deg", 4.0}, {"misses", 2}}), prepare});
  const DataTable table = metrics_table(results, row_groups(results));
  const auto line = lines_with(table, {{"query", "respond"}}).at(0);
  EXPECT_EQ(text_in(table, line, "where"), "bunny, volume 5 %");
  EXPECT_EQ(text_in(table, line, "faults"), "2 of 64 without a force though the bodies overlap");
  EXPECT_EQ(number_in(table, line, "gamma_F_deg"), 4.0);
  EXPECT_EQ(number_in(table, line, "processor_mean_ns"), 10.0);
  EXPECT_EQ(number_in(table, line, "bytes"), 77.0);
  EXPECT_EQ(number_in(table, line, "prepare_ns"), 6e6) << "by wall clock";
}

TEST(CastsTable, HasTheMotionAndWhatIsMissed) {
  Json row = test::row("cast", "sampled", "bunny", "distance", 0.0, 3000.0,
                       {{"hits", 40}, {"missed_hits", 10}, {"mismatch", 10}, {"late_max", 0.25}});
  row["name"] = "cast/algorithm:sampled/pair:bunny/motion:tumble/step:0.01";
  row["sixdof"]["order"] = "tumble/0.01";
  const Results results = test::results_of({row, test::row("distance", "exact", "bunny", "distance", 5.0, 10.0)});
  const std::vector<RowGroup> groups = row_groups(results);
  const DataTable table = casts_table(results, groups);
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(text_in(table, table.rows[0], "motion"), "tumble");
  EXPECT_EQ(number_in(table, table.rows[0], "percent"), 0.01);
  EXPECT_EQ(number_in(table, table.rows[0], "time_us"), 3.0);
  EXPECT_EQ(number_in(table, table.rows[0], "missed_percent"), 25.0);
  EXPECT_EQ(number_in(table, table.rows[0], "late_most"), 0.25);
  EXPECT_EQ(text_in(table, table.rows[0], "faults"), "10 of 64 wrong");
  EXPECT_EQ(text_in(failures_table(results, groups), failures_table(results, groups).rows.at(0), "bucket"),
            "tumble 0.01 %");
  EXPECT_TRUE(lines_with(times_table(results, groups), {{"query", "cast"}}).empty());
}

TEST(ManyBodiesTable, HasTheSceneAndItsCounts) {
  Json row = test::row("scene", "exact", "", "distance", 1.0, 1.0,
                       {{"processor_ns", 5000.0}, {"bodies", 1000}, {"missed_pairs", 0}, {"pairs_looked_at", 12}});
  row["name"] = "scene/pile/n:1000/question:near/algorithm:exact";
  row["sixdof"].erase("bucket");
  row["sixdof"]["scenario"] = "pile";
  row["sixdof"]["question"] = "near";
  const Results results = test::results_of({row});
  const DataTable table = many_bodies_table(results, row_groups(results));
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(text_in(table, table.rows[0], "scene"), "pile");
  EXPECT_EQ(number_in(table, table.rows[0], "time_us"), 5.0);
  EXPECT_EQ(number_in(table, table.rows[0], "pairs_looked_at"), 12.0);
  EXPECT_THAT(text_in(table, table.rows[0], "command"), HasSubstr("^scene/pile/n:1000/question:near/algorithm:exact$"));
}

TEST(ContactsTable, HasTheScoresOfARow) {
  Json row = test::row("contacts", "ode", "bunny", "volume", 5.0, 7000.0,
                       {{"contact_normal_deg", 12.5}, {"off_bodies", 3}, {"judged", 64}, {"mismatch", 2}});
  Json motion = test::row("contacts", "ode", "bunny", "volume", 5.0, 7000.0, {{"step_normal_deg", 0.5}});
  motion["sixdof"]["order"] = "motion";
  motion["name"] = std::string(motion["name"]) + "/order:motion";
  const Results results = test::results_of({row, motion});
  const DataTable table = contacts_table(results, row_groups(results));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(number_in(table, table.rows[0], "contact_normal_deg"), 12.5);
  EXPECT_EQ(number_in(table, table.rows[0], "off_bodies"), 3.0);
  EXPECT_EQ(number_in(table, table.rows[0], "percent"), 5.0);
  EXPECT_EQ(number_in(table, table.rows[0], "time_us"), 7.0);
  EXPECT_EQ(text_in(table, table.rows[0], "faults"),
            "2 of 64 without a contact, or with one off both bodies or reversed");
  EXPECT_EQ(text_in(table, table.rows[1], "order"), "motion");
  EXPECT_EQ(number_in(table, table.rows[1], "step_normal_deg"), 0.5);
}

TEST(DepthsTable, HasTheVerdictsOfARow) {
  const Json row = test::row("depth", "ode", "bunny", "volume", 5.0, 7000.0,
                             {{"depth_ratio", 0.25}, {"too_shallow", 30}, {"judged", 31}, {"open_depths", 1}});
  const Results results = test::results_of({row});
  const DataTable table = depths_table(results, row_groups(results));
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(number_in(table, table.rows[0], "depth_ratio"), 0.25);
  EXPECT_EQ(number_in(table, table.rows[0], "too_shallow"), 30.0);
  EXPECT_EQ(number_in(table, table.rows[0], "open_depths"), 1.0);
  EXPECT_EQ(number_in(table, table.rows[0], "percent"), 5.0);
  EXPECT_EQ(text_in(table, table.rows[0], "bodies"), "meshes");
  EXPECT_EQ(text_in(table, table.rows[0], "faults"), "");
}

/// A row of a family of scenes in which a mesh deforms.
Json deform_row(const char* algorithm, double amplitude, double update_ns, double answer_ns) {
  Json row = test::row("deform", algorithm, "", "distance", 1.0, 1.0,
                       {{"processor_ns", update_ns + answer_ns},
                        {"update_ns", update_ns},
                        {"answer_ns", answer_ns},
                        {"amplitude", amplitude},
                        {"missed_pairs", 0}});
  row["name"] = fmt::format("deform/twist/amplitude:{:g}/question:near/algorithm:{}", amplitude, algorithm);
  row["sixdof"].erase("bucket");
  row["sixdof"]["scenario"] = "twist";
  row["sixdof"]["question"] = "near";
  return row;
}

TEST(DeformingTable, HasUpdateAndQueryApartAndTogether) {
  const Results results = test::results_of({deform_row("fcl-refit", 3.0, 2000.0, 500.0)});
  const DataTable table = deforming_table(results, row_groups(results));
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(text_in(table, table.rows[0], "part"), "update and query");
  EXPECT_EQ(number_in(table, table.rows[0], "time_us"), 2.5);
  EXPECT_EQ(number_in(table, table.rows[1], "time_us"), 2.0);
  EXPECT_EQ(number_in(table, table.rows[2], "time_us"), 0.5);
  EXPECT_EQ(number_in(table, table.rows[2], "amplitude"), 3.0);
  EXPECT_EQ(text_in(table, table.rows[2], "scene"), "twist");
}

TEST(RefitPayoffTable, NamesTheAmplitudeWhereRebuildWins) {
  const Results results =
      test::results_of({deform_row("fcl-refit", 1.0, 1000.0, 100.0), deform_row("fcl-rebuild", 1.0, 5000.0, 100.0),
                        deform_row("fcl-refit", 10.0, 1000.0, 9000.0), deform_row("fcl-rebuild", 10.0, 5000.0, 100.0)});
  const DataTable table = refit_payoff_table(results, row_groups(results));
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(text_in(table, table.rows[0], "algorithm"), "fcl-refit");
  EXPECT_EQ(text_in(table, table.rows[0], "rebuild_wins_from"), "10 %");
}

TEST(FrontierTable, MarksPointsThatNoOtherBeats) {
  const auto point = [](const char* algorithm, double ns, double degrees, int misses) {
    Json json =
        test::row("precision", algorithm, "p", "volume", 1.0, ns, {{"gamma_F_deg", degrees}, {"misses", misses}});
    json["name"] = std::string("precision/") + algorithm;
    json["sixdof"].erase("bucket");
    json["sixdof"]["question"] = "respond";
    return json;
  };
  const Results results = test::results_of({point("fast", 10.0, 5.0, 0), point("good", 100.0, 1.0, 0),
                                            point("worse", 100.0, 2.0, 0), point("equal", 100.0, 1.0, 0)});
  const DataTable table = frontier_table(results, row_groups(results));
  ASSERT_EQ(table.rows.size(), 4u);
  const auto leads = [&](const char* name) {
    return text_in(table, lines_with(table, {{"algorithm", name}}).at(0), "frontier");
  };
  EXPECT_EQ(leads("fast"), "yes");
  EXPECT_EQ(leads("good"), "yes");
  EXPECT_EQ(leads("equal"), "yes");
  EXPECT_EQ(leads("worse"), "no");
}

TEST(FrontierTable, FaultyPointLeadsNothing) {
  Json faulty = test::row("respond", "hollow", "p", "volume", 1.0, 1.0, {{"gamma_F_deg", 0.1}, {"misses", 5}});
  const Results results =
      test::results_of({faulty, test::row("respond", "vps", "p", "volume", 1.0, 50.0, {{"gamma_F_deg", 9.0}})});
  const DataTable table = frontier_table(results, row_groups(results));
  EXPECT_EQ(text_in(table, lines_with(table, {{"algorithm", "hollow"}}).at(0), "frontier"), "no");
  EXPECT_EQ(text_in(table, lines_with(table, {{"algorithm", "vps"}}).at(0), "frontier"), "yes");
}

TEST(EqualTimeTable, HasThePaperValueBeside) {
  Json json =
      test::row("equivalent", "ist", "", "volume", 1.0, 9e5, {{"sigma_F", 0.2}, {"tau_ns", 9e5}, {"measured_ns", 8e5}});
  json["sixdof"].erase("bucket");
  json["sixdof"]["scenario"] = "Ia";
  json["name"] = "equivalent/scenario:Ia/algorithm:ist/tau:0.9ms";
  Json step = json;
  step["name"] = "equivalent/scenario:Ia/algorithm:ist/tau:0.9ms/step:1";
  const Results results = test::results_of({step, json});
  const DataTable table = equal_time_table(results, row_groups(results));
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(number_in(table, table.rows[0], "ours"), 0.2);
  EXPECT_EQ(number_in(table, table.rows[0], "paper"), 0.176);
  EXPECT_EQ(number_in(table, table.rows[0], "tau_ms"), 0.9);
}

/// A unit force along x whose measured counterpart is turned by 30 degrees at one step.
Series turned_series(std::size_t steps, std::size_t turned) {
  Series series;
  series.scenario = "II";
  series.algorithm = "vps";
  series.rate_hz = 1000.0;
  for (std::size_t k = 0; k < steps; ++k) {
    series.ideal_force.push_back({2.0, 0.0, 0.0});
    series.force.push_back(k == turned ? std::array{std::sqrt(0.75), 0.5, 0.0} : std::array{1.0, 0.0, 0.0});
    series.torque.push_back({0.0, 0.0, 0.0});
    series.ideal_torque.push_back({0.0, 0.0, 0.0});
    series.status.push_back(0.0);
  }
  return series;
}

TEST(SignalsTable, OutlierOfOneStepIsDrawn) {
  const DataTable table = signals_table({turned_series(10000, 4321)});
  const auto angles = lines_with(table, {{"signal", "force, angle to the ideal (degrees)"}, {"curve", "measured"}});
  EXPECT_LE(angles.size(), k_most_steps);
  double largest = 0.0, at = 0.0;
  for (const auto& line : angles) {
    if (number_in(table, line, "value") > largest) {
      largest = number_in(table, line, "value");
      at = number_in(table, line, "time_ms");
    }
  }
  EXPECT_NEAR(largest, 30.0, k_degree_rounding);
  EXPECT_EQ(at, 4321.0);
  const auto magnitudes = lines_with(table, {{"signal", "force, magnitude"}, {"curve", "ideal"}});
  EXPECT_EQ(number_in(table, magnitudes.at(0), "value"), 1.0) << "over its own largest";
}

/// A torque of 3 beside the unit force, L = 30; without a force at step 2.
TEST(SignalsTable, TorqueOverForceIsDrawnWhereThereIsAForce) {
  Series series = turned_series(5, 9);
  for (auto& torque : series.torque) torque = {0.0, 3.0, 0.0};
  series.force[2] = {0.0, 0.0, 0.0};
  const std::string name = "torque over force";
  EXPECT_TRUE(lines_with(signals_table({series}), {{"signal", name}}).empty()) << "an earlier file has no length";
  series.reference_length = 30.0;
  const DataTable table = signals_table({series});
  const auto measured = lines_with(table, {{"signal", name}, {"curve", "measured"}});
  ASSERT_EQ(measured.size(), 5u);
  EXPECT_NEAR(number_in(table, measured[0], "value"), 0.1, k_degree_rounding);
  EXPECT_TRUE(std::isnan(number_in(table, measured[2], "value")));
  EXPECT_EQ(number_in(table, lines_with(table, {{"signal", name}, {"curve", "ideal"}})[0], "value"), 0.0);
  // Where the ideal is a torque, a force is what should not occur.
  std::swap(series.ideal_force, series.ideal_torque);
  const DataTable other = signals_table({series});
  const auto forces = lines_with(other, {{"signal", "force over torque"}, {"curve", "measured"}});
  ASSERT_EQ(forces.size(), 5u);
  EXPECT_NEAR(number_in(other, forces[0], "value"), 10.0, k_degree_rounding);
  EXPECT_EQ(number_in(other, forces[2], "value"), 0.0);
}

TEST(SignalsTable, PenaltyIsOverItsLargestAndATimeIsNot) {
  Series series = turned_series(4, 9);
  series.penalty = {1.0, 4.0, 2.0, 0.0};
  series.ideal_penalty = {5.0, 10.0, 10.0, 0.0};
  series.time_ns = {2500.0, 1000.0, 1000.0, 1000.0};
  const DataTable table = signals_table({series});
  const auto values = [&](const char* signal, const char* curve) {
    std::vector<double> found;
    for (const auto& line : lines_with(table, {{"signal", signal}, {"curve", curve}})) {
      found.push_back(number_in(table, line, "value"));
    }
    return found;
  };
  EXPECT_EQ(values("penalty", "measured"), (std::vector{0.25, 1.0, 0.5, 0.0}));
  EXPECT_EQ(values("penalty", "ideal"), (std::vector{0.5, 1.0, 1.0, 0.0}));
  EXPECT_EQ(values("time of the query (microseconds)", "measured"), (std::vector{2.5, 1.0, 1.0, 1.0}));
  EXPECT_TRUE(values("time of the query (microseconds)", "ideal").empty());
}

TEST(SpectraTable, LevelsAreBelowTheSignalsLoudest) {
  Series series = turned_series(4, 9);
  series.times = {0.032, 0.040};
  series.frequencies = {0.0, 15.6};
  series.spectra = {{"force_signal", {10.0, 1.0, 0.0, 5.0}},
                    {"force_residual", {0.1, 0.0, 0.0, 0.0}},
                    {"force_x_signal", {0.01, 0.0, 0.0, 0.0}}};
  const DataTable table = spectra_table({series});
  const auto measured = lines_with(table, {{"signal", "force, measured"}});
  ASSERT_EQ(measured.size(), 2u) << "pieces overlap by half";
  EXPECT_EQ(number_in(table, measured[0], "level_db"), 0.0);
  EXPECT_EQ(number_in(table, measured[1], "level_db"), -10.0);
  const auto error = lines_with(table, {{"signal", "force, error (measured minus ideal)"}});
  EXPECT_EQ(number_in(table, error[0], "level_db"), -20.0) << "on the scale of the signal";
  EXPECT_EQ(number_in(table, error[1], "level_db"), -100.0) << "nothing at all is at the floor";
  const auto component = lines_with(table, {{"signal", "force, component x"}});
  ASSERT_EQ(component.size(), 2u);
  EXPECT_EQ(number_in(table, component[0], "level_db"), -30.0) << "on the scale of the magnitude";
}

}  // namespace
}  // namespace sixdof::report
