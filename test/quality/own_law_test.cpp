// Each algorithm tends to its own law (own_law()), and not to the laws of magnitude that the paper judges by: with
// increasing resolution the error by the own law falls, and the force tends to that of the law, without a factor.

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/scenario/evaluation.h>
#include "bench/common/all_algorithms.h"

namespace sixdof {
namespace {

/// Of the torque in III, where laws differ most.
struct Error {
  double own_sigma, own_gain, declared_sigma;
};

Error error_in_three(const std::string& name, const std::vector<std::string>& parameters) {
  static Registry registry = [] {
    Registry all;
    register_all_algorithms(all);
    return all;
  }();
  const Algorithm& algorithm = registry.find(name);
  Settings settings = algorithm.settings();
  settings.set_all(parameters);
  const auto scenario = make_scenario("III");
  const auto query = algorithm.prepare(scenario->a(), scenario->b(), settings);
  const Recording recording = record(*scenario, *query, 100);
  const auto measures = [&](IdealLaw law) {
    std::map<std::string, double> values;
    for (const auto& [measure, value] : evaluate(*scenario, recording, law)) values[measure] = value;
    return values;
  };
  const Traits& traits = algorithm.traits();
  const auto own = measures(own_law(traits));
  const auto declared = measures(is_of_depth(traits.law) ? IdealLaw::depth : IdealLaw::volume);
  return {own.at("sigma_T"), own.at("gain_T"), declared.at("sigma_T")};
}

TEST(OwnLaw, OfPointsInVoxelsIsTheTraction) {
  const Error coarse = error_in_three("vps", {"voxel_size=0.008", "point_spacing=0.008"});
  const Error middle = error_in_three("vps", {"voxel_size=0.004", "point_spacing=0.004"});
  const Error fine = error_in_three("vps", {"voxel_size=0.002", "point_spacing=0.002"});
  EXPECT_LT(middle.own_sigma, 0.8 * coarse.own_sigma);
  EXPECT_LT(fine.own_sigma, 0.8 * middle.own_sigma);
  EXPECT_NEAR(fine.own_gain, 1.0, 0.05);
  EXPECT_GT(fine.declared_sigma, 5.0 * fine.own_sigma);
}

TEST(OwnLaw, OfPointsInAFieldIsTheTractionAlongTheWall) {
  const Error coarse = error_in_three("vps-field", {"voxel_size=0.008", "point_spacing=0.008"});
  const Error fine = error_in_three("vps-field", {"voxel_size=0.004", "point_spacing=0.004"});
  EXPECT_LT(fine.own_sigma, 0.8 * coarse.own_sigma);
  EXPECT_NEAR(fine.own_gain, 1.0, 0.02);
  EXPECT_GT(fine.declared_sigma, 50.0 * fine.own_sigma);
}

TEST(OwnLaw, OfInnerSpheresIsTheSumOfNormals) {
  std::vector<Error> errors;
  for (const char* spheres : {"spheres=1000", "spheres=5000", "spheres=25000"}) {
    errors.push_back(error_in_three("ist", {spheres}));
  }
  for (std::size_t i = 1; i < errors.size(); ++i) {
    EXPECT_LT(errors[i].own_sigma, errors[i - 1].own_sigma) << i;
    EXPECT_GT(errors[i].own_gain, errors[i - 1].own_gain) << i;
  }
  // An error that grows with the resolution is not that of the limit.
  EXPECT_GT(errors.back().declared_sigma, errors.front().declared_sigma);
}

TEST(OwnLaw, OfSteepestDescentIsThatOfTheVolume) {
  const Error coarse = error_in_three("ist-descent", {"spheres=1000"});
  const Error fine = error_in_three("ist-descent", {"spheres=25000"});
  EXPECT_LT(fine.own_sigma, 0.5 * coarse.own_sigma);
  EXPECT_NEAR(fine.own_gain, 1.0, 0.1);
}

}  // namespace
}  // namespace sixdof
