// `sixdof table --paper` on a result file made here: resolutions and measures beside those that the paper prints.

#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof::cli {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::HasSubstr;
using ::testing::Not;

Json scenario_row(const std::string& scenario, const std::string& algorithm, const std::string& law,
                  const Json& values) {
  Json json = {{"name", fmt::format("scenario/{}/algorithm:{}", scenario, algorithm)},
               {"run_type", "iteration"},
               {"cpu_time", 3500.0},
               {"real_time", 4000.0},
               {"time_unit", "ns"}};
  json.update(values);
  json["sixdof"] = {{"query", "scenario"}, {"algorithm", algorithm}, {"scenario", scenario}, {"law", law}};
  return json;
}

class TablePaper : public test::ScratchFolder {
 protected:
  std::string printed(const Json& rows) const {
    std::ofstream(path("r.json")) << Json{{"context", Json::object()}, {"benchmarks", rows}};
    const auto result =
        test::run_program(fmt::format("{} table --paper --markdown {}", SIXDOF_PROGRAM, path("r.json")));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  }
};

TEST_F(TablePaper, HasScenariosBesideThePrintedValues) {
  const std::string out = printed({scenario_row("Ia", "vps", "traction",
                                                {{"voxels_x", 728},
                                                 {"voxels_y", 25},
                                                 {"voxels_z", 304},
                                                 {"points", 15667},
                                                 {"sigma_F", 0.5},
                                                 {"sigma_F_all", 0.0149}}),
                                   scenario_row("III", "ist", "normals", {{"spheres_a", 10000}, {"sigma_T", 0.17}})});
  EXPECT_THAT(out, HasSubstr("| Ia | vps | 728x25x304, 15,667 (728x24x303, 15,669) | traction | 3.50 | 0.015 (0.043)"));
  EXPECT_THAT(out, HasSubstr("| III | ist | 10,000 | normals | 3.50 |"));
  EXPECT_THAT(out, HasSubstr("(0.112)")) << "sigma_T that the paper prints";
}

TEST_F(TablePaper, LeavesOtherRowsOut) {
  Json other = scenario_row("Ia", "null", "", {{"sigma_F", 0.5}});
  EXPECT_THAT(printed({scenario_row("II", "vps", "traction", {{"sigma_F", 0.5}}), other}), Not(HasSubstr("null")));
}

}  // namespace
}  // namespace sixdof::cli
