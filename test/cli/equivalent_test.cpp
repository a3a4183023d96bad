#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/common/run_guarded.h"

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-9;  // of a sum of two printed values

using nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

/// Coarse points and short paths, so that a search takes a second.
constexpr const char* k_small =
    " --scenario II --algorithm vps-field --steps 40 --grid voxel_size=0.06,0.04,0.03 "
    "--grid point_spacing=0.06,0.04,0.03 ";
constexpr const char* k_small_paper =
    " --paper --scenario II --algorithm vps --grid voxel_size=0.06,0.04,0.03 --grid point_spacing=0.06,0.04,0.03 ";

class Equivalent : public test::ScratchFolder {
 protected:
  test::ProgramResult equivalent(const std::string& arguments) const { return test::run_program(command(arguments)); }

  std::string command(const std::string& arguments) const {
    return "SIXDOF_CACHE=" + path("cache") + " " + SIXDOF_PROGRAM + " equivalent " + arguments;
  }

  /// Begins the command and kills it once the journal of rows.json has so many measurements.
  void kill_after(std::size_t measurements, const std::string& arguments) const {
    std::string script = command(arguments) + " > /dev/null 2>&1 & pid=$!; ";
    script += "until [ \"$(grep -c '\"measured\"' ";
    script += path("rows.json.journal") + ")\" -ge " + std::to_string(measurements);
    script += " ] || ! kill -0 $pid; do sleep 0.01; done; kill -9 $pid; wait $pid";
    constexpr int k_killed = 128 + 9;
    ASSERT_EQ(test::run_program(script).exit_code, k_killed) << "ended before it was killed";
  }

  /// The measurements in whole lines of that journal.
  std::vector<json> journal() const {
    std::vector<json> list;
    std::ifstream file(path("rows.json.journal"));
    for (std::string line; std::getline(file, line) && !file.eof();) {
      const json entry = json::parse(line);
      if (entry.contains("measured")) list.push_back(entry.at("measured"));
    }
    return list;
  }

  json document(const std::string& name) const { return json::parse(std::ifstream(path(name))); }

  /// What the measures of `sixdof quality` are with the settings of a row.
  static json quality(const std::string& resolution, const std::string& law) {
    std::string words = SIXDOF_PROGRAM;
    words += " quality --scenario II --algorithm vps --steps 25 --json --law ";
    words += law + " -p ";
    for (const char c : resolution) words += c == ' ' ? std::string(" -p ") : std::string(1, c);
    const auto done = test::run_program(words);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return json::parse(done.out).at("measures");
  }
};

