#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/query/registry.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/null.h>
#include <sixdof/base/error.h>

namespace sixdof {
namespace {

TEST(Registry, FindsByNameAndNamesTheRest) {
  Registry registry;
  register_core_algorithms(registry);
  EXPECT_EQ(registry.find("null").traits().name, "null");
  try {
    registry.find("nul");
    FAIL();
  } catch (const BadArgument& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("there are null"));
  }
}

TEST(Registry, RefusesTheSameNameTwice) {
  Registry registry;
  registry.add(make_null_algorithm());
  EXPECT_THROW(registry.add(make_null_algorithm()), BadArgument);
}

TEST(Response, MovesItsTorqueWithTheReferencePoint) {
  // A force f at p has torque (p - c) x f about c.
  const Eigen::Vector3d p(0.3, -0.8, 1.1), f(2.0, 0.5, -0.7), c(1.0, 0.4, 0.2), d(-0.6, 2.0, 0.9);
  Response response;
  response.force = f;
  response.torque = (p - c).cross(f);
  response.reference = c;
  EXPECT_TRUE(response.about(d).torque.isApprox((p - d).cross(f), 1e-15));
}

}  // namespace
}  // namespace sixdof
