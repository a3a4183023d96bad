#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/library_build.h>
#include <sixdof/models/model_catalogue.h>
#include "bench/common/run_guarded.h"

#include "bench_program.h"

namespace sixdof {
namespace {

constexpr double k_set_tolerance = 1e-6;  // the set's tolerance, and rounding of the printed pose
constexpr double k_rounding = 1e-9;       // of a mean over the sample

using nlohmann::json;
using test::BenchProgram;
using test::row;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(BenchProgram, RunsEveryRowOnceAndFindsFclRight) {
  const json document = result(
      "--seed 5 --sample 32 -p ist:spheres=300 -p ist-descent:spheres=300 "
      "-p exact-depth:tolerance=0.1 "  // the usual one takes a minute, and more pieces than it may where bodies touch
      "'--benchmark_filter=-^(scenario|generate|cast|contacts|depth)/'");
  const auto& rows = document.at("benchmarks");
  std::set<std::string> families;
  std::size_t judged = 0;
  for (const json& entry : rows) {
    const std::string name = entry.at("name");
    families.insert(name.substr(0, name.find('/')));
    EXPECT_FALSE(entry.contains("error_occurred")) << entry;
    if (name.starts_with("prepare/")) continue;
    // Where surfaces touch along a line, an integral may need more pieces than it may have: it says so, and fails.
    const bool may_fail =
        name.find("algorithm:exact-depth/") != std::string::npos && name.find("distance:00") != std::string::npos;
    const auto failed = entry.at("failed").get<std::size_t>();
    EXPECT_LE(failed, may_fail ? 8u : 0u) << name;
    EXPECT_GE(entry.at("max_ns"), entry.at("p50_ns")) << name;
    EXPECT_GE(entry.at("max_ns"), entry.at("max_least_ns")) << name;
    for (const char* percentile : {"p99_ns", "p999_ns", "p99_least_ns"}) {
      EXPECT_FALSE(entry.contains(percentile)) << name << ": of 32 configurations";
    }
    EXPECT_GT(entry.at("p50_ns"), 0) << name;
    EXPECT_EQ(entry.at("iterations").get<std::size_t>() % (entry.at("configurations").get<std::size_t>() - failed), 0u)
        << name << ": only whole rounds";
    EXPECT_EQ(entry.at("configurations"), 32) << name;
    EXPECT_GT(entry.at("reachable"), test::SmallSuite::k_configurations / 2) << name;
    if (name.find("algorithm:fcl") == std::string::npos) continue;
    EXPECT_EQ(entry.at("mismatch"), 0) << name;
    judged += entry.at("judged").get<std::size_t>();
  }
  EXPECT_EQ(families, (std::set<std::string>{"prepare", "collide", "distance", "respond"}));
  EXPECT_GT(judged, test::SmallSuite::k_configurations);
  EXPECT_EQ(document.at("context").at("seed"), "5");
}

TEST_F(BenchProgram, ScenarioRowsCarryTimeAndMeasures) {
  const json document = result("--budget 0.5 --benchmark_filter=^scenario/II/algorithm:\\(exact\\|null\\)$");
  const json exact = row(document, "scenario/II/algorithm:exact"), null = row(document, "scenario/II/algorithm:null");
  for (const char* measure : {"sigma_F", "gamma_F_deg", "nu_F", "misses", "loop_work", "p50_ns", "over_1ms"}) {
    EXPECT_TRUE(exact.contains(measure)) << measure << " of " << exact;
  }
  EXPECT_EQ(exact.at("misses"), 0);
  EXPECT_EQ(null.at("misses"), null.at("steps"));
}

TEST_F(BenchProgram, ReportsTheWorkOfQueries) {
  const std::string pair = "/pair:torus-1k-cone-1k/";
  const json document = result(
      "--sample 32 -p ist:spheres=300 -p ist-descent:spheres=300 --parameter vps:point_spacing=0.02 "
      "--benchmark_filter='^(prepare|respond|collide)/algorithm:(vps|ist)/.*torus-1k-cone-1k'");
  const json prepared = row(document, "prepare/algorithm:vps/pair:torus-1k-cone-1k");
  for (const char* kind : {"respond", "collide"}) {
    const json points = row(document, kind + std::string("/algorithm:vps") + pair + "volume:03");
    EXPECT_EQ(points.at("points_total"), prepared.at("points")) << kind;
    EXPECT_GT(points.at("points_tested"), 0) << kind;
    EXPECT_LT(points.at("points_tested"), 0.5 * points.at("points_total").get<double>()) << kind;
    EXPECT_GT(points.at("ns_per_points"), 0) << kind;
    EXPECT_LT(points.at("ns_per_points").get<double>(), points.at("cpu_time").get<double>()) << kind;
  }
  const json spheres = row(document, "respond/algorithm:ist" + pair + "volume:03");
  EXPECT_EQ(spheres.at("sphere_pairs_total"), 300 * 300);
  EXPECT_GT(spheres.at("sphere_pairs_tested"), 0);
  EXPECT_LT(spheres.at("sphere_pairs_tested"), 300 * 300);
}

TEST_F(BenchProgram, SeveralResolutionsOfOneAlgorithmAreRowsOfEach) {
  const json document = result(
      "--sample 32 -p ist:spheres=100,400 -p ist:seed=3 "
      "'--benchmark_filter=^(prepare|respond)/algorithm:ist@.*/pair:torus-1k(/(distance:05|volume:03))?$'");
  ASSERT_EQ(document.at("benchmarks").size(), 6u);
  for (const char* const spheres : {"100", "400"}) {
    const std::string of = std::string("/algorithm:ist@spheres=") + spheres + "/pair:torus-1k";
    EXPECT_EQ(row(document, "prepare" + of).at("spheres_a").dump(), std::string(spheres) + ".0");
    const json apart = row(document, "respond" + of + "/distance:05");
    EXPECT_EQ(apart.at("sixdof").at("settings").at("spheres").dump(), spheres);
    EXPECT_EQ(apart.at("sixdof").at("settings").at("seed"), 3);
    EXPECT_EQ(apart.at("phantoms"), 0) << "spheres inside the bodies do not meet when these are apart";
    EXPECT_EQ(apart.at("judged"), 32);
    EXPECT_THAT(apart.at("outliers").at("command").get<std::string>(),
                HasSubstr(std::string("--algorithm ist -p spheres=") + spheres));
  }
  EXPECT_LT(row(document, "respond/algorithm:ist@spheres=400/pair:torus-1k/volume:03").at("volume_error_mean"),
            row(document, "respond/algorithm:ist@spheres=100/pair:torus-1k/volume:03").at("volume_error_mean"));
}

TEST_F(BenchProgram, CountsTheMismatchesOfNull) {
  const json document = result("--benchmark_filter=algorithm:null/pair:torus-1k/");
  const json distance = row(document, "distance/algorithm:null/pair:torus-1k/distance:05");
  EXPECT_EQ(distance.at("mismatch"), distance.at("judged"));
  EXPECT_NEAR(distance.at("error_rms").get<double>(), 0.05, k_rounding);
  const json overlap = row(document, "collide/algorithm:null/pair:torus-1k/volume:03");
  EXPECT_EQ(overlap.at("mismatch"), overlap.at("configurations"));
  EXPECT_EQ(row(document, "collide/algorithm:null/pair:torus-1k/distance:05").at("mismatch"), 0);
  EXPECT_EQ(row(document, "collide/algorithm:null/pair:torus-1k/distance:00").at("judged"), 0);
}

TEST_F(BenchProgram, OpensOnlyWhatOneRowNeeds) {
  const auto one =
      bench("--sample 32 --stats --benchmark_filter=^collide/algorithm:fcl-obbrss/pair:torus-1k/distance:05$");
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_THAT(one.err,
              HasSubstr("stats: sets_opened=1 buckets_read=1 meshes_loaded=1 structures_prepared=1 rows_measured=1\n"));
  const auto other =
      bench("--sample 32 --stats --benchmark_filter=^distance/algorithm:fcl-rss/pair:torus-1k-cone-1k/distance:0");
  EXPECT_THAT(other.err,
              HasSubstr("stats: sets_opened=1 buckets_read=2 meshes_loaded=2 structures_prepared=1 rows_measured=4\n"));
  const auto prepare = bench("--sample 32 --stats --benchmark_filter=^prepare/algorithm:fcl-rss/pair:torus-1k$");
  EXPECT_THAT(prepare.err, HasSubstr("stats: sets_opened=0 buckets_read=0 meshes_loaded=1 structures_prepared="));
}

TEST_F(BenchProgram, ListsWithoutTouchingASet) {
  const auto moved = suite->directory() / "moved.h5";
  const auto set = suite->directory() / "torus-1k.h5";
  std::filesystem::rename(set, moved);
  const auto list = bench("--benchmark_list_tests");
  std::filesystem::rename(moved, set);
  EXPECT_EQ(list.exit_code, 0) << list.err;
  std::istringstream lines(list.out);
  std::set<std::string> names;
  for (std::string name; std::getline(lines, name);) {
    EXPECT_TRUE(names.insert(name).second) << name << " twice";
    EXPECT_TRUE(std::regex_match(name, std::regex("[A-Za-z0-9_/:.-]+"))) << name;
  }
  EXPECT_TRUE(names.contains("distance/algorithm:fcl-rss/pair:torus-1k-cone-1k/distance:05/order:path"));
  EXPECT_FALSE(names.contains("collide/algorithm:fcl-rss/pair:torus-1k/distance:05"));
}

TEST_F(BenchProgram, RecordsItsContext) {
  const json context =
      result("--sample 32 --benchmark_filter=^collide/algorithm:fcl-obbrss/pair:torus-1k/").at("context");
  for (const char* key : {"commit", "commit_dirty", "compiler", "flags", "cpu_model", "algorithm:fcl-obbrss",
                          "settings:fcl-obbrss", "version:eigen", "clock_overhead_ns", "num_cpus"}) {
    EXPECT_TRUE(context.contains(key)) << key;
  }
  EXPECT_TRUE(
      std::regex_match(context.at("fcl_build").get<std::string>(),
                       std::regex("(libfcl-dev|FCL) 0\\.7\\.[^ ]*, FCL_HAVE_SSE [01], EIGEN_MAX_ALIGN_BYTES 16")))
      << context.at("fcl_build");
  EXPECT_EQ(context.at("mesh:torus-1k").get<std::string>().size(), 32u);
  EXPECT_EQ(context.at("set:torus-1k").get<std::string>().size(), 32u);
  EXPECT_FALSE(context.contains("set:torus-1k-cone-1k"));
  EXPECT_EQ(context.at("interrupted"), "false");
}

TEST_F(BenchProgram, FailsIfNothingMatchesOrAnOptionIsUnknown) {
  for (const char* bad : {"--benchmark_filter=no-such-row", "--benchmark_filter='('", "--parameter fcl-obbrss:speed=9",
                          "-p speed=9", "--manifest no-such-file", "--benchmark_out=/no-such-folder/x.json"}) {
    const auto run = bench(std::string("--benchmark_out=") + out.string() + " " + bad);
    EXPECT_NE(run.exit_code, 0) << bad;
    EXPECT_NE(run.err, "") << bad;
    EXPECT_FALSE(std::filesystem::exists(out)) << bad;
  }
  for (const char* bad : {"--no-such-flag", "--sample=-1", "--benchmark_out_format=xml", "stray", "--set no-such-file",
                          "--benchmark_format=xml", "--out=a --resume=a", "--resume ''"}) {
    EXPECT_EQ(bench(bad).exit_code, k_exit_usage) << bad;
  }
  EXPECT_EQ(bench("--suite no-such-file --benchmark_list_tests").exit_code, k_exit_error);
}

TEST_F(BenchProgram, ReportsRowsThatCannotRunAndFails) {
  const auto set = suite->directory() / "torus-1k.h5";
  const auto kept = suite->directory() / "kept.h5";
  std::filesystem::rename(set, kept);
  const json document = result("--benchmark_filter='^collide/algorithm:fcl-obbrss/.*distance:05$'", k_exit_error);
  std::filesystem::rename(kept, set);
  const json failed = row(document, "collide/algorithm:fcl-obbrss/pair:torus-1k/distance:05");
  EXPECT_EQ(failed.at("error_occurred"), true);
  EXPECT_THAT(failed.at("error_message").get<std::string>(), HasSubstr("torus-1k.h5"));
  EXPECT_EQ(row(document, "collide/algorithm:fcl-obbrss/pair:torus-1k-cone-1k/distance:05").at("mismatch"), 0);
}

TEST_F(BenchProgram, DrawsSamplesByNumberAndByTime) {
  const std::string filter = " --benchmark_filter=^distance/algorithm:fcl-rss/pair:torus-1k/distance:05$";
  const json whole = result(filter).at("benchmarks")[0];
  EXPECT_EQ(whole.at("configurations"), whole.at("reachable"));
  const json some = result("--sample 50" + filter).at("benchmarks")[0];
  EXPECT_EQ(some.at("configurations"), 50);
  EXPECT_LT(some.at("configurations"), whole.at("configurations"));
  const json hurried = result("--budget 0.000001" + filter).at("benchmarks")[0];
  EXPECT_EQ(hurried.at("configurations"), 32) << "the fewest";
}

TEST_F(BenchProgram, TakesParametersAndShowsThem) {
  const json document = result(
      "--sample 32 --parameter fcl-rss:relative_error=0.5 "
      "--benchmark_filter='^distance/algorithm:fcl.*pair:torus-1k/distance:05$'");
  const json loose = row(document, "distance/algorithm:fcl-rss/pair:torus-1k/distance:05");
  EXPECT_GT(loose.at("mismatch"), 0);
  EXPECT_GT(loose.at("error_max"), 0.001);
  EXPECT_THAT(loose.at("label").get<std::string>(), HasSubstr("relative_error=0.5"));
  const json exact = row(document, "distance/algorithm:fcl-obbrss/pair:torus-1k/distance:05");
  EXPECT_EQ(exact.at("mismatch"), 0);
  EXPECT_EQ(exact.at("label"), "relative_error=0");
}

TEST_F(BenchProgram, OutliersAskTheSameAgain) {
  const json document = result(
      "--sample 32 --parameter fcl-rss:relative_error=0.5 --isolate "
      "--benchmark_filter=^distance/algorithm:fcl-rss/pair:torus-1k/distance:05$");
  const json entry = document.at("benchmarks")[0], outliers = entry.at("outliers");
  EXPECT_EQ(outliers.at("command"),
            "sixdof query --a torus-1k --b torus-1k --algorithm fcl-rss -p relative_error=0.5 --isolate");
  std::string command = outliers.at("command").get<std::string>();
  command.replace(0, std::string("sixdof").size(), SIXDOF_PROGRAM);
  const auto ask = [&](const std::string& counter) {
    const auto asked =
        test::run_program(command + " --json --pose '" + outliers.at("poses").at(counter).get<std::string>() + "'");
    EXPECT_EQ(asked.exit_code, 0) << asked.err;
    return json::parse(asked.out).at("distance").get<double>();
  };
  const double diagonal = load_model("torus-1k").diagonal(), truth = 0.05 * diagonal;
  // The set's tolerance, and rounding of the pose.
  EXPECT_NEAR(std::abs(ask("error_max") - truth) / diagonal, entry.at("error_max").get<double>(), k_set_tolerance);
  EXPECT_GT(std::abs(ask("mismatch") - truth), 1e-6 * diagonal);
}

TEST_F(BenchProgram, RunsTheDefaultSuiteUnlessRowsOrSetsAreChosen) {
  const auto count_rows = [](const std::string& arguments) {
    const auto list = test::run_program(std::string(SIXDOF_BENCH_PROGRAM) + " --benchmark_list_tests " + arguments);
    EXPECT_EQ(list.exit_code, 0) << list.err;
    return std::ranges::count(list.out, '\n');
  };
  const auto all = count_rows("--suite all"), standard = count_rows("--suite default");
  EXPECT_GT(standard, 100);
  EXPECT_LT(standard, all / 2);
  EXPECT_EQ(count_rows(""), standard);
  EXPECT_EQ(count_rows("--benchmark_filter=."), all);
  EXPECT_EQ(count_rows("--suite default --benchmark_filter=."), standard);
  const auto scenario_rows = [](const std::string& arguments) {
    const auto list = test::run_program(std::string(SIXDOF_BENCH_PROGRAM) + " --benchmark_list_tests " + arguments +
                                        " --benchmark_filter=^scenario/");
    EXPECT_EQ(list.exit_code, 0) << list.err;
    std::set<std::string> names;
    std::istringstream lines(list.out);
    for (std::string name; std::getline(lines, name);) names.insert(name);
    return names;
  };
  std::set<std::string> of_all = scenario_rows("");
  // Slow algorithms are measured where they are named.
  std::erase_if(of_all, [](const std::string& name) {
    return name.ends_with(":gts") || name.ends_with(":simbody") || name.ends_with(":cgal") ||
           name.ends_with(":exact-depth");
  });
  EXPECT_EQ(scenario_rows("--suite default"), of_all);
  EXPECT_GT(count_rows("--manifest " + suite->manifest().string()), 0) << "sets of the user: all rows";
}

TEST_F(BenchProgram, TakesRowsOnColdCachesOnRequestOnly) {
  const std::string cold = "collide/algorithm:exact/pair:torus-1k/distance:05/cache:cold\n";
  for (const char* others : {"", "--suite all", "--benchmark_filter=^collide/"}) {
    const auto list = bench(std::string("--benchmark_list_tests ") + others);
    EXPECT_EQ(list.exit_code, 0) << list.err;
    EXPECT_THAT(list.out, Not(HasSubstr("cache:cold"))) << others;
  }
  EXPECT_THAT(bench("--benchmark_list_tests --benchmark_filter=/cache:cold$").out, HasSubstr(cold));
  const auto file = suite->directory() / "suite.json";
  std::ofstream(file) << R"({"rows": [{"query": "all", "algorithm": "all", "pair": "all", "distance": "all",
                             "cache": ["cold"]}]})";
  EXPECT_THAT(bench("--benchmark_list_tests --suite " + file.string()).out, HasSubstr(cold));
}

