#include <sixdof/results/paper_table.h>

#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/results/paper.h>

namespace sixdof::results {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

EqualTimeAnswer answer(const std::string& scenario, const std::string& algorithm, double tau_ns,
                       const std::map<std::string, double>& values) {
  return {.scenario = scenario,
          .algorithm = algorithm,
          .tau_ns = tau_ns,
          .resolution = "spheres=7",
          .remark = "all faster",
          .found = {.values = values, .mean_ns = 0.5 * tau_ns}};
}

TEST(PaperValues, AreThoseThatThePaperPrints) {
  EXPECT_EQ(paper_value("Ia", "vps", "sigma_F"), 0.043);
  EXPECT_EQ(paper_value("Ia", "ist", "sigma_F"), 0.176);
  EXPECT_EQ(paper_value("II", "vps", "gamma_F_deg"), 2.4);
  EXPECT_EQ(paper_value("II", "ist", "gamma_F_deg"), 7.64);
  EXPECT_EQ(paper_value("III", "vps", "sigma_T"), 0.169);
  EXPECT_EQ(paper_value("III", "ist", "sigma_T"), 0.112);
  EXPECT_EQ(paper_value("III", "vps", "nu_T"), 0.62);
  EXPECT_EQ(paper_value("III", "ist", "nu_T"), 1.12);
  EXPECT_EQ(paper_value("", "vps", k_eta_difference), 0.012);
  EXPECT_EQ(paper_value("", "ist", k_eta_difference), 0.021);
  EXPECT_FALSE(paper_value("IV", "ist", "sigma_F"));
  EXPECT_EQ(k_paper_mean_ns, 0.9e6);
}

TEST(WorseThanPrinted, IsLargerForErrorsAndFartherFromOneForRatios) {
  EXPECT_TRUE(worse_than_printed("gamma_F_deg", 2.5, 2.4));
  EXPECT_FALSE(worse_than_printed("gamma_F_deg", 2.4, 2.4));
  EXPECT_FALSE(worse_than_printed("sigma_F", 0.01, 0.043));
  EXPECT_TRUE(worse_than_printed("nu_T", 0.5, 0.62));
  EXPECT_TRUE(worse_than_printed("nu_T", 1.5, 0.62));
  EXPECT_FALSE(worse_than_printed("nu_T", 1.2, 0.62));
  EXPECT_THROW(worse_than_printed("beauty", 1.0, 2.0), BadArgument);
}

TEST(PaperLines, HaveEveryReadingOfAPrintedValue) {
  EqualTimeAnswer both = answer("Ia", "vps", 9e5,
                                {{"sigma_F", 0.05},
                                 {"sigma_F_all", 0.04},
                                 {"sigma_paper_F_all_by_paper", 0.001},
                                 {"sigma_F_all_by_paper", 7.0},
                                 {"gamma_F_deg", 7.0}});
  both.at_defaults = ScenarioMeasures{.values = {{"sigma_F", 0.02}}, .mean_ns = 3e5};
  const std::vector<PaperLine> lines = paper_lines(std::vector{both});
  ASSERT_EQ(lines.size(), 1u) << "the paper prints no gamma of Ia";
  const PaperLine& line = lines[0];
  EXPECT_EQ(line.measure, "sigma_F");
  EXPECT_EQ(line.printed, 0.043);
  EXPECT_EQ(line.mean_ns, 4.5e5);
  EXPECT_EQ(line.resolution, "spheres=7");
  EXPECT_EQ(line.remark, "all faster");
  ASSERT_TRUE(line.as_printed && line.whole_path && line.window && line.window_at_defaults);
  EXPECT_EQ(line.as_printed->value, 0.001);
  EXPECT_FALSE(line.as_printed->worse);
  EXPECT_EQ(line.whole_path->value, 0.04);
  EXPECT_FALSE(line.whole_path->worse);
  EXPECT_EQ(line.window->value, 0.05);
  EXPECT_TRUE(line.window->worse);
  EXPECT_EQ(line.window_at_defaults->value, 0.02);
  EXPECT_EQ(line.mean_ns_at_defaults, 3e5);
}

TEST(PaperLines, TakeTheWindowForThePathWhereItIsAllOfIt) {
  const std::vector<PaperLine> lines =
      paper_lines(std::vector{answer("II", "ist", 9e5, {{"gamma_F_deg", 8.0}, {"gamma_F_deg_all_by_paper", 7.0}})});
  ASSERT_EQ(lines.size(), 1u);
  ASSERT_TRUE(lines[0].whole_path && lines[0].as_printed);
  EXPECT_EQ(lines[0].whole_path->value, 8.0);
  EXPECT_TRUE(lines[0].whole_path->worse);
  EXPECT_FALSE(lines[0].as_printed->worse);
  EXPECT_FALSE(lines[0].window_at_defaults || lines[0].mean_ns_at_defaults);
}

TEST(PaperLines, AreByTimeThenInTheOrderOfThePaper) {
  const std::map<std::string, double> torques{{"sigma_T", 0.1}, {"nu_T", 1.0}};
  const std::vector<PaperLine> lines =
      paper_lines(std::vector{answer("III", "ist", 9e5, torques), answer("III", "ist", 3e5, torques),
                              answer("III", "vps", 9e5, torques), answer("IV", "vps", 9e5, torques)});
  std::vector<std::string> names;
  for (const PaperLine& line : lines) {
    names.push_back(line.measure + " " + line.algorithm + (line.tau_ns > 5e5 ? "" : " fast"));
  }
  EXPECT_THAT(names,
              ElementsAre("sigma_T vps", "sigma_T ist", "nu_T vps", "nu_T ist", "sigma_T ist fast", "nu_T ist fast"));
  EXPECT_THAT(paper_lines({}), IsEmpty());
}

}  // namespace
}  // namespace sixdof::results
