// `sixdof table` on result files made here: what stands in cells, which row is the fastest, which files are refused.

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/cli/table_numbers.h"
#include "bench/common/run_guarded.h"

#include "table_command.h"

namespace sixdof::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(TableNumbers, ZeroIsExactlyZero) {
  EXPECT_EQ(as_percent(0.0), "0");
  EXPECT_EQ(as_percent(5.5e-17), "<0.01");
  EXPECT_EQ(as_percent(0.032), "3.2");
  EXPECT_EQ(as_signed_percent(0.0), "0");
  EXPECT_EQ(as_signed_percent(-0.0), "0");
  EXPECT_EQ(as_signed_percent(5.5e-17), "<0.01");
  EXPECT_EQ(as_signed_percent(-5.5e-17), ">-0.01");
  EXPECT_EQ(as_signed_percent(-0.032), "-3.2");
  EXPECT_EQ(as_signed_percent(0.0012), "0.12");
}

// clang-format off
constexpr const char* k_distances =
    "p: distance, distances in percent of A's box diagonal\n"
    "                            cpu, us    wall clock, us            error, diagonals of A\n"
    "distance     algorithm   n     mean   p50   p99   max  >1 ms, %      rms           max\n"
    "00 %      *  x          64     9.00  10.0  20.0  30.0         0        -             -\n"
    "05 %      *  x          64     1.50  10.0  20.0  30.0      25.0        0             0\n"
    "05 %      !  slow       64      123  10.0  20.0  30.0         0  1.2e-03       1.4e-02\n"
    "05 %      *  x (path)   64     4.00  10.0  20.0  30.0         0        -             -\n"
    "! slow: 3 of 64 wrong (05 %)\n";

constexpr const char* k_responses =
    "p: respond, overlaps in percent of A's volume\n"
    "                          cpu, us    wall clock, us            force to the exact one           torque    volume\n"
    "volume     algorithm   n     mean   p50   p99   max  >1 ms, %  angle   max   magn., %  angle  magn., %  error, %\n"
    "05 %    *  x          64     1.50  10.0  20.0  30.0         0   1.23  20.2       12.5   3.50       3.6     <0.01\n";

constexpr const char* k_two_files =
    "                                                   [1]                                       [2]\n"
    "distance  algorithm      n  cpu, us  p99, us  >1 ms, %      n  cpu, us  / [1]  p99, us  >1 ms, %\n"
    "00 %      y          *  64     1.00     20.0         0      -        -      -        -         -\n"
    "05 %      x             64     2.00     20.0         0  *  64     0.50   0.25     20.0         0\n"
    "05 %      y          *  64     1.00     20.0         0  !  64     1.50   1.50     20.0         0\n"
    "! [2] y: 1 of 64 failed (05 %)\n";

constexpr const char* k_markdown =
    "### p: collide, overlaps in percent of A's volume\n\n"
    "| volume |  | algorithm | n | cpu, us: mean | wall clock, us: p50 | wall clock, us: p99 | wall clock, us: max | \\>1 ms, % |\n"
    "|---|---|---|---:|---:|---:|---:|---:|---:|\n"
    "| 05 % | ! | x | 64 | 1.50 | 10.0 | 20.0 | 30.0 | 0 |\n"
    "| 05 % | \\* | y | 64 | 1.50 | 10.0 | 20.0 | 30.0 | 0 |\n\n"
    "- ! x: 2 of 64 wrong (05 %)\n";

constexpr const char* k_wide =
    "distance: cpu mean / wall clock p99, us\n"
    "                                           distance        volume\n"
    "pair  algorithm       n          01 %          05 %          05 %  error max, diagonals  faults\n"
    "p     x              64  *1.00 / 20.0  *3.00 / 20.0             -               1.0e-03\n"
    "p     y          32..64         error  !2.00 / 20.0  *4.00 / 20.0               2.0e-02  "
    "not run: no such model, 3 of 64 wrong\n"
    "q     x              64             -  *0.50 / 20.0             -                     0\n"
    "\n"
    "respond: cpu mean / wall clock p99, us\n"
    "                                         volume\n"
    "pair  algorithm   n          01 %          05 %  angle  angle max  magn., %  torque angle  faults\n"
    "p     x          64  *1.50 / 20.0  !1.50 / 20.0   1.50       20.2      25.0          4.00  2 of 64 failed\n";