TEST_F(BenchProgram, TakesRowsOfMotionsOnRequestOnly) {
  const std::string motion = "distance/algorithm:exact/pair:torus-1k/distance:05/order:motion";
  EXPECT_THAT(bench("--benchmark_list_tests --benchmark_filter=^distance/").out, Not(HasSubstr("order:motion")));
  EXPECT_THAT(bench("--benchmark_list_tests --benchmark_filter=order:motion").out, HasSubstr(motion));
  const json found = row(result("--sample 200 -p exact:warm_start=on '--benchmark_filter=^" + motion + "$'"), motion);
  EXPECT_EQ(found.at("configurations"), 200);
  EXPECT_EQ(found.at("mismatch"), 0);
  EXPECT_EQ(found.at("sixdof").at("order"), "motion");
  EXPECT_EQ(found.at("iterations").get<int>() % 200, 0) << "whole rounds of as many poses";
}

TEST_F(BenchProgram, TimesSingleQueriesOnColdCaches) {
  const std::string name = "collide/algorithm:exact/pair:torus-1k/distance:05";
  const json document = result("--sample 8 '--benchmark_filter=^" + name + "(/cache:cold)?$'");
  const json cold = row(document, name + "/cache:cold"), warm = row(document, name);
  EXPECT_EQ(cold.at("run_name"), name + "/cache:cold");
  EXPECT_EQ(cold.at("configurations"), 8);
  EXPECT_EQ(cold.at("iterations"), 8) << "one round";
  EXPECT_EQ(cold.at("mismatch"), 0);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  constexpr double k_ratio = 1.0;  // instrumented code takes longer than memory
#else
  constexpr double k_ratio = 3.0;  // some forty without other work on the machine
#endif
  EXPECT_GT(cold.at("p50_ns").get<double>(), k_ratio * warm.at("p50_ns").get<double>()) << "data comes from memory";
  EXPECT_FALSE(cold.contains("max_least_ns")) << "of one pass";
  // The means are those of the single times.
  EXPECT_LE(cold.at("real_time"), cold.at("max_ns"));
  EXPECT_GT(cold.at("real_time").get<double>() * 8.001, cold.at("max_ns").get<double>());
  EXPECT_EQ(cold.at("cpu_time"), cold.at("real_time"));
}

