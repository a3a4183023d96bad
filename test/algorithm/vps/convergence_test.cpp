// Convergence of voxmap-pointshell with the voxel size and the point spacing, on detailed bodies, to the integrals over
// B's surface that its laws approximate. These are computed by quadrature with exact distances.

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include <sixdof/algorithm/vps/surface_voxels.h>
#include <sixdof/algorithm/vps/vps.h>
#include <sixdof/geometry/closest_point.h>
#include <sixdof/models/model_catalogue.h>

#include "../exact_responses.h"

namespace sixdof {
namespace {

/// The wrench of the law of `vps` or `vps-field` with exact depths, by one quadrature point in each of B's triangles,
/// whose edges must be short compared with the depths.
class SurfaceIntegral {
 public:
  SurfaceIntegral(const Mesh& a, const Mesh& b, bool along_gradient)
      : a_(a), b_(b), tree_(a), winding_(tree_), along_gradient_(along_gradient) {}

  Response at(const Pose& X) const {
    Response sum;
    sum.reference = X * b_.center();
    for (const Triangle& t : b_.triangles()) {
      const Eigen::Vector3d u = X * b_.vertices()[t[0]], v = X * b_.vertices()[t[1]], w = X * b_.vertices()[t[2]];
      const Eigen::Vector3d p = (u + v + w) / 3.0, area = 0.5 * (v - u).cross(w - u);
      if (!a_.box().contains(p) || winding_.at(p) < 0.5) continue;
      const SurfacePoint nearest = *closest_point(tree_, p);
      const Eigen::Vector3d force = along_gradient_ ? Eigen::Vector3d(area.norm() * (nearest.point - p))
                                                    : Eigen::Vector3d(-nearest.distance * area);
      sum.force += force;
      sum.torque += (p - sum.reference).cross(force);
      sum.penalty = std::max(sum.penalty, nearest.distance);
    }
    return sum;
  }

 private:
  const Mesh& a_;
  const Mesh& b_;
  Tree tree_;
  vps::WindingNumber winding_;
  bool along_gradient_;
};

struct Case {
  const char* algorithm;
  const char* a;
  const char* coarse_b;  ///< The algorithm's B.
  const char* fine_b;    ///< The same body for the quadrature.
};

class VpsConvergence : public ::testing::TestWithParam<Case> {};

TEST_P(VpsConvergence, WrenchConvergesToTheIntegralOfItsLaw) {
  ::setenv("SIXDOF_CACHE", "off", 1);
  const Mesh a = load_model(GetParam().a), b = load_model(GetParam().coarse_b), fine = load_model(GetParam().fine_b);
  const bool field = std::string(GetParam().algorithm) == "vps-field";
  const test::ExactResponses overlapping(a, b, 12, 0.3 * a.diagonal(), 0.01 * b.volume());
  const SurfaceIntegral integral(a, fine, field);
  std::vector<Response> truth;
  for (const Pose& X : overlapping.poses) truth.push_back(integral.at(X));

  const auto algorithm = field ? make_vps_field_algorithm() : make_vps_algorithm();
  std::vector<test::ResponseErrors> errors;
  for (const char* size : {"0.04", "0.02", "0.01"}) {
    Settings settings = algorithm->settings();
    settings.set("voxel_size", size);
    settings.set("point_spacing", size);
    const auto query = algorithm->prepare(a, b, settings);
    std::vector<Response> measured;
    for (const Pose& X : overlapping.poses) measured.push_back(query->respond(X).value);
    errors.emplace_back(truth, measured);
  }
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
  ::unsetenv("SIXDOF_CACHE");
}

INSTANTIATE_TEST_SUITE_P(Pairs, VpsConvergence,
                         ::testing::Values(Case{"vps", "torus-knot-2k", "bumpy-sphere-2k", "bumpy-sphere-30k"},
                                           Case{"vps-field", "torus-knot-2k", "bumpy-sphere-2k", "bumpy-sphere-30k"},
                                           Case{"vps", "gyroid-ball-2k", "torus-2k", "torus-30k"},
                                           Case{"vps-field", "gyroid-ball-2k", "torus-2k", "torus-30k"}));

}  // namespace
}  // namespace sixdof