// clang-format on

TEST_F(TableCommand, HasALinePerBucketAndAlgorithmAndOneClockPerColumn) {
  Json path = row("distance", "x", "distance", 5, 4000);
  path["sixdof"]["order"] = "path";
  path["name"] = "path";
  const Json right = {{"over_1ms", 0.25}, {"error_rms", 0.0}, {"error_max", 0.0}};
  const Json wrong = {{"error_rms", 1.24e-3}, {"error_max", 0.0136}, {"mismatch", 3}};
  EXPECT_THAT(printed(write("r.json", {row("distance", "x", "distance", 5, 1500, right),
                                       row("distance", "slow", "distance", 5, 123456, wrong),
                                       row("distance", "x", "distance", 0, 9.0, {{"time_unit", "us"}}), path})),
              HasSubstr(k_distances));
}

TEST_F(TableCommand, AnswersAboutOtherBodiesHaveATableOfTheirOwn) {
  Json hulls = row("collide", "hulls", "distance", 5, 1.0);
  hulls["sixdof"]["body"] = "convex_hull";
  const std::string file = write("r.json", {row("collide", "x", "distance", 5, 1500), hulls});
  for (const char* const option : {"", "--wide "}) {
    const std::string text = printed(option + file);
    EXPECT_THAT(text, HasSubstr("p (convex_hull)"));
  }
  const Json tables = Json::parse(printed("--json " + file)).at("tables");
  ASSERT_EQ(tables.size(), 2u);
  for (const Json& table : tables) EXPECT_EQ(table.at("rows").size(), 1u) << table;
}

TEST_F(TableCommand, InterpretedAlgorithmsHaveTablesOfTheirOwn) {
  Json python = row("distance", "coal", "distance", 5, 1.0);
  python["sixdof"]["runtime"] = "python";
  const std::string file = write("r.json", {row("distance", "x", "distance", 5, 1500), python});
  EXPECT_THAT(printed(file), HasSubstr("p (python): distance"));
  EXPECT_THAT(printed("--wide " + file), HasSubstr("distance, python: cpu mean"));
  EXPECT_THAT(printed("--overview " + file), HasSubstr("p (python): mean processor time"));
  const Json tables = Json::parse(printed("--json " + file)).at("tables");
  ASSERT_EQ(tables.size(), 2u);
  for (const Json& table : tables) EXPECT_EQ(table.at("rows")[0].at("files")[0].at("fastest"), true) << table;
}

TEST_F(TableCommand, WideHasALinePerPairAndAlgorithmAndAColumnPerBucket) {
  Json other_pair = row("distance", "x", "distance", 5, 500, {{"error_max", 0.0}});
  other_pair["sixdof"]["pair"] = "q";
  other_pair["name"] = "q";
  const Json angles = {
      {"gamma_F_deg", 1.0}, {"gamma_max_F_deg", 20.25}, {"magnitude_error_F", 0.125}, {"gamma_T_deg", 3.5}};
  const Json other_angles = {{"gamma_F_deg", 2.0},
                             {"gamma_max_F_deg", 10.25},
                             {"magnitude_error_F", 0.375},
                             {"gamma_T_deg", 4.5},
                             {"failed", 2}};
  const Json wrong = {{"error_max", 2e-2}, {"mismatch", 3}, {"configurations", 32}};
  const std::string file = write(
      "r.json", {row("distance", "x", "distance", 1, 1000, {{"error_max", 1e-3}}),
                 row("distance", "x", "distance", 5, 3000, {{"error_max", 1e-4}}),
                 failed_row("distance", "y", "distance", 1), row("distance", "y", "distance", 5, 2000, wrong),
                 row("distance", "y", "volume", 5, 4000, {{"error_max", 0.0}}), other_pair,
                 row("respond", "x", "volume", 1, 1500, angles), row("respond", "x", "volume", 5, 1500, other_angles)});
  EXPECT_THAT(printed("--wide " + file), HasSubstr(k_wide));
  EXPECT_THAT(printed("--wide --markdown " + file), HasSubstr("| q | x | 64 | - | \\*0.50 / 20.0 | - | 0 |  |\n"));
  EXPECT_EQ(table("--wide " + file + " " + file).exit_code, 1);
  EXPECT_THAT(table("--wide " + file + " " + file).err, HasSubstr("--paper show one file"));
}