TEST_F(BenchProgram, TimesTheMakingOfSets) {
  const json document = result("'--benchmark_filter=^generate/.*/pair:torus-1k-cone-1k$'");
  ASSERT_EQ(document.at("benchmarks").size(), 4u);
  const auto cost = [&](const char* method, double configurations) {
    const json made = row(document, std::string("generate/") + method + "/pair:torus-1k-cone-1k");
    EXPECT_EQ(made.at("configurations"), configurations) << method;
    EXPECT_EQ(made.at("triangles"), 2000.0) << method;
    return made.at("ns_per_configuration").get<double>();
  };
  // 4 runs of 8 rays, with all buckets of the paper.
  EXPECT_GT(cost("volume/algorithm:overlap", 4 * 8 * 11), 0.0);
  // The ratios are some tens and about five, far above noise.
  const double sweep = cost("distance/algorithm:fcl-sweep", 4 * 8 * 31);
  EXPECT_LT(cost("distance/algorithm:raycast", 4 * 8 * 31), sweep);
  EXPECT_LT(sweep, cost("distance/algorithm:fcl", 4 * 8 * 31));
}

TEST_F(BenchProgram, TakesASetOfTheUser) {
  const auto list =
      test::run_program(std::string(SIXDOF_BENCH_PROGRAM) + " --no-manifest --benchmark_list_tests --set " +
                        (suite->directory() / "torus-1k-cone-1k.h5").string());
  EXPECT_EQ(list.exit_code, 0) << list.err;
  EXPECT_THAT(list.out, HasSubstr("collide/algorithm:fcl-obbrss/pair:torus-1k-cone-1k/volume:03\n"));
  EXPECT_THAT(list.out, Not(HasSubstr("pair:torus-1k/")));
}

