// Convergence of voxmap-pointshell with the voxel size and the point spacing, on detailed bodies, to the laws that
// oracle/depth_integral.h computes: law and truth belong together.

#include <cmath>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/vps/vps.h>
#include <sixdof/base/error.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/oracle/depth_integral.h>

#include "../exact_responses.h"

namespace sixdof {
namespace {

struct Case {
  const char* algorithm;
  const char* a;
  const char* b;
};

/// Errors of an algorithm against its own law at voxel sizes and point spacings that halve.
class OwnLawErrors {
 public:
  static constexpr const char* k_sizes[] = {"0.04", "0.02", "0.01", "0.005"};

  OwnLawErrors(const Case& of, const Mesh& a, const Mesh& b, std::size_t poses, std::size_t first, std::size_t last) {
    const bool field = std::string(of.algorithm) == "vps-field";
    // Overlaps of 1 % of the smaller body at least: depths of several voxels.
    const test::ExactResponses overlapping(a, b, poses, 0.3 * a.diagonal(), 0.01 * b.volume());
    const DepthOracle oracle(a, b);
    std::vector<Response> truth;
    for (const Pose& X : overlapping.poses) {
      // Two percent turn a force by 1.1 degrees at most; less takes minutes where directions jump.
      const DepthIntegral found = field ? oracle.evaluate(X, DepthDirection::way_out, {.relative = 2e-2})
                                        : oracle.evaluate(X, DepthDirection::normal_of_b, {.relative = 5e-3});
      EXPECT_TRUE(found.converged);
      truth.push_back({.force = found.force, .torque = found.torque, .reference = found.reference});
    }
    const auto algorithm = field ? make_vps_field_algorithm() : make_vps_algorithm();
    for (std::size_t i = first; i <= last; ++i) {
      Settings settings = algorithm->settings();
      settings.set("voxel_size", k_sizes[i]);
      settings.set("point_spacing", k_sizes[i]);
      const auto query = algorithm->prepare(a, b, settings);
      std::vector<Response> measured;
      for (const Pose& X : overlapping.poses) measured.push_back(query->respond(X).value);
      errors.emplace_back(truth, measured);
    }
    const double halvings = static_cast<double>(last - first);
    rate = std::log2(errors.front().force_degrees / errors.back().force_degrees) / halvings;
    fmt::print("{} on {} x {}: angle of the force {:.2f} degrees at {}, {:.2f} at {}: order {:.2f}\n", of.algorithm,
               of.a, of.b, errors.front().force_degrees, k_sizes[first], errors.back().force_degrees, k_sizes[last],
               rate);
  }

  std::vector<test::ResponseErrors> errors;
  double rate = 0.0;  ///< Order of the force's angle in the size.
};

struct WithoutCache : ::testing::TestWithParam<Case> {
  WithoutCache() { ::setenv("SIXDOF_CACHE", "off", 1); }
  ~WithoutCache() override { ::unsetenv("SIXDOF_CACHE"); }
};

class VpsConvergence : public WithoutCache {};

TEST_P(VpsConvergence, WrenchConvergesToTheIntegralOfItsLaw) {
  const Mesh a = load_model(GetParam().a), b = load_model(GetParam().b);
  const auto errors = OwnLawErrors(GetParam(), a, b, 12, 0, 2).errors;
  for (std::size_t i = 1; i < errors.size(); ++i) {
    EXPECT_LT(errors[i].force_degrees, errors[i - 1].force_degrees);
    EXPECT_LT(errors[i].torque_degrees, errors[i - 1].torque_degrees);
  }
  const test::ResponseErrors &coarse = errors.front(), &last = errors.back();
  EXPECT_LT(last.force_degrees, 0.5 * coarse.force_degrees);
  EXPECT_LT(last.torque_degrees, 0.5 * coarse.torque_degrees);
  EXPECT_LT(last.force_degrees, 10.0);
  EXPECT_LT(last.residual, 0.1);
  // One gain for all poses. Layers on slanted faces are too small, and edges of the field are rounded off over a voxel.
  EXPECT_GT(last.gain, 0.75);
  EXPECT_LT(last.gain, 1.05);
}

INSTANTIATE_TEST_SUITE_P(Pairs, VpsConvergence,
                         ::testing::Values(Case{"vps", "torus-knot-2k", "bumpy-sphere-2k"},
                                           Case{"vps-field", "torus-knot-2k", "bumpy-sphere-2k"},
                                           Case{"vps", "gyroid-ball-2k", "torus-2k"},
                                           Case{"vps-field", "gyroid-ball-2k", "torus-2k"}));

class VpsConvergenceOfRealObjects : public WithoutCache {};

/// The object, if it is fetched.
std::optional<Mesh> fetched(const char* name) {
  try {
    return load_model(name);
  } catch (const BadFile&) {
    return std::nullopt;
  }
}

TEST_P(VpsConvergenceOfRealObjects, TheForceGetsNearerToItsOwnLaw) {
  const std::optional<Mesh> mesh = fetched(GetParam().a);
  if (!mesh) GTEST_SKIP() << GetParam().a << " is not fetched";
  const OwnLawErrors found(GetParam(), *mesh, *mesh, 4, 1, 3);
  EXPECT_GT(found.rate, 0.4) << "halving the size halves the angle, more or less";
  EXPECT_LT(found.errors.back().force_degrees, 6.0);
}

INSTANTIATE_TEST_SUITE_P(Objects, VpsConvergenceOfRealObjects,
                         ::testing::Values(Case{"vps", "elephant", "elephant"}, Case{"vps", "bunny", "bunny"},
                                           Case{"vps", "ship", "ship"},
                                           Case{"vps", "torus-knot-10k", "torus-knot-10k"}));

}  // namespace
}  // namespace sixdof
