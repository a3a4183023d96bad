#include "bench/study/survey_file.h"

#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/results/results.h>

#include "../cli/scratch_folder.h"

namespace sixdof::study {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class SurveyFiles : public test::ScratchFolder {
 protected:
  static SurveyShard shard(std::size_t number, double scale = 1.0) {
    SurveyCell apart{.question = bench::QueryKind::respond, .key = {BucketKind::distance, 5}};
    apart.configurations = 100;
    apart.reachable = apart.asked = apart.judged = 80;
    apart.failed = 10;
    apart.sum_ns = 700.0 * scale;
    apart.max_ns = apart.max_least_ns = 50.0 * scale;
    apart.phantoms = apart.wrong = 4;
    apart.phantom_sum = 12.0;
    apart.phantom_max = 5.0;
    apart.poses = {{"max_ns", scale > 1.0 ? "1 0 0 1 0 0 0" : "2 0 0 1 0 0 0"}};
    SurveyCell deep{.question = bench::QueryKind::respond, .key = {BucketKind::volume, 1}};
    deep.configurations = deep.reachable = deep.asked = deep.judged = 50;
    deep.sum_ns = 5000.0;
    deep.max_ns = deep.max_least_ns = 400.0;
    deep.force_sum = 500.0;
    deep.error_sum = 2.5;
    deep.error_squares = 0.5;
    deep.error_max = 0.25;
    return {.identity = {.set = "00ff",
                         .grid = "paper",
                         .pair = "it",
                         .a = "it",
                         .b = "it",
                         .algorithm = "ist@spheres=7",
                         .version = "1",
                         .settings = "spheres=7",
                         .command = "sixdof query --a it --b it --algorithm ist",
                         .questions = {"respond"},
                         .approximates = true,
                         .shards = 2},
            .number = number,
            .context = {{"cpu_model", "a processor"}},
            .prepare_ns = 3e6,
            .bytes = 77.0,
            .counts = {{"spheres_a", 7.0}},
            .cells = {apart, deep}};
  }

  std::filesystem::path write(const SurveyShard& shard, const std::string& name) const {
    write_shard(folder() / name, shard);
    return folder() / name;
  }
};

TEST_F(SurveyFiles, AreReadAsTheyWereWritten) {
  const std::filesystem::path file = write(shard(2, 3.0), "2.json");
  const SurveyShard read = read_shard(file);
  EXPECT_EQ(read.identity, shard(2).identity);
  EXPECT_EQ(read.number, 2u);
  ASSERT_EQ(read.cells.size(), 2u);
  EXPECT_EQ(read.cells[0].key, (BucketKey{BucketKind::distance, 5}));
  EXPECT_EQ(read.cells[0].sum_ns, 2100.0);
  EXPECT_EQ(read.cells[0].poses, shard(2, 3.0).cells[0].poses);
  EXPECT_TRUE(has_shard(file, shard(2).identity, 2));
  EXPECT_FALSE(has_shard(file, shard(1).identity, 1));
  SurveyIdentity other = shard(2).identity;
  other.set = "00fe";
  EXPECT_FALSE(has_shard(file, other, 2));
  EXPECT_FALSE(has_shard(folder() / "none.json", other, 2));
}

TEST_F(SurveyFiles, MakeAResultWithMeanLongestAndWorstPose) {
  const nlohmann::ordered_json document = survey_document({write(shard(2, 3.0), "2.json"), write(shard(1), "1.json")});
  results::Results read;
  results::parse_results(document.dump(), "survey.json", read);
  ASSERT_EQ(read.rows.size(), 3u);
  EXPECT_EQ(read.rows[0].name, "prepare/algorithm:ist@spheres=7/pair:it");
  EXPECT_EQ(read.rows[0].value("spheres_a"), 7.0);
  const results::Row& apart = read.rows[1];
  EXPECT_EQ(apart.name, "respond/algorithm:ist@spheres=7/pair:it/distance:05");
  EXPECT_EQ(apart.fields.configurations, 160u);
  EXPECT_DOUBLE_EQ(*apart.value(results::k_processor_mean), (700.0 + 2100.0) / 140.0) << "over what was answered";
  EXPECT_EQ(apart.value("max_ns"), 150.0);
  EXPECT_EQ(apart.outliers.poses.at("max_ns"), "1 0 0 1 0 0 0");
  EXPECT_EQ(apart.value("phantoms"), 8.0);
  EXPECT_DOUBLE_EQ(*apart.value("phantom_force_max"), 5.0 / 10.0) << "of the mean force at the least overlap";
  EXPECT_DOUBLE_EQ(*apart.value("phantom_force_mean"), 3.0 / 10.0);
  EXPECT_EQ(read.rows[2].value("volume_error_mean"), 0.05);
  const auto& summary = document.at("survey").at("algorithms").at(0);
  EXPECT_EQ(summary.at("tests"), 300);
  EXPECT_EQ(summary.at("asked"), 260);
  EXPECT_EQ(summary.at("failed"), 20);
}

TEST_F(SurveyFiles, RefuseWhatIsMissingTwiceDamagedOrForeign) {
  const std::filesystem::path first = write(shard(1), "1.json"), second = write(shard(2), "2.json");
  EXPECT_THAT([&] { survey_document({second}); },
              ThrowsMessage<BadArgument>(HasSubstr("1 of 2 shards are missing: 1")));
  EXPECT_THAT(
      [&] {
        survey_document({first, second, write(shard(1), "again.json")});
      },
      ThrowsMessage<BadArgument>(HasSubstr("shard 1 of ist@spheres=7 is there twice")));
  EXPECT_THROW(survey_document({}), BadArgument);
  SurveyShard foreign = shard(2);
  foreign.identity.settings = "spheres=8";
  EXPECT_THAT(
      [&] {
        survey_document({first, write(foreign, "foreign.json")});
      },
      ThrowsMessage<BadFile>(HasSubstr("foreign.json")));
  foreign = shard(1);
  foreign.identity.algorithm = "exact";
  foreign.identity.set = "00fe";
  EXPECT_THAT(
      [&] {
        survey_document({first, second, write(foreign, "set.json")});
      },
      ThrowsMessage<BadFile>(HasSubstr("another configuration set")));
  for (const char* const text : {"", "{}", "[1]", R"({"sixdof_survey_shard": 1})", R"({"sixdof_survey_shard": 2})"}) {
    std::ofstream(folder() / "damaged.json") << text;
    EXPECT_THAT([&] { read_shard(folder() / "damaged.json"); }, ThrowsMessage<BadFile>(HasSubstr("damaged.json")))
        << text;
  }
}

}  // namespace
}  // namespace sixdof::study