TEST_F(BenchProgram, WritesAWholeFileOnCtrlC) {
  // Far more repetitions than end before the signal comes.
  const std::string endless = command(
      "--benchmark_repetitions=1000000 --benchmark_filter=fcl --benchmark_out=" + out.string() + " > /dev/null");
  const auto run = test::run_program(endless + " & sleep 1; kill -INT $!; wait $!");
  EXPECT_EQ(run.exit_code, k_exit_interrupted) << run.err;
  EXPECT_THAT(run.err, HasSubstr("interrupted"));
  std::ifstream file(out);
  EXPECT_EQ(json::parse(file).at("context").at("interrupted"), "true");
  EXPECT_FALSE(any_partial_file());
}

TEST_F(BenchProgram, SaysThatItIsNotOptimised) {
  const std::string rows = "--benchmark_filter=^prepare/algorithm:null/ --benchmark_out=" + out.string();
  const auto build_of = [&] {
    std::ifstream file(out);
    return json::parse(file).at("context").at("sixdof_build").get<std::string>();
  };
  const auto slow = test::run_program(command(rows, UNOPTIMISED_PROGRAM));
  EXPECT_EQ(slow.exit_code, 0) << slow.err;
  EXPECT_THAT(slow.err, HasSubstr("***WARNING*** sixdof was built without optimisation"));
  EXPECT_EQ(build_of(), "debug (unoptimised)");
  const auto fast = bench(rows);
#if defined(__OPTIMIZE__)
  EXPECT_THAT(fast.err, Not(HasSubstr("***WARNING*** sixdof")));
#endif
  EXPECT_THAT(fast.err, Not(HasSubstr("Library was built as DEBUG")));
  EXPECT_EQ(build_of(), to_string(library_build()));
}

