// Rows of algorithms in processes of their own: what a death costs, and that times and answers are those of one
// process.

#include <algorithm>
#include <csignal>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <sixdof/configuration/bucket_sample.h>
#include <sixdof/models/model_catalogue.h>

#include "../process/deadly_query.h"
#include "bench_program.h"

namespace sixdof {
namespace {

using test::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* k_sample = "128";

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr const char* k_end_of_a_bad_access = "ended with exit code";  // the sanitizer reports it
#else
constexpr const char* k_end_of_a_bad_access = "ended by signal 11";
#endif

/// Sanitizers have no limit of memory: their shadow memory counts.
std::vector<test::Death> tested_deaths() {
  std::vector<test::Death> list = test::deaths();
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  std::erase_if(list, [](const test::Death& death) { return death.status == Status::out_of_memory; });
#endif
  return list;
}

struct Isolated : ::testing::Test {
  static test::ProgramResult bench(const std::string& arguments, const char* program = DEADLY_PROGRAM) {
    return test::run_program(std::string(program) + " --manifest " SIXDOF_SMALL_SUITE "/manifest.json --sample " +
                             k_sample + " --benchmark_min_time=0.000001 --benchmark_format=json " + arguments);
  }
  static json rows(const std::string& arguments, int exit_code = 0, const char* program = DEADLY_PROGRAM) {
    const auto run = bench(arguments, program);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    return json::parse(run.out);
  }
  static std::string filter(const std::string& query, const std::string& algorithms, const std::string& bucket) {
    return fmt::format("'--benchmark_filter=^{}/algorithm:({})/pair:torus-1k/{}$' ", query, algorithms, bucket);
  }
  static json row(const json& document, const std::string& algorithm, const std::string& query = "distance",
                  const std::string& bucket = "distance:05") {
    return test::row(document, fmt::format("{}/algorithm:{}/pair:torus-1k/{}", query, algorithm, bucket));
  }
  static std::size_t count_faulty(BucketKey key) {
    const Mesh mesh = load_model("torus-1k");
    const ConfigurationSet set(SIXDOF_SMALL_SUITE "/torus-1k.h5");
    const auto poses = sample_bucket(set, key, mesh, mesh, std::stoul(k_sample), 1).poses;
    return static_cast<std::size_t>(std::ranges::count_if(poses, test::is_faulty));
  }
};

TEST_F(Isolated, EveryDeathCostsItsConfigurationsOnly) {
  const std::size_t faulty = count_faulty({BucketKind::distance, 5});
  ASSERT_GT(faulty, 1u);
  std::string names;
  for (const test::Death& death : tested_deaths()) names += (names.empty() ? "" : "|") + std::string(death.name);
  const json document =
      rows("--isolate --query-timeout 2s --memory-limit 0.4 " + filter("distance", names + "|exact", "distance:05"));
  for (const test::Death& death : tested_deaths()) {
    const json entry = row(document, death.name);
    const bool dies = death.status != Status::ok;
    EXPECT_EQ(entry.at("failed"), dies ? faulty : 0) << death.name;
    for (const Status status : k_counted_statuses) {
      EXPECT_EQ(entry.value(std::string(to_string(status)), 0.0),
                status == death.status ? static_cast<double>(faulty) : 0.0)
          << death.name << " " << to_string(status);
    }
    EXPECT_EQ(entry.at("configurations"), std::stoi(k_sample)) << "the row went on";
    EXPECT_EQ(entry.at("judged"), std::stoul(k_sample) - (dies ? faulty : 0)) << death.name;
    EXPECT_EQ(entry.at("mismatch"), 0) << death.name;
    EXPECT_EQ(entry.at("sixdof").at("isolated"), true);
    EXPECT_GT(entry.at("real_time"), 0.0);
    if (dies) {
      EXPECT_THAT(entry.at("label").get<std::string>(), HasSubstr("first failure: ")) << death.name;
    }
  }
  EXPECT_EQ(row(document, "exact").at("failed"), 0);
  EXPECT_THAT(document.at("context").at("isolated").get<std::string>(), AllOf(HasSubstr("exact"), HasSubstr("abort")));
}

TEST_F(Isolated, ARowIsLostOnlyIfNothingAnswers) {
  const auto run = bench("--isolate " + filter("distance", "always-dies|dies-in-prepare|fixed-work", "distance:05"));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("2 rows could not be run"));
  const json document = json::parse(run.out);
  EXPECT_THAT(row(document, "always-dies").at("error_message").get<std::string>(),
              HasSubstr("no configuration has an answer: ended by signal 6 (Aborted)"));
  EXPECT_THAT(row(document, "dies-in-prepare").at("error_message").get<std::string>(),
              HasSubstr(std::string("dies-in-prepare: crashed while it prepared the pair: ") + k_end_of_a_bad_access));
  EXPECT_EQ(row(document, "fixed-work").at("failed"), 0);
}

TEST_F(Isolated, ThirdPartyLeavesTheProjectsOwnInThisProcess) {
  const json document = rows("--isolate=third-party " + filter("distance", "exact|fcl-rss|fixed-work", "distance:05"));
  EXPECT_FALSE(row(document, "exact").at("sixdof").contains("isolated"));
  EXPECT_EQ(row(document, "fcl-rss").at("sixdof").at("isolated"), true);
  EXPECT_EQ(row(document, "fixed-work").at("sixdof").at("isolated"), true);
  const json none = rows(filter("distance", "fcl-rss", "distance:05"));
  EXPECT_FALSE(row(none, "fcl-rss").at("sixdof").contains("isolated"));
  EXPECT_FALSE(none.at("context").contains("isolated"));
}

/// The poses of outliers, without those of times.
json outliers_of_answers(const json& entry) {
  json poses = entry.value("outliers", json::object()).value("poses", json::object());
  for (auto each = poses.begin(); each != poses.end();) each = each.key().ends_with("_ns") ? poses.erase(each) : ++each;
  return poses;
}

/// Everything but times, and the checksum that covers them, is equal in both.
TEST_F(Isolated, AnswersAndCountersAreThoseOfOneProcess) {
  for (const auto& [query, bucket] :
       {std::pair("distance", "distance:05"), std::pair("respond", "volume:03"), std::pair("collide", "volume:03")}) {
    const std::string which = filter(query, "exact|ist|fcl-rss|fcl-contacts", bucket) + "-p ist:spheres=300 ";
    const json here = rows(which), there = rows("--isolate " + which);
    ASSERT_EQ(here.at("benchmarks").size(), there.at("benchmarks").size());
    for (const json& entry : here.at("benchmarks")) {
      const json other = test::row(there, entry.at("name"));
      for (const auto& [key, value] : entry.items()) {
        const bool is_time = key.ends_with("_ns") || key.ends_with("_time") || key.starts_with("ns_per_") ||
                             key == "over_1ms" || key == "iterations" || key == "checksum" || key == "sixdof" ||
                             key == "label" || key == "outliers";
        if (!is_time) {
          EXPECT_EQ(other.at(key), value) << entry.at("name") << " " << key;
        }
      }
      EXPECT_EQ(other.value("label", ""), entry.value("label", ""));
      EXPECT_EQ(outliers_of_answers(other), outliers_of_answers(entry)) << entry.at("name");
      EXPECT_FALSE(outliers_of_answers(entry).empty() && query != std::string_view("collide")) << entry.at("name");
      EXPECT_FALSE(other.contains("processor_inside_ns"));
    }
  }
}

/// Times are taken inside: a row costs the same in both. The factor is for other work on the machine.
TEST_F(Isolated, TimesAreThoseOfOneProcess) {
  constexpr double k_factor = 2.0;
  const std::string which = "--benchmark_min_time=0.05 " + filter("distance", "fixed-work", "distance:05");
  const json here = row(rows(which), "fixed-work"), there = row(rows("--isolate " + which), "fixed-work");
  for (const char* const time : {"cpu_time", "p50_ns"}) {
    const double ratio = there.at(time).get<double>() / here.at(time).get<double>();
    EXPECT_GT(ratio, 1.0 / k_factor) << time;
    EXPECT_LT(ratio, k_factor) << time;
  }
  EXPECT_GE(there.at("iterations"), std::stoi(k_sample));
}

TEST_F(Isolated, PreparationAndColdCachesAreTimedInside) {
  const json document = rows(
      "--isolate '--benchmark_filter=^prepare/algorithm:fcl-rss/pair:torus-1k$|"
      "^distance/algorithm:fcl-rss/pair:torus-1k/distance:05/cache:cold$|"
      "^scenario/II/algorithm:fcl-contacts$' --budget 20");
  ASSERT_EQ(document.at("benchmarks").size(), 3u);
  for (const json& entry : document.at("benchmarks")) {
    EXPECT_FALSE(entry.contains("error_message")) << entry;
    EXPECT_GT(entry.at("cpu_time"), 0.0) << entry;
    EXPECT_EQ(entry.at("sixdof").at("isolated"), true) << entry;
  }
  EXPECT_GT(test::row(document, "prepare/algorithm:fcl-rss/pair:torus-1k").at("bytes"), 0.0);
}

TEST_F(Isolated, BadOptionsAreRefused) {
  const std::string which = filter("distance", "exact", "distance:05");
  EXPECT_EQ(bench("--isolate=some " + which).exit_code, 2);
  const auto time = bench("--query-timeout soon " + which);
  EXPECT_EQ(time.exit_code, 1);
  EXPECT_THAT(time.err, HasSubstr("--query-timeout"));
  const auto external = bench("--external mine " + which);
  EXPECT_EQ(external.exit_code, 1);
  EXPECT_THAT(external.err, HasSubstr("--external mine: must read NAME=COMMAND"));
  EXPECT_THAT(bench("--external mine=false " + which).err,
              HasSubstr("external algorithm mine (false): ended with exit code 1"));
  EXPECT_THAT(bench("--external exact=false " + which).exit_code, Not(0));
}

}  // namespace
}  // namespace sixdof
