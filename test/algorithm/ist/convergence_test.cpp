// Convergence of volume and force with the number of spheres, on detailed bodies, to the exact overlap.

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <sixdof/algorithm/ist/normal_cone.h>
#include <sixdof/algorithm/ist/packing.h>
#include <sixdof/algorithm/ist/traversal.h>
#include <sixdof/models/model_catalogue.h>

#include "../exact_responses.h"

namespace sixdof::ist {
namespace {

constexpr double k_gain_margin = 0.2;  // of gaps between the most spheres

/// One body at growing numbers of spheres.
struct Packed {
  SphereTree tree;
  double fill;
};

Packed pack(const Mesh& mesh, std::size_t spheres) {
  Packing packing = pack_spheres(mesh, {.spheres = spheres});
  Packed result{build_sphere_tree(std::move(packing.spheres)), packing.fill};
  for (const NormalCone& cone : normal_cones(mesh, result.tree.leaves)) result.tree.axes.push_back(cone.axis);
  return result;
}

struct Measured {
  double volume_error = 0.0;  ///< Mean relative error of the corrected volume.
  test::ResponseErrors gradient, volume_law, cones;
};

Measured measure(const Packed& a, const Packed& b, const test::ExactResponses& truth) {
  TraversalScratch scratch;
  std::vector<Response> by_gradient, by_volume, by_cones;
  double error = 0.0;
  const double correction = 1.0 / (a.fill * b.fill);
  for (std::size_t i = 0; i < truth.poses.size(); ++i) {
    const Eigen::Vector3d& reference = truth.responses[i].reference;
    for (const PairForce law : {PairForce::gradient, PairForce::volume, PairForce::cones}) {
      const PenetrationSum sum = penetration(a.tree, b.tree, truth.poses[i], law, reference, scratch);
      auto& responses = law == PairForce::gradient ? by_gradient : law == PairForce::volume ? by_volume : by_cones;
      responses.push_back({.force = correction * sum.force, .torque = correction * sum.moment, .reference = reference});
      if (law == PairForce::gradient) {
        // The spheres are inside the bodies, so their overlap is smaller.
        EXPECT_LT(sum.volume, truth.responses[i].volume);
        error += std::abs(correction * sum.volume / truth.responses[i].volume - 1.0);
      }
    }
  }
  return {error / static_cast<double>(truth.poses.size()),
          {truth.responses, by_gradient},
          {truth.responses, by_volume},
          {truth.responses, by_cones}};
}

class IstConvergence : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(IstConvergence, VolumeAndItsGradientConvergeToTheExactOnes) {
  const Mesh a = load_model(GetParam().first), b = load_model(GetParam().second);
  constexpr std::size_t k_poses = 24;
  const test::ExactResponses truth(a, b, k_poses, 0.3 * a.diagonal(), 0.01 * b.volume());
  constexpr std::size_t k_counts[] = {125, 500, 2000};
  std::vector<Measured> found;
  for (const std::size_t count : k_counts) found.push_back(measure(pack(a, count), pack(b, count), truth));
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_LT(found[i].volume_error, found[i - 1].volume_error);
    EXPECT_LT(found[i].gradient.force_degrees, found[i - 1].gradient.force_degrees);
    EXPECT_LT(found[i].gradient.residual, found[i - 1].gradient.residual);
    EXPECT_LT(std::abs(found[i].gradient.gain - 1.0), std::abs(found[i - 1].gradient.gain - 1.0));
  }
  // The gap at the surface is about as thick as the smallest spheres: errors decrease about as N^(-1/3).
  const double order = std::log(found.front().volume_error / found.back().volume_error) / std::log(2000.0 / 125.0);
  RecordProperty("order", std::to_string(order));
  EXPECT_GT(order, 0.2);
  EXPECT_LT(order, 0.7);
  EXPECT_LT(found.back().volume_error, 0.1);
  EXPECT_NEAR(found.back().gradient.gain, 1.0, k_gain_margin);
  EXPECT_LT(found.back().gradient.force_degrees, 0.6 * found.front().gradient.force_degrees);
  EXPECT_LT(found.back().gradient.torque_degrees, 0.6 * found.front().gradient.torque_degrees);
  RecordProperty("cones_degrees", std::to_string(found.back().cones.force_degrees));
  // V as each pair's magnitude: neither direction converges to the exact one.
  EXPECT_GT(found.back().volume_law.force_degrees, 2.0 * found.back().gradient.force_degrees);
  EXPECT_GT(found.back().cones.force_degrees, 2.0 * found.back().gradient.force_degrees);
}

INSTANTIATE_TEST_SUITE_P(Pairs, IstConvergence,
                         ::testing::Values(std::pair{"torus-knot-2k", "bumpy-sphere-2k"},
                                           std::pair{"gyroid-ball-2k", "torus-knot-2k"},
                                           std::pair{"bumpy-sphere-2k", "box-100"}));

}  // namespace
}  // namespace sixdof::ist