TEST_F(Equivalent, PrintsPredictedBesideMeasured) {
  const auto result = equivalent(k_small + std::string("--tau 4us -o ") + path("rows.json"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* const words :
       {"scenario II, algorithm vps-field, law wall-traction, tau = 4us", "gamma_F (radians)", "point_spacing", "first",
        "answer     voxel_size=", "mean |eta predicted - measured|"}) {
    EXPECT_THAT(result.out, HasSubstr(words));
  }
  std::ifstream file(path("rows.json"));
  const json written = json::parse(file);
  EXPECT_FALSE(written.at("context").contains("interrupted"));
  const auto& rows = written.at("benchmarks");
  std::size_t grid = 0;
  for (const auto& row : rows) {
    const std::string name = row.at("name");
    EXPECT_THAT(name, HasSubstr("equivalent/scenario:II/algorithm:vps-field/tau:4us"));
    EXPECT_GT(row.at("measured_ns"), 0.0) << name;
    EXPECT_GT(row.at("eta_measured"), 0.0) << name;
    grid += name.find("/point_spacing:") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(grid, 9u);
  EXPECT_EQ(rows.at(0).at("tau_ns"), 4000.0);
  const double size = rows.at(0).at("sixdof").at("settings").at("voxel_size");
  EXPECT_TRUE(size >= 0.015 && size <= 0.1) << size;  // reach 2, and the parameter's own limit
}

TEST_F(Equivalent, FindsTheLeastTimeAndPrintsJson) {
  const auto result = equivalent(k_small + std::string("--reverse 0.05 --json --weights sigma=0.5,gamma=2"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json printed = json::parse(result.out);
  const auto& answer = printed.at("benchmarks").at(0);
  EXPECT_EQ(answer.at("name"), "equivalent/scenario:II/algorithm:vps-field/eta:0.05");
  const double sigma = answer.at("sigma_F"), gamma = answer.at("gamma_F_deg");
  EXPECT_NEAR(answer.at("eta_measured"), 0.5 * sigma + 2.0 * gamma * 3.14159265358979 / 180.0, k_rounding);
  EXPECT_TRUE(printed.at("context").contains("algorithm:vps-field"));
}

TEST_F(Equivalent, SaysThatTauCannotBeMet) {
  const auto slower = equivalent(k_small + std::string("--tau 1ns"));
  ASSERT_EQ(slower.exit_code, 0) << slower.err;
  EXPECT_THAT(slower.out, HasSubstr("tau = 1ns cannot be met: all resolutions in voxel_size=0.015..0.1 "
                                    "point_spacing=0.015..0.1 are slower"));
  const auto faster = equivalent(k_small + std::string("--tau 5s --reach 1"));
  EXPECT_THAT(faster.out, HasSubstr("tau = 5s cannot be met: all resolutions in voxel_size=0.03..0.06 "
                                    "point_spacing=0.03..0.06 are faster"));
}

TEST_F(Equivalent, TellsHowLongItTakesAndEverySetting) {
  const auto result = equivalent(k_small + std::string("--tau 4us"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("sixdof equivalent: 1 search: 9 settings, of which 0 are measured, and about 2 "
                                    "predictions\nsixdof equivalent: about "));
  EXPECT_THAT(result.err, ContainsRegex("equivalent: II vps-field voxel_size=0.03 point_spacing=0.03: [0-9]+ % done, "
                                        "[0-9:]+ left\n"));
  EXPECT_THAT(result.err, HasSubstr("sixdof equivalent: nothing was left out\n"));
}

TEST_F(Equivalent, AShortBudgetNamesWhatWasNotSearchedAndResumeSearchesIt) {
  const std::string words = k_small + std::string("--tau 4us -o ") + path("rows.json");
  const auto cut = equivalent(words + " --budget 1ns");
  ASSERT_EQ(cut.exit_code, 0) << cut.err;
  const std::string named = "II vps-field at tau = 4us: the budget was spent";
  EXPECT_THAT(cut.out, HasSubstr("not searched: " + named));
  EXPECT_THAT(cut.err, HasSubstr("sixdof equivalent: left out: " + named));
  const json document_of_cut = document("rows.json");
  EXPECT_EQ(document_of_cut.at("context").at("interrupted"), "true");
  const json& left = document_of_cut.at("not_searched").at(0);
  EXPECT_EQ(left.at("scenario"), "II");
  EXPECT_EQ(left.at("algorithm"), "vps-field");
  EXPECT_EQ(left.at("tau_ns"), 4000.0);
  EXPECT_THAT(left.at("why").get<std::string>(), HasSubstr("the budget was spent"));

  const auto whole = equivalent(words + " --resume --budget 1h");
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_THAT(whole.out, HasSubstr("answer     voxel_size="));
  EXPECT_THAT(whole.err, HasSubstr(" in all, the budget is 1 h\n"));
  EXPECT_FALSE(document("rows.json").at("context").contains("interrupted"));
  EXPECT_TRUE(document("rows.json").at("not_searched").empty());
}

TEST_F(Equivalent, KilledTwiceAndContinuedHasTheMeasurementsOfAllRuns) {
  const std::string words = k_small_paper + std::string("--tau 3us,6us --steps 4000 -o ");
  const std::string here = words + path("rows.json");
  ASSERT_NO_FATAL_FAILURE(kill_after(3, here));
  const std::vector<json> first = journal();
  ASSERT_NO_FATAL_FAILURE(kill_after(6, here + " --resume"));
  const std::vector<json> second = journal();
  ASSERT_GT(second.size(), first.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(second[i], first[i]);
  EXPECT_FALSE(std::filesystem::exists(path("rows.json")));
  const auto forgetful = equivalent(here);
  EXPECT_EQ(forgetful.exit_code, k_exit_error);
  EXPECT_THAT(forgetful.err, HasSubstr("--resume continues it"));

  const auto done = equivalent(here + " --resume");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_FALSE(std::filesystem::exists(path("rows.json.journal")));
  const json document_here = document("rows.json");
  const json& kept = document_here.at("measurements");
  for (const json& measured : second) {
    EXPECT_TRUE(std::find(kept.begin(), kept.end(), measured) != kept.end()) << measured;
  }

  // Errors of the grid are those of a run that was not killed. Times, and what follows from them, differ by the noise.
  const auto whole = equivalent(words + path("whole.json"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const auto errors = [](const json& result) {
    std::map<std::string, double> grid;
    for (const json& row : result.at("benchmarks")) {
      const std::string name = row.at("name");
      if (name.find("/voxel_size:") != std::string::npos) grid[name] = row.value("eta_measured", -1.0);
    }
    return grid;
  };
  EXPECT_EQ(errors(document_here).size(), 18u);
  EXPECT_EQ(errors(document_here), errors(document("whole.json")));

  // Of a whole file --resume prints the same table and measures nothing.
  const auto again = equivalent(here + " --resume");
  EXPECT_EQ(again.out, done.out);
  EXPECT_THAT(again.err, Not(HasSubstr("% done")));
  EXPECT_EQ(document("rows.json").at("benchmarks"), document_here.at("benchmarks"));
  EXPECT_EQ(document("rows.json").at("paper"), document_here.at("paper"));
}

TEST_F(Equivalent, PrintsThePapersTableAndWhatIsWorse) {
  const std::string words = k_small_paper + std::string("--tau 3us --steps 25 -o ") + path("rows.json");
  const auto text = equivalent(words);
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("At a mean query time of 3us"));
  const json lines = document("rows.json").at("paper");
  ASSERT_EQ(lines.size(), 1u) << "the paper prints gamma of II";
  const json& line = lines.at(0);
  EXPECT_EQ(line.at("measure"), "gamma_F_deg");
  EXPECT_EQ(line.at("scenario"), "II");
  EXPECT_EQ(line.at("algorithm"), "vps");
  EXPECT_EQ(line.at("printed"), 2.4);
  EXPECT_EQ(line.at("tau_ns"), 3000.0);
  const std::string resolution = line.at("resolution");
  EXPECT_THAT(resolution, ContainsRegex("^voxel_size=[0-9.]+ point_spacing=[0-9.]+$"));
  for (const auto& [law, name] :
       {std::pair("paper", "as_printed"), std::pair("own", "whole_path"), std::pair("own", "window")}) {
    const double value = line.at(name).at("value");
    EXPECT_NEAR(value, quality(resolution, law).at("gamma_F_deg").get<double>(), k_rounding) << name;
    EXPECT_EQ(line.at(name).at("worse"), value > 2.4) << name;
  }
  const auto markdown = equivalent(words + " --resume --markdown");
  EXPECT_THAT(markdown.out, HasSubstr("### At a mean query time of 3us"));
  EXPECT_THAT(markdown.out, HasSubstr("| gamma\\_F\\_deg | II | vps | 2.4 | voxel\\_size="));
  EXPECT_THAT(markdown.out, HasSubstr("| vps | 1 |"));
  EXPECT_EQ(equivalent("--markdown").exit_code, k_exit_usage) << "needs --paper";
}

TEST_F(Equivalent, RefusesBadArgumentsAndNamesThem) {
  for (const auto& [arguments, words] :
       {std::pair("--scenario V", "no scenario"), std::pair("--scenario II,VI", "no scenario"),
        std::pair("--tau 0ms", "0ms: must be above zero"), std::pair("--tau 0.9", "0.9: must be a number with a unit"),
        std::pair("--tau=-3us", "above zero"), std::pair("--algorithm exact", "exact has 0 swept parameters"),
        std::pair("--algorithm fcl-rss", "gives no response"), std::pair("--algorithm vbs", "vbs"),
        std::pair("--algorithm vps --weights sigma=-1,gamma=2", "must not be negative"),
        std::pair("--algorithm vps --weights alpha=1", "sigma or gamma"),
        std::pair("--algorithm vps --law hooke", "hooke"),
        std::pair("--algorithm vps --grid voxel_size=0.01,0.02", "at least 3"),
        std::pair("--algorithm vps --grid voxel_size=0.01,x,3", "is no number"),
        std::pair("--algorithm vps --grid spheres=10,20,30", "no algorithm of the study searches it"),
        std::pair("--algorithm vps --grid voxel_size=0.01,0.02,7", "from 0.0005 to 0.1"),
        std::pair("--algorithm vps -p vps:voxel_size=0.1", "is searched"),
        std::pair("--algorithm vps -p vps:depth=no", "must be one of"),
        std::pair("--budget 10", "--budget 10: must be a positive time with its unit")}) {
    const auto result = equivalent(arguments);
    EXPECT_EQ(result.exit_code, k_exit_error) << arguments;
    EXPECT_THAT(result.err, HasSubstr(words)) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
  }
  EXPECT_EQ(equivalent("--reach 0.5").exit_code, k_exit_usage);
  EXPECT_EQ(equivalent("--reverse -1").exit_code, k_exit_usage);
  EXPECT_EQ(equivalent("--paper --reverse 0.1").exit_code, k_exit_usage);
  EXPECT_EQ(equivalent("--resume").exit_code, k_exit_usage) << "needs a file";
}

}  // namespace
}  // namespace sixdof
