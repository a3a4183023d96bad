// Every algorithm that answers responses, on one model of every recipe for closed bodies.

#include <cstdlib>

#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/measure/direction.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/query/registry.h>

namespace sixdof {
namespace {

class Responses : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    ::setenv("SIXDOF_CACHE", "off", 1);
    register_core_algorithms(registry_);
  }
  void TearDown() override { ::unsetenv("SIXDOF_CACHE"); }

  /// B translated from outside along -u until about `fraction` of its volume is inside A.
  Pose overlapping_pose(const Mesh& a, const Mesh& b, const Eigen::Vector3d& u, double fraction) const {
    const Algorithm& exact = registry_.find("exact");
    const auto query = exact.prepare(a, b, exact.settings());
    Pose X = Pose::from_quaternion(0.48, 0.6, -0.64, 0.0, Eigen::Vector3d::Zero());
    double outside = a.diagonal() + b.diagonal(), inside = 0.0;
    for (int i = 0; i < 20; ++i) {
      const double s = 0.5 * (outside + inside);
      X.t = a.center() + s * u - X.R * b.center();
      (query->respond(X).value.volume < fraction * b.volume() ? outside : inside) = s;
    }
    return X;
  }

  Registry registry_;
};

TEST_P(Responses, PushBOutOfA) {
  const Mesh a = load_model(GetParam()), b = load_model("bumpy-sphere-1k");
  const Pose X = overlapping_pose(a, b, Eigen::Vector3d(0.48, -0.6, 0.64), 0.05);
  const Algorithm& exact = registry_.find("exact");
  const Eigen::Vector3d out = exact.prepare(a, b, exact.settings())->respond(X).value.force;
  int answered = 0;
  for (const auto& algorithm : registry_.all()) {
    if (algorithm->traits().name == "null" || !algorithm->traits().answers.respond) continue;
    Settings settings = algorithm->settings();
    const std::string& name = algorithm->traits().name;
    if (name.starts_with("ist")) settings.set("spheres", "500");
    if (name == "exact-way-out") settings.set("tolerance", "0.03");  // a usual one takes minutes on some pairs
    if (name.starts_with("vps")) settings.set_all({"voxel_size=0.01", "point_spacing=0.01"});
    const auto query = algorithm->prepare(a, b, settings);
    const Outcome<Response> outcome = query->respond(X);
    ASSERT_TRUE(outcome.ok()) << name << ": " << query->diagnosis();
    EXPECT_GT(outcome.value.penalty, 0.0) << name;
    EXPECT_GT(outcome.value.force.norm(), 0.0) << name;
    // The laws differ in direction. That of vps-field and exact-way-out pushes each point out of A the shortest way,
    // which is sideways where B encloses a thin part of A; the others never pull B in.
    if (algorithm->traits().law != ResponseLaw::way_out) {
      EXPECT_LT(angle_degrees(outcome.value.force, out), 90.0) << name;
    }
    if (algorithm->traits().answers.collide) {
      EXPECT_TRUE(query->collide(X).value) << name;
    }
    ++answered;
  }
  EXPECT_EQ(answered, 7);
}

INSTANTIATE_TEST_SUITE_P(Recipes, Responses,
                         ::testing::Values("sphere-1k", "bumpy-sphere-1k", "box-1k", "cylinder-1k", "cone-1k",
                                           "torus-1k", "torus-knot-1k", "circular-box-1k", "gyroid-ball-2k"));

}  // namespace
}  // namespace sixdof
