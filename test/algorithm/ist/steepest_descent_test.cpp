#include <sixdof/algorithm/ist/traversal.h>

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <sixdof/geometry/pose.h>

namespace sixdof::ist {
namespace {

constexpr double k_rounding = 1e-14;

/// A part of an overlap with its own force.
struct Piece {
  Eigen::Vector3d position;
  double volume;
  Eigen::Vector3d force;
};

PenetrationSum sum_of(const std::vector<Piece>& pieces, const Eigen::Vector3d& about) {
  PenetrationSum sum;
  for (const Piece& p : pieces) {
    sum.volume += p.volume;
    sum.force += p.force;
    sum.moment += (p.position - about).cross(p.force);
    sum.first_moment += p.volume * (p.position - about);
    sum.second_moment += p.volume * (p.position - about).squaredNorm();
  }
  return sum;
}

const std::vector<Piece> k_pieces{{{1.0, 2.0, 0.5}, 0.3, {0.1, 0.9, -0.2}},
                                  {{-0.5, 1.0, 0.7}, 0.2, {-0.4, 0.3, 0.6}},
                                  {{0.2, -1.5, 1.1}, 0.7, {0.5, -0.1, 0.8}}};

TEST(SteepestDescent, OfOnePieceHasTheVolumeAsForce) {
  const Piece piece{{1.0, -2.0, 3.0}, 0.25, {0.0, 3.0, 4.0}};
  const Wrench wrench = steepest_descent(sum_of({piece}, {0.5, 0.5, 0.5}));
  EXPECT_NEAR((wrench.force - Eigen::Vector3d(0.0, 0.15, 0.2)).norm(), 0.0, k_rounding);
  EXPECT_NEAR((wrench.moment - Eigen::Vector3d(0.5, -2.5, 2.5).cross(wrench.force)).norm(), 0.0, k_rounding);
}

/// Two equal pieces at (+-2, 0, 0) with forces along +-y: no total force; the radius of gyration is 2.
TEST(SteepestDescent, OfACoupleHasTheVolumeTimesTheRadiusOfGyrationAsTorque) {
  const std::vector<Piece> couple{{{2.0, 0.0, 0.0}, 0.5, {0.0, 7.0, 0.0}}, {{-2.0, 0.0, 0.0}, 0.5, {0.0, -7.0, 0.0}}};
  for (const Eigen::Vector3d& about : {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(5.0, -3.0, 1.0)}) {
    const Wrench wrench = steepest_descent(sum_of(couple, about));
    EXPECT_NEAR(wrench.force.norm(), 0.0, k_rounding);
    EXPECT_NEAR((wrench.moment - Eigen::Vector3d(0.0, 0.0, 1.0 * 2.0)).norm(), 0.0, 10 * k_rounding);
  }
}

TEST(SteepestDescent, IsTheSameWrenchAboutAnyPointInAnyFrameAndUnitOfForce) {
  const Eigen::Vector3d about(0.3, -0.8, 2.0);
  const Wrench wrench = steepest_descent(sum_of(k_pieces, Eigen::Vector3d::Zero()));
  const Wrench elsewhere = steepest_descent(sum_of(k_pieces, about));
  EXPECT_NEAR((elsewhere.force - wrench.force).norm(), 0.0, k_rounding);
  EXPECT_NEAR((elsewhere.moment - (wrench.moment - about.cross(wrench.force))).norm(), 0.0, 10 * k_rounding);

  const Pose X = Pose::from_quaternion(0.8, 0.36, 0.0, 0.48, {0.3, 0.4, 0.2});
  std::vector<Piece> moved = k_pieces, stronger = k_pieces;
  for (Piece& p : moved) p = {X * p.position, p.volume, X.R * p.force};
  for (Piece& p : stronger) p.force *= 17.0;
  const Wrench there = steepest_descent(sum_of(moved, X.t));
  EXPECT_NEAR((there.force - X.R * wrench.force).norm(), 0.0, 10 * k_rounding);
  EXPECT_NEAR((there.moment - X.R * wrench.moment).norm(), 0.0, 10 * k_rounding);
  const Wrench strong = steepest_descent(sum_of(stronger, Eigen::Vector3d::Zero()));
  EXPECT_NEAR((strong.force - wrench.force).norm(), 0.0, k_rounding);
}

/// In metres or millimetres: volumes are 1e9 times as many cubic millimetres, forces of a gradient 1e6 times.
TEST(SteepestDescent, DoesNotDependOnTheUnitOfLength) {
  constexpr double k_unit = 1e3;
  std::vector<Piece> scaled = k_pieces;
  for (Piece& p : scaled) {
    p = {k_unit * p.position, k_unit * k_unit * k_unit * p.volume, k_unit * k_unit * p.force};
  }
  const Wrench wrench = steepest_descent(sum_of(k_pieces, Eigen::Vector3d::Zero()));
  const Wrench large = steepest_descent(sum_of(scaled, Eigen::Vector3d::Zero()));
  EXPECT_NEAR((large.force / std::pow(k_unit, 3) - wrench.force).norm(), 0.0, k_rounding);
  EXPECT_NEAR((large.moment / std::pow(k_unit, 4) - wrench.moment).norm(), 0.0, 10 * k_rounding);
}

TEST(SteepestDescent, IsZeroWithoutAnOverlapOrAGradient) {
  EXPECT_EQ(steepest_descent({}).force, Eigen::Vector3d::Zero());
  PenetrationSum flat = sum_of(k_pieces, Eigen::Vector3d::Zero());
  flat.force.setZero();
  flat.moment.setZero();
  const Wrench wrench = steepest_descent(flat);
  EXPECT_EQ(wrench.force, Eigen::Vector3d::Zero());
  EXPECT_EQ(wrench.moment, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace sixdof::ist