TEST_F(TableCommand, OverviewHasALinePerAlgorithmAndWhatIsWrongWithIt) {
  const Json wrong = {{"mismatch", 3}, {"judged", 64}};
  Json spheres =
      row("distance", "spheres", "distance", 5, 3000, {{"error_max", 0.003}, {"mismatch", 64}, {"judged", 64}});
  spheres["sixdof"]["approximates"] = true;
  const std::string file =
      write("r.json", {row("collide", "x", "distance", 1, 1000), row("collide", "x", "volume", 5, 3000),
                       row("respond", "x", "volume", 5, 8000, {{"gamma_F_deg", 1.5}}),
                       row("collide", "y", "distance", 1, 1000), row("collide", "y", "volume", 5, 1000, wrong),
                       row("respond", "contacts", "volume", 5, 9000, {{"gamma_F_deg", 12.0}}), spheres});
  const std::string out = printed("--overview --markdown " + file);
  EXPECT_THAT(out, HasSubstr("| x | 2.00 | - | 8.00 | 1.50 | right |\n"));
  EXPECT_THAT(out, HasSubstr("| y | 1.00 | - | - | - | wrong; yes/no: 3 of 64 wrong |\n"));
  EXPECT_THAT(out, HasSubstr("| contacts | - | - | 9.00 | 12.0 | - |\n")) << "there is no right or wrong";
  EXPECT_THAT(
      out, HasSubstr("| spheres | - | 3.00 | - | - | approximate; largest distance error 0.3 % of A's diagonal |\n"));
}

TEST_F(TableCommand, OrdersBucketsByTheirNumbers) {
  const std::string out =
      printed(write("r.json", {row("collide", "x", "distance", 10, 4), row("collide", "x", "distance", 0.5, 2),
                               row("collide", "x", "distance", 1, 3), row("collide", "x", "distance", 0, 1)}));
  std::size_t before = 0;
  for (const char* const bucket : {"\n00 %", "\n0.5 %", "\n01 %", "\n10 %"}) {
    const std::size_t at = out.find(bucket);
    ASSERT_NE(at, std::string::npos) << bucket << out;
    EXPECT_GT(at, before) << bucket;
    before = at;
  }
}

TEST_F(TableCommand, CountsForcesOfBodiesThatAreApart) {
  const std::string out = printed(
      write("r.json",
            {row("respond", "x", "distance", 5, 1500, {{"phantoms", 3}, {"mismatch", 3}, {"phantom_force_max", 0.5}}),
             row("respond", "y", "distance", 5, 1500, {{"phantoms", 0}, {"phantom_force_max", 0.0}})}));
  EXPECT_THAT(out, HasSubstr("p: respond, distances in percent of A's box diagonal\n"));
  EXPECT_THAT(out, HasSubstr("force though apart\n"));
  EXPECT_THAT(out, ::testing::ContainsRegex(" x .* 3 +50\\.0\n"));
  EXPECT_THAT(out, HasSubstr("! x: 3 of 64 with a force though the bodies are apart (05 %)"));
}

