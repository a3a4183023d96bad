#include <sixdof/oracle/depth_piece.h>

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;

constexpr double k_rounding = 1e-14;  // of numbers of about 1

/// A triangle in the plane z = 0.3 and a half-space x < edge, whose depths are edge - x.
struct Plane {
  double edge = 0.0;
  const Vector3d normal = Vector3d::UnitZ();
  const Vector3d corners[3] = {{0.0, 0.0, 0.3}, {2.0, 0.0, 0.3}, {0.0, 1.0, 0.3}};
  DepthNode node(const Vector3d& p) const {
    return {.p = p, .to_surface = {edge - p.x(), 0.0, 0.0}, .s = p.x() - edge};
  }
  std::array<DepthNode, 6> nodes() const {
    const auto middle = [&](int i, int j) { return node(0.5 * (corners[i] + corners[j])); };
    return {node(corners[0]), node(corners[1]), node(corners[2]), middle(0, 1), middle(1, 2), middle(2, 0)};
  }
  DepthPiece piece(DepthDirection direction) const {
    const std::array<DepthNode, 6> six = nodes();
    DepthPiece made{.longest = std::sqrt(5.0)};
    integrate_piece(made, {&six[0], &six[1], &six[2], &six[3], &six[4], &six[5]}, {direction, Vector3d::Zero()}, 1.0,
                    normal);
    return made;
  }
};

/// Width in y of the triangle at x is 1 - x / 2: integral of (e - x)(1 - x / 2) over x from 0 to min(e, 2).
double depth_integral(double e) {
  const double x = std::min(e, 2.0);
  return e * x - (1.0 + 0.5 * e) * x * x / 2.0 + 0.5 * x * x * x / 3.0;
}

TEST(DepthPiece, OfAPlaneIsExactWhereverItIsCut) {
  for (const double edge : {0.3, 0.9, 1.0, 1.7, 2.0, 3.1}) {
    const DepthPiece piece = Plane{.edge = edge}.piece(DepthDirection::normal_of_b);
    const double integral = depth_integral(edge);
    EXPECT_NEAR(piece.sums.depth, integral, k_rounding) << edge;
    EXPECT_NEAR((piece.sums.force - Vector3d(0.0, 0.0, -integral)).norm(), 0.0, k_rounding) << edge;
    const double x = std::min(edge, 2.0);
    EXPECT_NEAR(piece.sums.area, x - 0.25 * x * x, k_rounding) << edge;
    EXPECT_FALSE(piece.outside);
  }
  // With the first moment in x of the depth: integral of x (e - x)(1 - x / 2).
  const DepthPiece whole = Plane{.edge = 3.1}.piece(DepthDirection::normal_of_b);
  const double e = 3.1, first = e * 2.0 - (1.0 + 0.5 * e) * 8.0 / 3.0 + 0.5 * 4.0;
  EXPECT_NEAR(whole.sums.torque.y(), first, k_rounding) << "x e_x cross -e_z is x e_y";
  EXPECT_NEAR(whole.force_error, 0.0, k_rounding);
}

TEST(DepthPiece, PushesAlongTheWayOut) {
  for (const double edge : {0.3, 1.7}) {
    const DepthPiece piece = Plane{.edge = edge}.piece(DepthDirection::way_out);
    EXPECT_NEAR((piece.sums.force - Vector3d(depth_integral(edge), 0.0, 0.0)).norm(), 0.0, k_rounding);
  }
}

TEST(DepthPiece, SaysWhereTheSurfaceMayPassThroughIt) {
  EXPECT_TRUE(Plane{.edge = -5.0}.piece(DepthDirection::normal_of_b).outside);
  // Nodes are outside, but a spike between them could be half a side long.
  const DepthPiece near = Plane{.edge = -0.1}.piece(DepthDirection::normal_of_b);
  EXPECT_FALSE(near.outside);
  EXPECT_EQ(near.sums.depth, 0.0);
  EXPECT_GT(near.force_error, 0.0);
  EXPECT_GT(Plane{.edge = 0.9}.piece(DepthDirection::normal_of_b).force_error, 0.0);
}

TEST(DepthPiece, EstimatesTheErrorOfACurvedDepth) {
  // Depth 1 + x^2 inside: linear quarters are too large by a quarter of what the whole triangle is.
  Plane plane{.edge = 0.0};
  std::array<DepthNode, 6> six = plane.nodes();
  for (DepthNode& node : six) node.s = -4.0 - node.p.x() * node.p.x();
  DepthPiece piece{.longest = std::sqrt(5.0)};
  integrate_piece(piece, {&six[0], &six[1], &six[2], &six[3], &six[4], &six[5]},
                  {DepthDirection::normal_of_b, Vector3d::Zero()}, 1.0, plane.normal);
  // Integral of x^2 (1 - x / 2) from 0 to 2 is 2/3: exact after extrapolation.
  EXPECT_NEAR(piece.sums.depth, 4.0 + 2.0 / 3.0, k_rounding);
  EXPECT_GT(piece.force_error, 0.0);
}

}  // namespace
}  // namespace sixdof::detail