TEST_F(BenchProgram, PrintsJsonToStandardOutputWhole) {
  const auto run = bench("--benchmark_format=json --benchmark_filter=^prepare/algorithm:fcl-rss/");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out).at("benchmarks").size(), 2u);
}

TEST_F(BenchProgram, WritesNoNaNWithRepetitions) {
  const json document =
      result("--sample 32 --benchmark_repetitions=3 --benchmark_filter=^collide/algorithm:fcl-obbrss/pair:torus-1k/");
  std::size_t aggregates = 0;
  for (const json& entry : document.at("benchmarks")) aggregates += entry.at("run_type") == "aggregate";
  EXPECT_GT(aggregates, 0u);
  // A coefficient of variation of zeros would be NaN, which nlohmann's parser refuses.
}

TEST_F(BenchProgram, RunsEveryRowOfAnExternalAlgorithm) {
  const auto run = test::run_program(
      command("--sample 64 --benchmark_filter=algorithm:ball/ --benchmark_out=" + out.string(), EXTERNAL_PROGRAM));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::ifstream file(out);
  const json document = json::parse(file);
  EXPECT_EQ(document.at("context").at("algorithm:ball"), "1");
  EXPECT_EQ(row(document, "prepare/algorithm:ball/pair:torus-1k").at("spheres"), 2);
  const json distance = row(document, "distance/algorithm:ball/pair:torus-1k/distance:05/order:path");
  EXPECT_GT(distance.at("mismatch"), 0);
  EXPECT_EQ(distance.at("failed"), 0);
}

}  // namespace
}  // namespace sixdof
