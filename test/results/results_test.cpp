// Which files a report takes, what it reads of them, and how it refuses others.

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/results/row_group.h>

#include "result_rows.h"

namespace sixdof::results {
namespace {

using test::Json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string refusal(const std::string& text) {
  Results results;
  try {
    parse_results(text, "x.json", results);
  } catch (const BadFile& e) {
    EXPECT_THAT(results.files, IsEmpty());
    EXPECT_THAT(results.rows, IsEmpty());
    return e.what();
  }
  return "";
}

TEST(Results, RowHasFieldsValuesAndTimesInNanoseconds) {
  Json json =
      test::row("distance", "exact", "bunny", "distance", 5.0, 1.5, {{"time_unit", "us"}, {"cpu_time_low", 1.0}});
  json["unknown_number"] = 3;
  const Results results = test::results_of({json}, {{"seed", "7"}, {"num_cpus", 2}});
  ASSERT_EQ(results.rows.size(), 1u);
  const Row& row = results.rows.front();
  EXPECT_EQ(row.fields.query, "distance");
  EXPECT_EQ(row.fields.settings, "size=0.5,culling=on");
  EXPECT_EQ(row.fields.bucket, (BucketKey{BucketKind::distance, 5.0}));
  EXPECT_EQ(row.value(k_processor_mean), 1500.0);
  EXPECT_EQ(row.value(std::string(k_processor_mean) + "_low"), 1000.0);
  EXPECT_EQ(row.value(k_wall_mean), 3000.0);
  EXPECT_FALSE(row.value("cpu_time"));
  EXPECT_FALSE(row.value("unknown_number"));
  EXPECT_EQ(results.files.front().at("seed"), "7");
  EXPECT_EQ(results.files.front().at("num_cpus"), "2");
  EXPECT_EQ(results.files.front().at("absent"), "");
}

TEST(Results, RowHasItsOutliersAndRefusesWrongOnes) {
  Json json = test::row("distance", "exact", "torus-1k", "distance", 5.0, 1.0);
  json["outliers"] = test::outliers("max_ns");
  EXPECT_EQ(test::results_of({json}).rows.front().outliers.poses.at("max_ns"), "0.5 0 0 1 0 0 0");
  json["outliers"] = test::outliers("max_ns", "1 2");
  EXPECT_THAT(refusal(test::file_of({json})), HasSubstr("benchmarks[0]"));
  EXPECT_THAT(refusal(test::file_of({json})), HasSubstr("outliers.poses.max_ns is no pose"));
}

TEST(Results, PlayedSceneHasRowsLikeThoseOfSixdofBench) {
  const Json play = {{"algorithm", "exact"}, {"processor_us", 8.0}, {"mean_us", 9.0}, {"missed", 0}, {"wrong", 0}};
  Json lost = play;
  lost["algorithm"] = "fcl-sap";
  lost["missed"] = 3;
  Results results;
  parse_results(Json{{{"question", "near"}, {"algorithms", {play, lost}}}}.dump(), "plays/pile.json", results);
  ASSERT_EQ(results.rows.size(), 2u);
  EXPECT_EQ(results.rows[0].fields.scenario, "pile");
  EXPECT_EQ(results.rows[0].fields.question, "near");
  EXPECT_EQ(results.rows[0].value("processor_ns"), 8000.0);
  EXPECT_TRUE(own_faults(results.rows[0]).empty());
  EXPECT_EQ(to_string(own_faults(results.rows[1]).at(0)), "3 missed, 0 wrong");
}

TEST(Results, AggregatesAreLeftOutAndFailedRowsKept) {
  Json mean = test::row("collide", "exact", "p", "distance", 1.0, 1.0);
  mean["run_type"] = "aggregate";
  Json failed = test::row("collide", "vps", "p", "distance", 1.0, 1.0);
  failed["error_occurred"] = true;
  failed["error_message"] = "no solid";
  const Results results = test::results_of({mean, failed});
  ASSERT_EQ(results.rows.size(), 1u);
  EXPECT_EQ(results.rows[0].error, "no solid");
  ASSERT_EQ(own_faults(results.rows[0]).size(), 1u);
  EXPECT_EQ(to_string(own_faults(results.rows[0])[0]), "not run: no solid");
}

TEST(Results, ReproductionHasSampleAndSeed) {
  const Results results = test::results_of({test::row("distance", "exact", "p", "distance", 5.0, 1.0)},
                                           {{"sample", "1024"}, {"seed", "4"}});
  EXPECT_EQ(reproduction(results.rows[0], results.files[0]),
            "sixdof-bench '--benchmark_filter=^" + results.rows[0].name + "$' --sample 64 --seed 4");
}

TEST(Results, ReproductionHasTheRunsProgramMeshesAndParameters) {
  const Results results = test::results_of(
      {test::row("distance", "exact", "p", "distance", 5.0, 1.0)},
      {{"program", "turbo-bench"}, {"reproduction", "--a tool.ply -p ist:spheres=300"}, {"seed", "4"}});
  EXPECT_EQ(reproduction(results.rows[0], results.files[0]),
            "turbo-bench --a tool.ply -p ist:spheres=300 '--benchmark_filter=^" + results.rows[0].name +
                "$' --sample 64 --seed 4");
}

TEST(Results, ReproductionIsAnExpressionAndAWordForAShell) {
  EXPECT_EQ(name_expression("pair:a+b (2)/distance:0.5"), "pair:a\\+b \\(2\\)/distance:0.5");
  EXPECT_EQ(name_expression("\\^$|?*["), "\\\\\\^\\$\\|\\?\\*\\[");
  const Results results = test::results_of({test::row("distance", "exact", "it's", "distance", 5.0, 1.0)});
  EXPECT_EQ(reproduction(results.rows[0], results.files[0])
                .find("sixdof-bench '--benchmark_filter=^distance/algorithm:"
                      "exact/pair:it'\\''s/distance:"),
            0u);
}

TEST(Results, ReproductionOfAStudyIsItsCommandLine) {
  const test::Json row = test::row("precision", "exact", "p", "distance", 5.0, 1.0);
  const Results results =
      test::results_of({row}, {{"program", "turbo-sixdof"}, {"arguments", "recommend --a x --budget 1min"}});
  EXPECT_EQ(reproduction(results.rows[0], results.files[0]), "turbo-sixdof recommend --a x --budget 1min");
  const Results unknown = test::results_of({row});
  EXPECT_EQ(reproduction(unknown.rows[0], unknown.files[0]), "");
}

TEST(Results, ReproductionOfAPlayedSceneIsInItsFile) {
  Results results;
  parse_results(R"([{"question":"near","algorithms":[{"algorithm":"exact","command":"sixdof scene play a.h5"},
                    {"algorithm":"fcl-hash"}]}])",
                "play.json", results);
  EXPECT_EQ(reproduction(results.rows.at(0), results.files.at(0)), "sixdof scene play a.h5");
  EXPECT_EQ(reproduction(results.rows.at(1), results.files.at(0)), "");
}

