#include <sixdof/oracle/signed_depth.h>

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "bodies.h"

namespace sixdof {
namespace {

using detail::DepthNode;
using detail::SignedDepth;
using Eigen::Vector3d;

/// Negative inside.
double distance_to_box(const Vector3d& p, const Vector3d& low, const Vector3d& high) {
  const Vector3d out = (low - p).cwiseMax(p - high);
  return out.cwiseMax(0.0).norm() + std::min(out.maxCoeff(), 0.0);
}

constexpr double k_rounding = 1e-14;  // of lengths of about 1

TEST(SignedDepth, OfABoxHasAClosedForm) {
  const Vector3d low(-0.7, -0.4, -0.9), high(0.8, 0.6, 0.5);
  const Mesh box = bodies::box(low, high);
  const Tree tree(box);
  SignedDepth depth(box, tree);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> x(-1.2, 1.2);
  for (int i = 0; i < 500; ++i) {
    const Vector3d p(x(random), x(random), x(random));
    const DepthNode node = depth.at(p, static_cast<std::uint32_t>(random() % box.triangles().size()));
    EXPECT_NEAR(node.s, distance_to_box(p, low, high), k_rounding);
    EXPECT_NEAR(node.to_surface.norm(), std::abs(node.s), k_rounding);
    EXPECT_EQ(node.p, p);
    EXPECT_EQ(depth.is_outside(p, 0.3), distance_to_box(p, low, high) > 0.3);
  }
}

TEST(SignedDepth, DoesNotDependOnWhereASearchStarts) {
  const Mesh mesh = bodies::bumpy_torus(40, 16);
  const Tree tree(mesh);
  SignedDepth depth(mesh, tree);
  std::mt19937_64 random(4);
  std::normal_distribution<double> x(0.0, 0.4);
  DepthNode last = depth.at(Vector3d(0.5, 0.0, 0.0), 0u);
  EXPECT_LT(last.s, 0.0) << "inside the tube";
  for (int i = 0; i < 500; ++i) {
    const Vector3d p(x(random), x(random), 0.5 * x(random));
    const DepthNode cold = depth.at(p, static_cast<std::uint32_t>(random() % mesh.triangles().size()));
    const DepthNode warm = depth.at(p, last);
    EXPECT_EQ(cold.s, warm.s);
    EXPECT_EQ(cold.to_surface, warm.to_surface);
    EXPECT_EQ(cold.triangle, warm.triangle);
    last = warm;
  }
}

}  // namespace
}  // namespace sixdof
