#include "bench/harness/suite.h"

#include <unistd.h>

#include <fstream>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof::bench {
namespace {

struct SuiteFile : ::testing::Test {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("sixdof-suite-" + std::to_string(::getpid()) + ".json");
  ~SuiteFile() override { std::filesystem::remove(path); }

  Suite read(const std::string& rows, const std::vector<std::string>& external = {},
             const std::vector<std::string>& named_only = {}) const {
    std::ofstream(path) << R"({"rows": [)" << rows << "]}";
    return read_suite(path, external, named_only);
  }
};

TEST_F(SuiteFile, TakesRowsWhoseEveryPartIsListed) {
  const Suite suite = read(R"({"query": ["distance", "respond"], "algorithm": ["exact"], "pair": "all",
                              "distance": ["01", "05"]}, {"query": ["scenario"], "algorithm": "all"})");
  EXPECT_TRUE(suite("distance/algorithm:exact/pair:ship/distance:05"));
  EXPECT_TRUE(suite("distance/algorithm:exact/pair:ship")) << "only parts of the name are looked up";
  EXPECT_FALSE(suite("collide/algorithm:exact/pair:ship/distance:05"));
  EXPECT_FALSE(suite("distance/algorithm:ist/pair:ship/distance:05"));
  EXPECT_FALSE(suite("distance/algorithm:exact/pair:ship/distance:02"));
  EXPECT_FALSE(suite("respond/algorithm:exact/pair:ship/volume:01")) << "no volumes are listed";
  EXPECT_FALSE(suite("distance/algorithm:exact/pair:ship/distance:05/order:path"));
  EXPECT_FALSE(suite("distance/algorithm:exact/pair:ship/distance:05/cache:cold"));
  EXPECT_TRUE(suite("scenario/II/algorithm:ist"));
  EXPECT_FALSE(suite("scenarios/II/algorithm:ist"));
}

TEST_F(SuiteFile, TakesCastsByTheirMotionAndStep) {
  const Suite suite = read(R"({"query": ["cast"], "algorithm": ["exact"], "pair": "all", "motion": "all",
                              "step": ["10"], "sample": 64})");
  EXPECT_EQ(suite("cast/algorithm:exact/pair:ship/motion:tumble/step:10"), 64u);
  EXPECT_FALSE(suite("cast/algorithm:exact/pair:ship/motion:tumble/step:1"));
  EXPECT_FALSE(suite("collide/algorithm:exact/pair:ship/distance:05"));
  EXPECT_FALSE(read(R"({"query": ["cast"], "algorithm": "all", "pair": "all"})")(
      "cast/algorithm:exact/pair:ship/motion:tumble/step:10"))
      << "every part of a name has to be listed";
}

TEST_F(SuiteFile, NamesOfAlgorithmsStandForTheirVariants) {
  const Suite suite = read(
      R"({"query": ["collide"], "algorithm": ["vps"]}, {"query": ["distance"], "algorithm": "all"})", {}, {"slow@x=1"});
  EXPECT_TRUE(suite("collide/algorithm:vps@point_spacing=0.004"));
  EXPECT_FALSE(suite("collide/algorithm:vps-field@point_spacing=0.004"));
  EXPECT_TRUE(suite("distance/algorithm:vps@point_spacing=0.004"));
  EXPECT_FALSE(suite("distance/algorithm:slow@x=1"));
}

