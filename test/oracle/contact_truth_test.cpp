#include <sixdof/oracle/contact_truth.h>

#include <numbers>

#include <gtest/gtest.h>

#include "../geometry/shapes.h"
#include "bodies.h"

namespace sixdof {
namespace {

using Eigen::Vector3d;

constexpr double k_rounding = 1e-12;  // lengths of about 1
constexpr double k_angle = 1e-5;      // degrees: half of the digits are lost near 0
constexpr double k_beside = 1e-6;     // of thicknesses: some times the distance of the lines beside

/// A cube stands on a corner that is 0.1 deep in a floor.
class CornerInFloor : public ::testing::Test {
 protected:
  static constexpr double k_depth = 0.1;
  CornerInFloor() : truth_(floor_, cube_) { truth_.move_to(X_AB_); }

  static Pose on_corner() {
    const Eigen::Quaterniond q =
        Eigen::Quaterniond::FromTwoVectors(Vector3d(1.0, 1.3, 0.9).normalized(), Vector3d::UnitZ());
    return {q.toRotationMatrix(), {0.17, -0.11, -k_depth}};
  }

  const Mesh floor_ = bodies::box({-2.0, -1.5, -1.0}, {2.0, 1.5, 0.0});
  const Mesh cube_ = bodies::box({0.0, 0.0, 0.0}, {0.5, 0.5, 0.5});
  const Pose X_AB_ = on_corner();
  ContactTruth truth_;
  const Vector3d corner_ = X_AB_.t;
};

TEST_F(CornerInFloor, ARightContact) {
  const JudgedContact judged = truth_.judge({corner_, Vector3d::UnitZ(), k_depth});
  EXPECT_NEAR(judged.off(), 0.0, k_rounding);
  EXPECT_NEAR(judged.normal_angle, 0.0, k_angle);
  EXPECT_FALSE(judged.is_reversed());
  EXPECT_NEAR(judged.thickness, k_depth, k_beside);
}

TEST_F(CornerInFloor, APointOnTheFloorOrBetweenIsRight) {
  for (const double part : {0.5, 1.0}) {
    const JudgedContact judged =
        truth_.judge({corner_ + part * k_depth * Vector3d::UnitZ(), Vector3d::UnitZ(), k_depth});
    EXPECT_NEAR(judged.off(), 0.0, k_rounding);
    EXPECT_NEAR(judged.normal_angle, 0.0, k_angle);
    EXPECT_NEAR(judged.thickness, k_depth, k_beside);
  }
}

/// The cube's corner has a wide cone of normals; that of the floor counts.
TEST_F(CornerInFloor, NormalsAreComparedWithTheFloors) {
  for (const double degrees : {10.0, 75.0}) {
    const Eigen::AngleAxisd turn(degrees * std::numbers::pi / 180.0, Vector3d::UnitX());
    EXPECT_NEAR(truth_.judge({corner_, turn * Vector3d::UnitZ(), k_depth}).normal_angle, degrees, k_angle);
  }
  EXPECT_TRUE(truth_.judge({corner_, -Vector3d::UnitZ(), k_depth}).is_reversed());
}

TEST_F(CornerInFloor, PointsOutsideAreOff) {
  const JudgedContact above = truth_.judge({corner_ + 0.3 * Vector3d::UnitZ(), Vector3d::UnitZ(), k_depth});
  EXPECT_NEAR(above.outside_a, 0.2, k_rounding) << "over the floor, in the cube";
  EXPECT_NEAR(above.outside_b, 0.0, k_rounding);
  EXPECT_EQ(above.thickness, 0.0);
  const JudgedContact below = truth_.judge({corner_ - 0.3 * Vector3d::UnitZ(), Vector3d::UnitZ(), k_depth});
  EXPECT_NEAR(below.outside_a, 0.0, k_rounding);
  EXPECT_NEAR(below.outside_b, 0.3, k_rounding) << "the corner is the nearest point of the cube";
}

TEST_F(CornerInFloor, TheForceIsThatOfTheFloor) {
  EXPECT_NEAR((truth_.force_direction() - Vector3d::UnitZ()).norm(), 0.0, 1e-9);
}

TEST_F(CornerInFloor, TheCornerIsTheInnerVertex) {
  const std::vector<InnerVertex> found = truth_.inner_vertices();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].of_b);
  EXPECT_NEAR((found[0].point - corner_).norm(), 0.0, k_rounding);
  EXPECT_NEAR(found[0].depth, k_depth, k_rounding);
  EXPECT_NEAR((found[0].normal - Vector3d::UnitZ()).norm(), 0.0, k_rounding);
}

TEST_F(CornerInFloor, TruePointsAreTheCornerAndTheCurve) {
  EXPECT_GE(truth_.curve().size(), 3u);
  const std::vector<Vector3d> points = truth_.truth_points();
  EXPECT_EQ(points.size(), 1 + 2 * truth_.curve().size());
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_NEAR(points[i].z(), 0.0, k_rounding) << "on the floor";
}

TEST_F(CornerInFloor, ThePoseCanChange) {
  Pose apart = X_AB_;
  apart.t.z() = 0.2;
  truth_.move_to(apart);
  EXPECT_TRUE(truth_.curve().empty());
  EXPECT_TRUE(truth_.inner_vertices().empty());
  EXPECT_TRUE(truth_.force_direction().isZero(0.0));
}

/// Edges that cross and touch: the normal lies in the cones of both.
TEST(ContactTruth, OfEdgesThatTouch) {
  const Mesh floor = bodies::box({-1.0, -0.8, -0.6}, {1.0, 0.8, 0.6}), bar = floor;
  // The edge of A along x at y = 0.8, z = 0.6; B is turned so that its edge along y at x = 1, z = -0.6 lies across it.
  const Eigen::Matrix3d tilt =
      (Eigen::AngleAxisd(0.8, Vector3d::UnitY()) * Eigen::AngleAxisd(-0.1, Vector3d::UnitZ())).toRotationMatrix();
  const Vector3d at(0.2, 0.8, 0.6), edge_b = tilt * Vector3d::UnitY();
  const Vector3d on_b(1.0, 0.3, -0.6);
  const Pose X_AB{tilt, at - tilt * on_b};
  ContactTruth truth(floor, bar);
  truth.move_to(X_AB);
  Vector3d normal = Vector3d::UnitX().cross(edge_b).normalized();
  if (normal.z() < 0.0) normal = -normal;
  const double across = truth.judge({at, normal, 0.0}).normal_angle;
  const double face = truth.judge({at, Vector3d::UnitY(), 0.0}).normal_angle;
  // A's normals at the edge are those between y and z; B's edge has a cone of its own, in which y is not.
  EXPECT_NEAR(across, 0.0, k_angle);
  EXPECT_GT(face, 60.0);
}

}  // namespace
}  // namespace sixdof
