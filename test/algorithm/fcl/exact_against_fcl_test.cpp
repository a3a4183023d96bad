#include <sixdof/algorithm/core_algorithms.h>

#include <gtest/gtest.h>

#include <sixdof/algorithm/fcl/fcl.h>

#include "../../geometry/shapes.h"

namespace sixdof {
namespace {

/// Two independent computations of the same triangles in double precision: a few roundings of the meshes' size.
constexpr double k_agreement = 1e-14;

TEST(ExactAlgorithm, AgreesWithFcl) {
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
    int collisions = 0;
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
      collisions += yes.value ? 1 : 0;
    }
    EXPECT_GT(collisions, 5);
    EXPECT_LT(collisions, 55);
  }
}

}  // namespace
}  // namespace sixdof