TEST_F(TableCommand, ShowsHowWrongResponsesAreAndTheSettings) {
  const Json errors = {{"gamma_F_deg", 1.234}, {"gamma_max_F_deg", 20.25},     {"magnitude_error_F", 0.125},
                       {"gamma_T_deg", 3.5},   {"magnitude_error_T", 0.03601}, {"volume_error_mean", 2e-5}};
  const std::string out = printed(write("r.json", {row("respond", "x", "volume", 5, 1500, errors)}));
  EXPECT_THAT(out, AllOf(HasSubstr(k_responses), HasSubstr("wall clock of single queries"),
                         HasSubstr("settings x: size=0.5\n")));
}

TEST_F(TableCommand, SaysHowConfigurationsFailed) {
  const std::string out = printed(write(
      "r.json",
      {row("respond", "x", "volume", 1, 1, {{"failed", 6}, {"crashed", 3}, {"timed_out", 2}, {"out_of_memory", 1}})}));
  EXPECT_THAT(out, HasSubstr("! x: 6 of 64 failed (01 %); 3 of 64 crashed (01 %); 2 of 64 timed out (01 %); "
                             "1 of 64 out of memory (01 %)\n"));
}

TEST_F(TableCommand, RanksOnlyRowsWithoutFaults) {
  const std::string out = printed(
      write("r.json",
            {row("respond", "right", "volume", 1, 900), row("respond", "right", "volume", 5, 900),
             row("respond", "failing", "volume", 1, 1, {{"failed", 3}}), row("respond", "failing", "volume", 5, 800),
             row("respond", "missing", "volume", 1, 2, {{"failed", 4}, {"misses", 6}}),
             row("respond", "missing", "volume", 5, 2, {{"misses", 5}}),
             row("respond", "silent", "volume", 1, 3, {{"misses", 64}}), row("respond", "silent", "volume", 5, 3),
             row("respond", "null", "volume", 5, 0.5), failed_row("respond", "broken", "volume", 1)}));
  EXPECT_THAT(out, AllOf(HasSubstr("01 %    *  right"), HasSubstr("05 %       right"), HasSubstr("01 %    !  failing"),
                         HasSubstr("05 %    *  failing"), HasSubstr("05 %    !  missing"),
                         HasSubstr("05 %    !  silent"), HasSubstr("05 %    !  null")));
  EXPECT_THAT(out, HasSubstr("! failing: 3 of 64 failed (01 %)\n"));
  EXPECT_THAT(out, HasSubstr("! missing: 4 of 64 failed (01 %); 6 of 60 without a force though the bodies overlap "
                             "(01 %), 5 of 64 without a force though the bodies overlap (05 %)\n"));
  EXPECT_THAT(out, HasSubstr("! silent: 64 of 64 without a force though the bodies overlap (01 %); "
                             "no right answer at volume 01 % (05 %)\n"));
  EXPECT_THAT(out, HasSubstr("! null: returns constants: measures the overhead of the harness (05 %)\n"));
  EXPECT_THAT(out, HasSubstr("! broken: not run: no such model (01 %)\n"));
}

TEST_F(TableCommand, AConstantNoIsNotTheFastestWhereBodiesAreApart) {
  const std::string out =
      printed(write("r.json", {row("collide", "x", "distance", 5, 10), row("collide", "constant", "distance", 5, 1),
                               row("collide", "constant", "volume", 5, 1, {{"mismatch", 64}})}));
  EXPECT_THAT(out, AllOf(HasSubstr("*  x"), HasSubstr("05 %      !  constant"),
                         HasSubstr("! constant: no right answer at volume 05 % (05 %)")));
}

TEST_F(TableCommand, AddsUpFaultsOfManyBuckets) {
  std::vector<Json> rows;
  for (int percent = 1; percent <= 6; ++percent) {
    rows.push_back(row("respond", "x", "volume", percent, 1, {{"misses", percent}}));
    rows.push_back(row("respond", "y", "volume", percent, 1, {{"failed", 2}}));
  }
  const std::string out = printed(write("r.json", rows));
  EXPECT_THAT(out, HasSubstr("! x: 21 of 384 without a force though the bodies overlap (sum over 6 buckets from 01 % "
                             "to 06 %)\n"));
  EXPECT_THAT(out, HasSubstr("! y: 2 of 64 failed (6 buckets from 01 % to 06 %)\n"));
}

