#include <sixdof/algorithm/exact.h>

#include <limits>

#include <gtest/gtest.h>

#include <sixdof/algorithm/fcl/fcl.h>

#include "../../geometry/shapes.h"

namespace sixdof {
namespace {

/// Two independent computations in double of the same triangles, a few roundings of the meshes' size apart.
constexpr double k_agreement = 1e-14;

TEST(ExactAlgorithm, AgreesWithFclOnLargerMeshes) {
  const Mesh a = shapes::bumpy_sphere(5, 0.25, 1.0, {0.3, -0.1, 0.2});  // 20,480 triangles
  const Mesh b = shapes::bumpy_sphere(4, 0.3, 0.6, {-0.5, 0.2, 0.1});
  const auto exact = make_exact_algorithm();
  const auto fcl = make_fcl_obbrss_algorithm();
  shapes::Generator generator(1);
  for (const bool swapped : {false, true}) {
    const Mesh& x = swapped ? b : a;
    const Mesh& y = swapped ? a : b;
    const auto ours = exact->prepare(x, y, exact->settings());
    const auto theirs = fcl->prepare(x, y, fcl->settings());
    int meeting = 0;
    for (int i = 0; i < 60; ++i) {
      Pose pose = shapes::random_pose(generator, 0.0);
      pose.t = x.center() - pose.R * y.center() + shapes::uniform(generator, 1.2, 2.6) * shapes::unit_vector(generator);
      const Outcome<Separation> d = ours->distance(pose);
      const Outcome<Separation> reference = theirs->distance(pose);
      ASSERT_TRUE(d.ok());
      ASSERT_TRUE(reference.ok());
      EXPECT_NEAR(d.value.distance, reference.value.distance, k_agreement * (a.diagonal() + b.diagonal()));
      // At these distances neither body can be inside the other.
      const Outcome<bool> yes = ours->collide(pose);
      EXPECT_EQ(yes.value, theirs->collide(pose).value);
      EXPECT_EQ(yes.value, d.value.distance == 0.0);
      meeting += yes.value ? 1 : 0;
    }
    EXPECT_GT(meeting, 5);
    EXPECT_LT(meeting, 55);
  }
}

TEST(ExactAlgorithm, RefusesWhatIsNoRigidMotion) {
  const Mesh mesh = shapes::box({0.3, 0.4, 0.5});
  const auto exact = make_exact_algorithm();
  const auto query = exact->prepare(mesh, mesh, exact->settings());
  Pose pose;
  pose.t.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(query->distance(pose).status, Status::failed);
  EXPECT_EQ(query->collide(pose).status, Status::failed);
  EXPECT_FALSE(query->diagnosis().empty());
  pose = Pose();
  pose.R *= 1.001;
  EXPECT_EQ(query->distance(pose).status, Status::failed);
  pose.R = -Eigen::Matrix3d::Identity();
  EXPECT_EQ(query->distance(pose).status, Status::failed);
}

TEST(ExactAlgorithm, WarmStartChangesNoDistance) {
  const Mesh mesh = shapes::bumpy_sphere(4, 0.25);
  const auto exact = make_exact_algorithm();
  Settings warm = exact->settings();
  warm.set("warm_start", "on");
  const auto cold_query = exact->prepare(mesh, mesh, exact->settings());
  const auto warm_query = exact->prepare(mesh, mesh, warm);
  shapes::Generator generator(2);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = shapes::random_pose(generator, 2.0);
    EXPECT_EQ(warm_query->distance(pose).value.distance, cold_query->distance(pose).value.distance);
    EXPECT_EQ(warm_query->collide(pose).value, cold_query->collide(pose).value);
  }
}

}  // namespace
}  // namespace sixdof
