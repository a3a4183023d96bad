// Meshes of the user's: sets that find them again, and a table of a pair in one line.

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/geometry/load.h>
#include "bench/common/run_guarded.h"

#include "../cli/run_program.h"
#include "../cli/scratch_folder.h"

namespace sixdof {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A folder with my.obj, a torus, and parts/my.obj, a cone; a cache of its own.
class OwnMeshes : public test::ScratchFolder {
 protected:
  void SetUp() override {
    fs::create_directories(folder() / "parts");
    fs::create_directories(folder() / "tmp");
    succeed("sixdof models make torus-300 -o my.obj; sixdof models make cone-200 -o parts/my.obj");
  }

  /// In the folder; `sixdof` and `sixdof-bench` are the programs of this build.
  test::ProgramResult run(const std::string& line, const std::string& cache = "cache") const {
    const std::string programs = fs::path(SIXDOF_BENCH_PROGRAM).parent_path().string();
    return test::run_program("export PATH=" + programs + ":$PATH TMPDIR=" + path("tmp") + " SIXDOF_CACHE=" + cache +
                             "; cd " + folder().string() + " && " + line);
  }
  test::ProgramResult succeed(const std::string& line, const std::string& cache = "cache") const {
    const auto result = run(line, cache);
    EXPECT_EQ(result.exit_code, 0) << line << '\n' << result.err;
    return result;
  }
  double volume_of(const std::string& file) const { return load_mesh(path(file)).volume(); }
  static json rows(const test::ProgramResult& result) { return json::parse(result.out).at("benchmarks"); }
  bool any_file(const std::string& folder_name, const std::string& begin) const {
    if (!fs::exists(folder() / folder_name)) return false;
    for (const auto& entry : fs::directory_iterator(folder() / folder_name)) {
      if (entry.path().filename().string().starts_with(begin)) return true;
    }
    return false;
  }
};

const std::string k_set = "sixdof generate --a my.obj --b parts/my.obj --grid 90 --distances 0.5,1 -o s.h5";
const std::string k_quick = " --benchmark_min_time=0.000001 --sample 32 --benchmark_format=json";
const std::string k_measure =
    "sixdof-bench --no-manifest '--benchmark_filter=^distance/algorithm:exact/pair:my-my/distance:(01|0.5)$'" + k_quick;
/// Small structures, so that preparing them takes no time.
const std::string k_pair = k_quick + " --budget 5 -p ist:spheres=100 -p vps:point_spacing=0.05";

TEST_F(OwnMeshes, ASetFindsItsMeshesWhereverItIsUsed) {
  succeed(k_set);
  fs::create_directories(folder() / "elsewhere");
  for (const std::string& line : {k_measure + " --set s.h5", "cd elsewhere && " + k_measure + " --set ../s.h5",
                                  "cp s.h5 elsewhere && " + k_measure + " --set elsewhere/s.h5"}) {
    const auto measured = succeed(line);
    std::set<std::string> names;
    for (const json& row : rows(measured)) {
      names.insert(row.at("name"));
      EXPECT_EQ(row.at("mismatch"), 0) << row;
      EXPECT_GT(row.at("judged"), 0) << row;
    }
    EXPECT_EQ(names, (std::set<std::string>{"distance/algorithm:exact/pair:my-my/distance:01",
                                            "distance/algorithm:exact/pair:my-my/distance:0.5"}));
    EXPECT_EQ(measured.err, "") << line;
  }
  EXPECT_THAT(succeed("sixdof verify s.h5 --sample 5").out, HasSubstr("distance/0.5"));
}

TEST_F(OwnMeshes, ARunEndsBeforeAnythingIsMeasuredIfAMeshIsMissingOrHasChanged) {
  succeed(k_set);
  fs::rename(folder() / "parts/my.obj", folder() / "parts/moved.obj");
  for (const std::string& program : {k_measure + " --set s.h5", std::string("sixdof verify s.h5 --sample 5")}) {
    const auto missing = run(program);
    EXPECT_EQ(missing.exit_code, k_exit_error);
    EXPECT_EQ(missing.out, "");
    EXPECT_THAT(missing.err, AllOf(HasSubstr("s.h5: mesh my: no file parts/my.obj"), HasSubstr("--a or --b")));
    succeed(program + " --b parts/moved.obj");
  }
  fs::copy(folder() / "my.obj", folder() / "parts/my.obj");
  for (const std::string& program : {k_measure + " --set s.h5", std::string("sixdof verify s.h5 --sample 5")}) {
    const auto changed = run(program);
    EXPECT_EQ(changed.exit_code, k_exit_error);
    EXPECT_EQ(changed.out, "");
    EXPECT_TRUE(std::regex_search(
        changed.err,
        std::regex("mesh my: parts/my.obj has content hash [0-9a-f]{32}, the set was made for [0-9a-f]{32}")))
        << changed.err;
    EXPECT_THAT(run(program + " --b my.obj").err, HasSubstr("my.obj has content hash"));
  }
}

TEST_F(OwnMeshes, OneLineMeasuresAllAlgorithmsAtDistancesAndVolumes) {
  const auto first = succeed("sixdof-bench --a my.obj --b parts/my.obj" + k_pair);
  EXPECT_THAT(first.err, HasSubstr("coarse set of my with my made in "));
  std::set<std::string> algorithms, distances, queries;
  std::set<double> volumes;
  for (const json& row : rows(first)) {
    const std::string name = row.at("name");
    EXPECT_FALSE(row.contains("error_occurred")) << row;
    EXPECT_THAT(name, AllOf(HasSubstr("/pair:my-my"), Not(HasSubstr("order:path"))));
    const std::size_t algorithm = name.find(':') + 1;
    algorithms.insert(name.substr(algorithm, name.find('/', algorithm) - algorithm));
    queries.insert(name.substr(0, name.find('/')));
    const std::size_t bucket = name.find('/', name.find("pair:"));
    const std::string place = bucket == std::string::npos ? std::string() : name.substr(bucket + 1);
    if (place.starts_with("distance:")) distances.insert(place);
    if (place.starts_with("volume:")) volumes.insert(std::stod(place.substr(place.find(':') + 1)));
    if (!name.starts_with("distance/algorithm:exact")) continue;
    EXPECT_EQ(row.at("mismatch"), 0) << name;
    EXPECT_GE(row.at("configurations"), 32) << name;
  }
  EXPECT_EQ(queries, (std::set<std::string>{"cast", "collide", "distance", "prepare", "respond"}));
  EXPECT_THAT(algorithms, ::testing::IsSupersetOf({"exact", "fcl-obbrss", "fcl-rss", "fcl-contacts", "ist", "vps"}));
  EXPECT_EQ(distances,
            (std::set<std::string>{"distance:00", "distance:01", "distance:05", "distance:10", "distance:20"}));
  // 1, 5 and 10 % of the smaller body, in percent of A.
  const double smaller = std::min(1.0, volume_of("parts/my.obj") / volume_of("my.obj"));
  ASSERT_EQ(volumes.size(), 3u);
  const std::vector<double> percents(volumes.begin(), volumes.end());
  constexpr double k_decimals = 1e-3;  // of a bucket's percentage
  EXPECT_NEAR(percents[0], 1.0 * smaller, k_decimals);
  EXPECT_NEAR(percents[1], 5.0 * smaller, k_decimals);
  EXPECT_NEAR(percents[2], 10.0 * smaller, k_decimals);
  // The second time the set is in the cache, whatever the files are called.
  fs::rename(folder() / "my.obj", folder() / "ring.obj");
  const auto second =
      succeed("sixdof-bench --a ring.obj --b parts/my.obj --benchmark_filter=collide/algorithm:exact" + k_pair);
  EXPECT_THAT(second.err, AllOf(HasSubstr("coarse set of ring with my: cache/coarse-set-"), Not(HasSubstr("made"))));
  EXPECT_EQ(rows(second).size(), 8u);
  EXPECT_THAT(rows(second)[0].at("name").get<std::string>(), HasSubstr("/pair:ring-my/"));
}

TEST_F(OwnMeshes, OneMeshIsMeasuredWithACopyOfItself) {
  const auto list = succeed("sixdof-bench --a my.obj --benchmark_list_tests");
  EXPECT_THAT(list.out, HasSubstr("respond/algorithm:vps/pair:my/volume:05\n"));
  EXPECT_THAT(list.out, Not(HasSubstr("scenario")));
  EXPECT_EQ(list.err, "");
  EXPECT_FALSE(any_file("cache", "coarse-set")) << "a list needs no set";
  const auto run = succeed(
      "sixdof-bench --a my.obj --benchmark_filter=^collide/algorithm:exact/pair:my/distance:05$" + k_quick, "off");
  EXPECT_EQ(rows(run).size(), 1u);
  EXPECT_FALSE(any_file("tmp", "sixdof-coarse-set")) << "without a cache the set is removed";
  // A cache that cannot be written is none.
  succeed("sixdof-bench --a my.obj --benchmark_filter=^collide/algorithm:exact/pair:my/distance:05$" + k_quick,
          "my.obj");
}

TEST_F(OwnMeshes, ADamagedSetInTheCacheIsMadeAgain) {
  const std::string line = "sixdof-bench --a my.obj --benchmark_filter=^collide/algorithm:exact/pair:my/distance:05$";
  succeed(line + k_quick);
  for (const auto& entry : fs::directory_iterator(folder() / "cache")) fs::resize_file(entry.path(), 4000);
  EXPECT_THAT(succeed(line + k_quick).err, HasSubstr("made in"));
}

TEST_F(OwnMeshes, AnOpenMeshHasDistancesOnly) {
  // A box without its lid.
  std::ofstream(path("tray.off")) << "OFF\n8 10 0\n"
                                     "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
                                     "3 0 2 1\n3 0 3 2\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n"
                                     "3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";
  const auto open = succeed("sixdof-bench --a tray.off --b my.obj" + k_pair);
  EXPECT_THAT(open.err, AllOf(HasSubstr("no volumes: tray is no solid (not closed: 4 border edges)\n"),
                              HasSubstr("rows that need solids: tray (not closed: 4 border edges); `sixdof repair")));
  std::size_t distances = 0;
  for (const json& row : rows(open)) {
    EXPECT_FALSE(row.contains("error_occurred")) << row;
    EXPECT_THAT(row.at("name").get<std::string>(), Not(HasSubstr("volume:")));
    distances += row.at("name").get<std::string>().starts_with("distance/algorithm:exact/pair:tray-my/") ? 1 : 0;
  }
  EXPECT_EQ(distances, 5u);
}

TEST_F(OwnMeshes, WarnsOfOddSizesAndOfBucketsThatNothingReaches) {
  std::ofstream(path("tiny.off")) << "OFF\n4 4 0\n0 0 0\n.001 0 0\n0 .001 0\n0 0 .001\n"
                                     "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  const auto measured = succeed("sixdof-bench --a my.obj --b tiny.off" + k_pair);
  EXPECT_TRUE(std::regex_search(measured.err, std::regex("warning: my is [0-9]+ times as large as tiny \\(box")))
      << measured.err;
  EXPECT_TRUE(std::regex_search(measured.err, std::regex("no volumes: tiny has [0-9.e-]+ times the volume of my, too")))
      << measured.err;
  for (const json& row : rows(measured)) EXPECT_FALSE(row.contains("error_occurred")) << row;
  succeed("sixdof generate --a my.obj --b tiny.off --grid 90 --distances 5 --volumes 1 -o t.h5");
  const auto of_set =
      succeed("sixdof-bench --no-manifest --set t.h5 --benchmark_filter=^collide/algorithm:exact/" + k_quick);
  EXPECT_THAT(of_set.err, HasSubstr("t.h5: no configuration reaches volume 1 %\n"));
  EXPECT_THAT(of_set.err, Not(HasSubstr("reaches distance")));
}

TEST_F(OwnMeshes, RefusesOptionsThatDoNotGoTogether) {
  succeed(k_set);
  for (const char* const bad : {"--b my.obj", "--a my.obj --set s.h5 --set s.h5", "--a my.obj --manifest m.json"}) {
    const auto refused = run(std::string("sixdof-bench ") + bad);
    EXPECT_EQ(refused.exit_code, k_exit_usage) << bad;
    EXPECT_NE(refused.err, "") << bad;
  }
  EXPECT_THAT(run("sixdof-bench --a lost.obj").err, HasSubstr("lost.obj"));
  EXPECT_EQ(run("sixdof-bench --a lost.obj").exit_code, k_exit_error);
}

}  // namespace
}  // namespace sixdof
