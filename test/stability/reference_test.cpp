#include <sixdof/stability/reference.h>

#include <cmath>

#include <gtest/gtest.h>

#include <sixdof/stability/bodies.h>

namespace sixdof::stability {
namespace {

constexpr double k_six_digits = 1e-21;  // of a value in six digits
constexpr double k_ulp = 2.3e-16;       // of coordinates of order 1

TEST(Reference, DistancesOfBoxesInClosedForm) {
  const MeshPointer a = box({2.0, 2.0, 2.0}), b = box({1.0, 1.0, 1.0});
  const auto distance = [&](const Eigen::Vector3d& t) {
    return static_cast<double>(reference_distance(*a, *b, {Eigen::Matrix3d::Identity(), t}));
  };
  EXPECT_DOUBLE_EQ(distance({2.25, 0.3, 0.1}), 0.75);                  // faces
  EXPECT_DOUBLE_EQ(distance({1.5 + 0.3, 1.5 + 0.4, 0.1}), 0.5);        // edges
  EXPECT_DOUBLE_EQ(distance({1.5 + 0.2, 1.5 + 0.3, 1.5 + 0.6}), 0.7);  // corners
  EXPECT_EQ(distance({0.9, 0.3, 0.2}), 0.0);                           // crossing
  EXPECT_DOUBLE_EQ(distance({0.1, 0.0, 0.0}), 0.4);                    // inside: of the surfaces
  EXPECT_NEAR(distance({1.5 + 1e-15, 0.3, 0.1}), 1e-15, k_ulp);        // the rounding of 1.5 + 1e-15
}

TEST(Reference, CrossedEdges) {
  const MeshPointer a = triangles({{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}});
  const MeshPointer b = triangles({{0.0, -1.0, 0.25}, {0.0, 1.0, 0.25}, {0.0, 0.0, 1.0}});
  EXPECT_EQ(static_cast<double>(reference_distance(*a, *b, {})), 0.25);
  EXPECT_EQ(static_cast<double>(reference_distance(*b, *a, {})), 0.25);
}

TEST(Reference, AgreesWithTheThreadOfAThinTriangle) {
  // danfis/libccd#55: the squared distance of the origin, computed again with rational arithmetic.
  const MeshPointer thin = triangles({{0.06999979436939574029, -1.708219171670e-8, 1.02781464659664711903},
                                      {0.06999979436939574029, -1.708219171670e-8, -0.81718535340335285433},
                                      {-0.40000020563060423306, -2.075754440556e-8, 1.02781464312938330963}});
  const MeshPointer point = tetrahedron({Eigen::Vector3d::Zero(), Eigen::Vector3d(0.1, 1.0, 0.0),
                                         Eigen::Vector3d(0.0, 1.0, 0.1), Eigen::Vector3d(-0.1, 1.0, -0.1)});
  const long double d = reference_distance(*thin, *point, {});
  EXPECT_NEAR(static_cast<double>(d * d), 3.10802e-16, k_six_digits);
}

}  // namespace
}  // namespace sixdof::stability