TEST_F(TableCommand, TakesRepetitionsTogetherAndLeavesOutAggregates) {
  Json mean = row("collide", "x", "distance", 5, 1.0);
  mean["run_type"] = "aggregate";
  const Json slow = row("collide", "x", "distance", 5, 2000), fast = row("collide", "x", "distance", 5, 1500);
  const std::string out = printed(write("r.json", {slow, mean, fast}));
  EXPECT_THAT(out, AllOf(HasSubstr(" 1.75 "), Not(HasSubstr("0.0010"))));
  EXPECT_THAT(printed(write("s.json", {slow, fast, failed_row("collide", "x", "distance", 5)})),
              AllOf(HasSubstr(" 1.75 "), HasSubstr("! x: not run: no such model")));
}

TEST_F(TableCommand, PutsFilesSideBySide) {
  const std::string first = write("a.json",
                                  {row("distance", "x", "distance", 5, 2000), row("distance", "y", "distance", 5, 1000),
                                   row("distance", "y", "distance", 0, 1000)},
                                  {{"commit", "0123456789abcdef"}, {"date", "today"}});
  const std::string second = write(
      "b.json", {row("distance", "y", "distance", 5, 1500, {{"failed", 1}}), row("distance", "x", "distance", 5, 500)},
      {{"interrupted", "true"}});
  const std::string out = printed(first + " " + second);
  EXPECT_THAT(out, StartsWith("[1] " + first + ": today, commit 0123456789ab\n[2] " + second +
                              ": INTERRUPTED: rows are missing\n"));
  EXPECT_THAT(out, HasSubstr(k_two_files));
  EXPECT_THAT(out, AllOf(HasSubstr("settings [1] y: size=0.5\n"), HasSubstr("settings [2] x: size=0.5\n")));
}

TEST_F(TableCommand, HasFewerColumnsOfManyFiles) {
  const std::string file = write("r.json", {row("respond", "x", "volume", 5, 1500, {{"gamma_F_deg", 1.5}})}) + " ";
  const std::string out = printed(file + file + file);
  EXPECT_THAT(
      out, HasSubstr("volume  algorithm     cpu, us  p99, us  angle     cpu, us  / [1]  p99, us  angle     cpu, us"));
  EXPECT_THAT(out, HasSubstr("*     1.50   1.00     20.0   1.50"));
}

TEST_F(TableCommand, KeepsColdRowsApartAndLeavesOutPercentilesOfFewQueries) {
  Json cold = row("collide", "x", "distance", 5, 9000), slow = row("collide", "y", "distance", 5, 9500);
  for (Json* const each : {&cold, &slow}) {
    (*each)["sixdof"]["cache"] = "cold";
    (*each)["name"] = (*each)["name"].get<std::string>() + "/cache:cold";
    each->erase("p99_ns");
  }
  Json warm = row("collide", "x", "distance", 5, 1500);
  warm["sixdof"]["cache"] = "warm";
  const Json old = row("collide", "y", "distance", 5, 2500);
  const std::string file = write("r.json", {cold, slow, warm, old});
  const std::string out = printed(file);
  EXPECT_THAT(out, AllOf(HasSubstr("05 %      *  x          64     1.50  10.0  20.0  30.0"),
                         HasSubstr("05 %         y          64     2.50  10.0  20.0  30.0"),
                         HasSubstr("05 %         x (cold)   64        -  10.0     -  30.0"),
                         HasSubstr("05 %         y (cold)   64        -  10.0     -  30.0"),
                         HasSubstr("p99 from 200 configurations on")));
  const Json json = Json::parse(printed(file + " --json"));
  EXPECT_EQ(json.at("tables")[0].at("rows")[1].at("cache"), "warm");
  EXPECT_EQ(json.at("tables")[0].at("rows")[2].at("cache"), "cold");
}

