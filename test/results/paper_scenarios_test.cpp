#include <sixdof/results/paper_scenarios.h>

#include <algorithm>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "result_rows.h"

namespace sixdof::results {
namespace {

using test::Json;

Json scenario_row(const std::string& scenario, const std::string& algorithm, const Json& values) {
  Json row = test::row("scenario", algorithm, "", "distance", 0.0, 2000.0, values);
  row["name"] = "scenario/" + scenario + "/algorithm:" + algorithm;
  row["sixdof"].erase("bucket");
  row["sixdof"].erase("pair");
  row["sixdof"]["scenario"] = scenario;
  return row;
}

const PaperMeasure& measure_of(const PaperScenarioLine& line, const std::string& name) {
  return *std::ranges::find(line.measures, name, &PaperMeasure::name);
}

TEST(PaperScenarios, HaveTheirResolutionAndThePrintedOne) {
  const Results results = test::results_of({scenario_row("Ia", "vps@s=1",
                                                         {{"voxels_x", 728},
                                                          {"voxels_y", 25},
                                                          {"voxels_z", 304},
                                                          {"points", 15663},
                                                          {"sigma_F", 0.5},
                                                          {"sigma_F_all", 0.04}}),
                                            scenario_row("Ia", "ist", {{"spheres_a", 10000}, {"sigma_F", 0.2}}),
                                            scenario_row("Ia", "null", {{"sigma_F", 0.2}}),
                                            test::row("respond", "vps", "bunny", "volume", 1.0, 5.0)});
  const auto lines = paper_scenario_lines(row_groups(results));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].algorithm, "vps@s=1");
  EXPECT_EQ(lines[0].resolution, "728x25x304, 15,663");
  EXPECT_EQ(lines[0].printed_resolution, "728x24x303, 15,669");
  EXPECT_EQ(lines[0].mean_ns, 2000.0);
  EXPECT_EQ(measure_of(lines[0], "sigma_F").value, 0.04) << "over the whole path";
  EXPECT_EQ(measure_of(lines[0], "sigma_F").printed, 0.043);
  EXPECT_FALSE(measure_of(lines[0], "nu_T").value || measure_of(lines[0], "nu_T").printed);
  EXPECT_EQ(lines[1].printed_resolution, "") << "the paper prints no number of spheres";
  EXPECT_EQ(measure_of(lines[1], "sigma_F").value, 0.2) << "the window is the whole path";
  EXPECT_EQ(measure_of(lines[1], "sigma_F").printed, 0.176);
}

TEST(PaperScenarios, NameTheLawThatTheRowWasJudgedBy) {
  Json row = scenario_row("III", "vps", {{"sigma_T", 0.04}, {"sigma_T_by_depth", 0.25}, {"nu_T", 0.9}});
  row["sixdof"]["law"] = "traction";
  const Results results = test::results_of({row, scenario_row("III", "vps@s=1", {{"sigma_T", 0.3}})});
  const auto lines = paper_scenario_lines(row_groups(results));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].law, "traction");
  EXPECT_EQ(measure_of(lines[0], "sigma_T").value, 0.04);
  EXPECT_EQ(measure_of(lines[0], "nu_T").value, 0.9);
  EXPECT_EQ(lines[1].law, "") << "as in older results";
}

}  // namespace
}  // namespace sixdof::results
