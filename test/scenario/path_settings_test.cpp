#include <sixdof/scenario/path_settings.h>

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>
#include <sixdof/query/registry.h>
#include <sixdof/query/variant.h>
#include <sixdof/scenario/scenario.h>

namespace sixdof {
namespace {

class PathSettings : public ::testing::Test {
 protected:
  PathSettings() { register_core_algorithms(registry_); }

  std::string of(const std::string& scenario, const std::string& algorithm,
                 const std::vector<std::string>& assignments = {}) const {
    return settings_along(scenario, registry_.find(algorithm), assignments).to_string();
  }

  std::string with(const std::string& algorithm, const std::vector<std::string>& assignments) const {
    Settings settings = registry_.find(algorithm).settings();
    settings.set_all(assignments);
    return settings.to_string();
  }

  Registry registry_;
};

TEST_F(PathSettings, AreAFinerResolutionWhereThePaperPrintsAValue) {
  for (const char* const scenario : {"Ia", "II", "III"}) {
    const Settings settings = settings_along(scenario, registry_.find("ist"), {});
    EXPECT_GT(settings.number("spheres"), registry_.find("ist").settings().number("spheres")) << scenario;
    EXPECT_GT(settings.number("spheres_b"), 0.0) << scenario;
  }
}

TEST_F(PathSettings, AreDefaultsOtherwise) {
  for (const char* const scenario : {"Ib", "IV"}) EXPECT_EQ(of(scenario, "ist"), with("ist", {})) << scenario;
  for (const std::string& scenario : scenario_names()) {
    for (const auto& algorithm : registry_.all()) {
      const std::string& name = algorithm->traits().name;
      if (name == "ist") continue;
      EXPECT_EQ(of(scenario, name), with(name, {})) << scenario << " " << name;
    }
  }
}

/// Also one that is set to its default, and one of two: the other must not be far from what the user expects.
TEST_F(PathSettings, GiveWayToWhatTheUserSets) {
  for (const char* const assignment : {"spheres=10000", "spheres=77", "spheres_b=500"}) {
    EXPECT_EQ(of("II", "ist", {assignment}), with("ist", {assignment}));
  }
  const std::string fine = of("II", "ist", {});
  EXPECT_NE(fine, with("ist", {}));
  const std::string seeded = of("II", "ist", {"seed=7"});
  EXPECT_NE(seeded, fine);
  EXPECT_NE(seeded, with("ist", {"seed=7"})) << "another parameter leaves the resolution";
  EXPECT_THROW(of("II", "ist", {"seed=-1"}), BadArgument);
  EXPECT_THROW(of("II", "ist", {"spheres"}), BadArgument);
}

TEST_F(PathSettings, OfAVariantAreThoseOfItsAlgorithmUnlessItsNameSetsThem) {
  std::vector<std::unique_ptr<Algorithm>> all = registry_.take();
  for (auto& algorithm : all) {
    if (algorithm->traits().name != "ist") continue;
    const std::shared_ptr<const Algorithm> ist = std::move(algorithm);
    const std::string fine = settings_along("II", *ist, {}).to_string();
    const VariantAlgorithm same(ist), seeded(ist, {"seed=7"}), as_default(ist, {"spheres=10000"});
    EXPECT_EQ(settings_along("II", same, {}).to_string(), fine);
    EXPECT_EQ(settings_along("II", seeded, {}).to_string(), settings_along("II", *ist, {"seed=7"}).to_string());
    EXPECT_EQ(settings_along("II", as_default, {}).to_string(), ist->settings().to_string());
    EXPECT_EQ(settings_along("II", as_default, {"seed=7"}).to_string(), seeded.settings().to_string());
    return;
  }
  FAIL() << "no ist";
}

}  // namespace
}  // namespace sixdof