TEST_F(TableCommand, PrintsMarkdown) {
  const std::string file = write(
      "r.json", {row("collide", "x", "volume", 5, 1500, {{"mismatch", 2}}), row("collide", "y", "volume", 5, 1500)});
  EXPECT_THAT(printed(file + " --markdown"), HasSubstr(k_markdown));
}

TEST_F(TableCommand, PrintsJson) {
  Json of_prepare = row("prepare", "x", "volume", 5, 1.0);
  of_prepare["sixdof"].erase("bucket");
  const std::string first =
      write("r.json", {row("respond", "x", "volume", 5, 1.5, {{"time_unit", "us"}, {"misses", 2}, {"threads", 1}}),
                       of_prepare, row("respond", "y", "volume", 5, 3.0)});
  const std::string second = write("b\xFF.json", {row("respond", "y", "volume", 5, 6.0)}, {{"commit", "abc"}});
  const Json json = Json::parse(printed(first + " " + second + " --json"));
  EXPECT_EQ(json.at("files")[0], Json({{"file", first},
                                       {"date", ""},
                                       {"commit", ""},
                                       {"interrupted", false},
                                       {"settings", {{"x", {{"size", 0.5}}}, {"y", {{"size", 0.5}}}}},
                                       {"not_shown", {{"prepare", 1}}}}));
  EXPECT_EQ(json.at("files")[1].at("file"), path(R"(b\xFF.json)")) << "no UTF-8: visible";
  ASSERT_EQ(json.at("tables").size(), 1u);
  const Json& table = json.at("tables")[0];
  EXPECT_EQ(table.at("pair"), "p");
  EXPECT_EQ(table.at("query"), "respond");
  EXPECT_EQ(table.at("kind"), "volume");
  ASSERT_EQ(table.at("rows").size(), 2u);
  const Json &x = table.at("rows")[0], &y = table.at("rows")[1];
  EXPECT_EQ(x.at("algorithm"), "x");
  EXPECT_EQ(x.at("percent"), 5);
  const Json& measured = x.at("files")[0];
  EXPECT_EQ(measured.at("faults")[0].at("count"), 2);
  EXPECT_EQ(measured.at("faults")[0].at("of"), 64);
  EXPECT_EQ(measured.at("fastest"), false);
  EXPECT_EQ(measured.at("values").at("processor_mean_ns"), 1500.0);
  EXPECT_EQ(measured.at("values").at("wall_mean_ns"), 3000.0);
  EXPECT_FALSE(measured.at("values").contains("threads")) << "not a metric";
  EXPECT_EQ(x.at("files")[1], nullptr);
  EXPECT_EQ(y.at("files")[0].at("fastest"), true);
  EXPECT_EQ(y.at("files")[1].at("ratio_to_first"), 2.0);
  EXPECT_EQ(TableCommand::table(first + " --json --markdown").exit_code, k_exit_usage);
}

TEST_F(TableCommand, CountsRowsOfOtherFamilies) {
  const Json scenario = {{"name", "scenario/II/algorithm:x"},
                         {"cpu_time", 1},
                         {"real_time", 1},
                         {"time_unit", "ns"},
                         {"sixdof", {{"query", "scenario"}, {"algorithm", "x"}, {"settings", Json::object()}}}};
  const std::string out = printed(write("r.json", {scenario, scenario}));
  EXPECT_THAT(out, AllOf(HasSubstr("no rows of queries on buckets\n"),
                         HasSubstr("rows of other families, not shown: 2 scenario\n")));
  EXPECT_THAT(printed(write("empty-run.json", std::vector<Json>())), HasSubstr("no rows of queries on buckets\n"));
}

}  // namespace
}  // namespace sixdof::cli