TEST_F(SuiteFile, SettingsOfAnEntryAreAVariantAndItsScenarioIsTaken) {
  const Suite suite = read(R"({"query": ["scenario"], "scenario": ["II"], "algorithm": ["vps", "it"],
                               "settings": {"b": 0.5, "a": "1e-3"}})");
  EXPECT_TRUE(suite("scenario/II/algorithm:vps@b=0.5,a=1e-3"));
  EXPECT_FALSE(suite("scenario/II/algorithm:vps"));
  EXPECT_FALSE(suite("scenario/II/algorithm:vps@b=0.5"));
  EXPECT_FALSE(suite("scenario/II/algorithm:vps@a=1e-3,b=0.5")) << "in the order of the file";
  EXPECT_FALSE(suite("scenario/III/algorithm:vps@b=0.5,a=1e-3"));
  const Suite others = read(R"({"query": ["scenario"], "algorithm": "all"}, {"query": ["collide"], "algorithm": ["vps"],
                                "settings": {"b": 1}})");
  EXPECT_FALSE(others("scenario/II/algorithm:vps@b=1")) << "variants of a list are in their entries alone";
  EXPECT_TRUE(others("scenario/II/algorithm:vps@b=2")) << "those of the command line are the algorithm's";
  EXPECT_TRUE(others("collide/algorithm:vps@b=1"));
  read(
      R"({"query": ["scenario"], "scenario": ["II"], "algorithm": ["vps", "it"], "settings": {"b": 0.5, "a": "1e-3"}})");
  const std::vector<VariantRequest> variants = suite_variants(path);
  ASSERT_EQ(variants.size(), 2u);
  EXPECT_EQ(variants[1].algorithm, "it");
  EXPECT_EQ(variants[1].assignments, (std::vector<std::string>{"b=0.5", "a=1e-3"}));
  for (const char* const wrong : {R"({"query": ["scenario"], "algorithm": "all", "settings": {"b": 1}})",
                                  R"({"query": ["scenario"], "settings": {"b": 1}})",
                                  R"({"query": ["scenario"], "algorithm": ["vps"], "settings": {}})",
                                  R"({"query": ["scenario"], "algorithm": ["vps"], "settings": {"b": [1]}})"}) {
    EXPECT_THROW(read(wrong), BadFile) << wrong;
  }
}

TEST_F(SuiteFile, TakesExternalAlgorithmsWhereAlgorithmsAreListed) {
  const Suite suite = read(R"({"query": ["collide"], "algorithm": ["exact"]})", {"mine"});
  EXPECT_TRUE(suite("collide/algorithm:mine"));
  EXPECT_FALSE(suite("distance/algorithm:mine"));
}

TEST_F(SuiteFile, TakesRivalsWhereTheyAreListed) {
  std::ofstream(path) << R"({"rows": [{"query": ["collide"], "algorithm": ["rivals"]},
                                      {"query": ["distance"], "algorithm": ["exact"]}]})";
  const Suite suite = read_suite(path, {}, {"parry"}, {"parry"});
  EXPECT_TRUE(suite("collide/algorithm:parry"));
  EXPECT_FALSE(suite("collide/algorithm:exact"));
  EXPECT_FALSE(suite("distance/algorithm:parry"));
  EXPECT_FALSE(read_suite(path, {}, {}, {})("collide/algorithm:exact")) << "no rival is not all algorithms";
}

TEST_F(SuiteFile, LeavesOutOfAllWhatMustBeNamed) {
  const Suite all = read(R"({"query": ["collide"], "algorithm": "all", "pair": "all"})", {}, {"slow"});
  EXPECT_TRUE(all("collide/algorithm:exact/pair:slow"));
  EXPECT_FALSE(all("collide/algorithm:slow/pair:ship"));
  const Suite named = read(R"({"query": ["collide"], "algorithm": ["slow"], "pair": "all"})", {}, {"slow"});
  EXPECT_TRUE(named("collide/algorithm:slow/pair:ship"));
}

TEST_F(SuiteFile, LimitsTheSampleOfRowsByTheirFirstEntry) {
  const Suite suite = read(R"({"query": ["collide"], "algorithm": ["slow"], "sample": 32},
                              {"query": ["collide"], "algorithm": "all"})");
  EXPECT_EQ(suite("collide/algorithm:slow"), 32u);
  EXPECT_EQ(suite("collide/algorithm:fast"), std::numeric_limits<std::size_t>::max());
  EXPECT_EQ(suite("distance/algorithm:slow"), std::nullopt);
}

TEST_F(SuiteFile, RefusesWhatItCannotRead) {
  for (const char* bad : {R"({"query": ["a"], "sample": 0})", R"({"query": ["a"], "sample": "32"})", R"({"query": []})",
                          R"({"query": "some"})", R"({"query": 5})", "{"}) {
    EXPECT_THROW(read(bad), BadFile) << bad;
  }
  EXPECT_THROW(read_suite("no-such-file", {}, {}), BadFile);
}

}  // namespace
}  // namespace sixdof::bench
