#include <sixdof/oracle/thickness.h>

#include <gtest/gtest.h>

#include "../geometry/shapes.h"
#include "bodies.h"

namespace sixdof {
namespace {

using Eigen::Vector3d;

constexpr double k_reach = 1e-6, k_beside = 1e-8;
constexpr double k_error = 1e-7;  // some times `beside`

Mesh moved(const Mesh& mesh, const Pose& X) {
  std::vector<Vector3d> vertices;
  for (const Vector3d& p : mesh.vertices()) vertices.push_back(X * p);
  return Mesh::build(std::move(vertices), mesh.triangles(), mesh.name());
}

/// A block that stands in a floor, `k_depth` deep; the floor is in a generic frame.
class BlockInFloor : public ::testing::Test {
 protected:
  static constexpr double k_depth = 0.07;
  shapes::Generator random_{3};
  const Pose X_ = shapes::random_pose(random_, 2.0);  ///< Of the frame in which the floor is level.
  const Mesh floor_ = moved(bodies::box({-1.0, -0.8, -0.6}, {1.0, 0.8, 0.0}), X_);
  const Mesh block_ = bodies::box({-0.3, -0.2, 0.0}, {0.3, 0.2, 0.5});
  const Pose level_{Eigen::AngleAxisd(0.7, Vector3d::UnitZ()).toRotationMatrix(), {0.21, -0.13, -k_depth}};
  const Pose X_AB_ = X_ * level_;
  const Tree tree_a_{floor_}, tree_b_{block_};
  Thickness thickness_{tree_a_, tree_b_};

  /// @param p in the block's frame; @param n in the frame in which the floor is level
  double at(const Vector3d& p, const Vector3d& n) {
    return thickness_.at(X_AB_, X_AB_ * p, X_.R * n, k_reach, k_beside);
  }
};

TEST_F(BlockInFloor, AlongTheFloorsNormalIsTheDepth) {
  for (const double sign : {1.0, -1.0}) {
    const Vector3d up(0.0, 0.0, sign);
    EXPECT_NEAR(at({0.11, -0.07, 0.0}, up), k_depth, k_error) << "under the block";
    EXPECT_NEAR(at({0.11, -0.07, 0.03}, up), k_depth, k_error) << "within";
    EXPECT_NEAR(at({0.11, -0.07, k_depth}, up), k_depth, k_error) << "on the floor";
    EXPECT_NEAR(at({0.3, -0.07, 0.0}, up), k_depth, k_error) << "along a face of the block";
    EXPECT_NEAR(at({0.3, 0.2, 0.0}, up), k_depth, k_error) << "along an edge of the block, from its corner";
  }
}

TEST_F(BlockInFloor, AlongOtherDirections) {
  EXPECT_NEAR(at({0.11, -0.07, 0.02}, level_.R * Vector3d::UnitX()), 0.6, k_error) << "through the block";
  const Vector3d slanted = Vector3d(0.0, 0.6, 0.8);
  EXPECT_NEAR(at({0.0, 0.0, 0.0}, slanted), k_depth / 0.8, k_error);
}

TEST_F(BlockInFloor, IsZeroElsewhere) {
  const Vector3d up = Vector3d::UnitZ();
  EXPECT_EQ(at({0.31, 0.0, 0.0}, up), 0.0) << "beside the block";
  EXPECT_EQ(at({0.0, 0.0, 0.2}, up), 0.0) << "above the floor";
  EXPECT_EQ(at({0.0, 0.0, -0.1}, up), 0.0) << "below the block";
}

/// Two pieces of one line: that at the point counts.
TEST(Thickness, OfTheNearestPiece) {
  const Mesh post = bodies::box({-0.1, -0.1, -1.0}, {0.1, 0.1, 1.0});
  // A body of two plates.
  const Mesh low = bodies::box({-0.5, -0.5, -0.4}, {0.5, 0.5, -0.3}),
             high = bodies::box({-0.5, -0.5, 0.2}, {0.5, 0.5, 0.5});
  std::vector<Vector3d> vertices = low.vertices();
  vertices.insert(vertices.end(), high.vertices().begin(), high.vertices().end());
  std::vector<Triangle> triangles = low.triangles();
  for (const Triangle& t : high.triangles()) triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  const Mesh plates = Mesh::build(vertices, triangles, "plates");
  const Tree a(plates), b(post);
  Thickness thickness(a, b);
  const auto at = [&](double z) { return thickness.at({}, {0.02, 0.03, z}, Vector3d::UnitZ(), k_reach, k_beside); };
  EXPECT_NEAR(at(-0.33), 0.1, k_error);
  EXPECT_NEAR(at(0.4), 0.3, k_error);
  EXPECT_EQ(at(0.0), 0.0) << "between the plates";
}

}  // namespace
}  // namespace sixdof
