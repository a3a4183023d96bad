#include <sixdof/oracle/nested.h>

#include <gtest/gtest.h>

#include <sixdof/models/recipe.h>

namespace sixdof::detail {
namespace {

Pose at(double x) { return {Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).matrix(), {x, 0, 0}}; }

TEST(Nested, ABodyInsideTheOtherInBothOrders) {
  const DistanceBody large(make_sphere({.radius = 2.0}, 320)), small(make_sphere({.radius = 0.3}, 80));
  std::vector<std::uint32_t> scratch;
  EXPECT_TRUE(is_nested(large, small, at(0.8), scratch));
  EXPECT_TRUE(is_nested(small, large, at(0.8).inverse(), scratch));
  EXPECT_FALSE(is_nested(large, small, at(5.0), scratch));
  EXPECT_FALSE(is_nested(small, large, at(5.0).inverse(), scratch));
}

TEST(Nested, InTheHoleOfATorusIsOutside) {
  const DistanceBody torus(make_torus({}, 2000)), small(make_sphere({.radius = 0.05}, 80));
  std::vector<std::uint32_t> scratch;
  EXPECT_FALSE(is_nested(torus, small, at(0.0), scratch));
}

TEST(Nested, AnOpenSurfaceHoldsNothing) {
  const Mesh sphere = make_sphere({.radius = 2.0}, 320);
  std::vector<Triangle> triangles = sphere.triangles();
  triangles.pop_back();
  const DistanceBody open(Mesh::build(sphere.vertices(), triangles)), small(make_sphere({.radius = 0.3}, 80));
  std::vector<std::uint32_t> scratch;
  EXPECT_FALSE(is_nested(open, small, at(0.0), scratch));
}

}  // namespace
}  // namespace sixdof::detail