TEST(Results, HardCasesAreRead) {
  Results results;
  parse_results(R"([{"family":"scale","algorithm":"ode","verdict":"wrong","cases":12,"worst":0.5,"unit":"size",
                     "reproduction":"sixdof query --a a.off","words":"0 instead of 1"}])",
                "s.json", results);
  ASSERT_EQ(results.hard_cases.size(), 1u);
  EXPECT_EQ(results.hard_cases[0].reproduction, "sixdof query --a a.off");
  EXPECT_EQ(results.hard_cases[0].cases, 12.0);
  EXPECT_EQ(results.files[0].kind, "stress");
}

TEST(Results, OtherFilesAreRefusedWithTheCause) {
  EXPECT_THAT(refusal(" \n"), HasSubstr("x.json: is empty"));
  EXPECT_THAT(refusal("{\"benchmarks\": [}"), HasSubstr("x.json: not JSON"));
  EXPECT_THAT(refusal("{\"a\": 1}"), HasSubstr("neither a result of sixdof-bench"));
  EXPECT_THAT(refusal("[]"), HasSubstr("neither a result"));
  EXPECT_THAT(refusal("3"), HasSubstr("neither a result"));
  EXPECT_THAT(refusal("[3]"), HasSubstr("x.json: [0]: not an object"));
  EXPECT_THAT(refusal(R"([{"family":"scale"}])"), HasSubstr("no family, algorithm or verdict"));
  EXPECT_THAT(refusal(R"({"benchmarks":[{"name":"BM_x","run_type":"iteration"}]})"),
              HasSubstr("benchmarks[0] (BM_x): no \"sixdof\" object"));
  Json no_time = test::row("distance", "exact", "p", "distance", 5.0, 1.0);
  no_time["cpu_time"] = "soon";
  EXPECT_THAT(refusal(test::file_of({no_time})), HasSubstr("no number \"cpu_time\""));
  Json no_unit = test::row("distance", "exact", "p", "distance", 5.0, 1.0, {{"time_unit", "days"}});
  EXPECT_THAT(refusal(test::file_of({no_unit})), HasSubstr("time_unit \"days\" is none of"));
  Json no_percent = test::row("distance", "exact", "p", "distance", 5.0, 1.0);
  no_percent["sixdof"]["bucket"]["percent"] = "5";
  EXPECT_THAT(refusal(test::file_of({no_percent})), HasSubstr("sixdof.bucket: "));
  Json no_fields = test::row("distance", "exact", "p", "distance", 5.0, 1.0);
  no_fields["sixdof"] = 5;
  EXPECT_THAT(refusal(test::file_of({no_fields})), HasSubstr("sixdof.query: "));
  Results results;
  EXPECT_THROW(read_results("/absent/file.json", results), BadFile);
}

}  // namespace
}  // namespace sixdof::results
