#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/common/run_guarded.h"

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-9;  // of a sum of two printed values

using ::testing::HasSubstr;

/// Coarse points and short paths, so that a search takes a second.
constexpr const char* k_small =
    " --scenario II --algorithm vps-field --steps 40 --grid voxel_size=0.06,0.04,0.03 "
    "--grid point_spacing=0.06,0.04,0.03 ";

class Equivalent : public test::ScratchFolder {
 protected:
  test::ProgramResult equivalent(const std::string& arguments) const {
    return test::run_program("SIXDOF_CACHE=" + path("cache") + " " + SIXDOF_PROGRAM + " equivalent " + arguments);
  }
};

TEST_F(Equivalent, PrintsPredictedBesideMeasured) {
  const auto result = equivalent(k_small + std::string("--tau 4us -o ") + path("rows.json"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* const words :
       {"scenario II, algorithm vps-field, law depth, tau = 4us", "gamma_F (radians)", "point_spacing", "first",
        "answer     voxel_size=", "mean |eta predicted - measured|"}) {
    EXPECT_THAT(result.out, HasSubstr(words));
  }
  std::ifstream file(path("rows.json"));
  const auto json = nlohmann::json::parse(file);
  EXPECT_FALSE(json.at("context").contains("interrupted"));
  const auto& rows = json.at("benchmarks");
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
  const auto json = nlohmann::json::parse(result.out);
  const auto& answer = json.at("benchmarks").at(0);
  EXPECT_EQ(answer.at("name"), "equivalent/scenario:II/algorithm:vps-field/eta:0.05");
  const double sigma = answer.at("sigma_F"), gamma = answer.at("gamma_F_deg");
  EXPECT_NEAR(answer.at("eta_measured"), 0.5 * sigma + 2.0 * gamma * 3.14159265358979 / 180.0, k_rounding);
  EXPECT_TRUE(json.at("context").contains("algorithm:vps-field"));
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
        std::pair("--algorithm vps -p vps:depth=no", "must be one of")}) {
    const auto result = equivalent(arguments);
    EXPECT_EQ(result.exit_code, k_exit_error) << arguments;
    EXPECT_THAT(result.err, HasSubstr(words)) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
  }
  EXPECT_EQ(equivalent("--reach 0.5").exit_code, k_exit_usage);
  EXPECT_EQ(equivalent("--reverse -1").exit_code, k_exit_usage);
}

}  // namespace
}  // namespace sixdof
