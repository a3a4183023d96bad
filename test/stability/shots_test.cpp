#include <sixdof/stability/shots.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <sixdof/oracle/overlap.h>
#include <sixdof/stability/bodies.h>
#include <sixdof/stability/families.h>
#include <sixdof/stability/makers.h>
#include <sixdof/stability/reference.h>

namespace sixdof::stability {
namespace {

double reference(const Shot& shot) {
  return static_cast<double>(reference_distance(*shot.a, *shot.b, shot.X_AB.pose()));
}

TEST(Shots, AlignedBoxesAgreeWithColumnsAndBruteForce) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.2, 1.2);
  int overlapping = 0;
  for (int i = 0; i < 60; ++i) {
    const Shot shot =
        aligned_boxes({1.1, 0.9, 0.7}, {0.5, 0.6, 0.4}, {uniform(random), uniform(random), uniform(random)});
    if (!std::isnan(shot.truth.distance)) {
      EXPECT_NEAR(shot.truth.distance, reference(shot), 1e-15);
    }
    EXPECT_NEAR(shot.truth.volume, overlap_volume_by_columns(*shot.a, *shot.b, shot.X_AB.pose()), 1e-13);
    if (shot.truth.gap >= 0.0 || shot.truth.contained) continue;
    ++overlapping;
    // Moved out by the depth along the direction, and a little more or less.
    if (!shot.truth.push) continue;
    Shot outside = shot, inside = shot;
    outside.X_AB.t += (-shot.truth.gap + 1e-9) * *shot.truth.push;
    inside.X_AB.t += (-shot.truth.gap - 1e-9) * *shot.truth.push;
    EXPECT_NEAR(reference(outside), 1e-9, 1e-14);
    EXPECT_EQ(reference(inside), 0.0);
  }
  EXPECT_GT(overlapping, 5);
}

/// Greatest depth in a box around the origin among points of a grid on the other box's surface.
double sampled_depth(const Eigen::Vector3d& size_a, const Eigen::Vector3d& size_b, const Eigen::Vector3d& offset,
                     int steps) {
  double greatest = 0.0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; j <= steps; ++j) {
        for (const double side : {-0.5, 0.5}) {
          Eigen::Vector3d part;
          part[axis] = side;
          part[(axis + 1) % 3] = static_cast<double>(i) / steps - 0.5;
          part[(axis + 2) % 3] = static_cast<double>(j) / steps - 0.5;
          const Eigen::Vector3d p = offset + part.cwiseProduct(size_b);
          greatest = std::max(greatest, (0.5 * size_a - p.cwiseAbs()).minCoeff());
        }
      }
    }
  }
  return greatest;
}

TEST(Shots, DepthsOfSurfacesAgreeWithPointsOnThem) {
  const Eigen::Vector3d size_a(1.1, 0.9, 0.7), size_b(0.5, 0.6, 0.4);
  constexpr int k_steps = 60;
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> uniform(-0.8, 0.8);
  int sunk = 0;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d offset(uniform(random), uniform(random), uniform(random));
    const GroundTruth truth = aligned_boxes(size_a, size_b, offset).truth;
    const double of_b = sampled_depth(size_a, size_b, offset, k_steps);
    const double of_a = sampled_depth(size_b, size_a, -offset, k_steps);
    EXPECT_GE(truth.depth_of_b, of_b - 1e-15);
    EXPECT_LE(truth.depth_of_b, of_b + size_b.maxCoeff() / k_steps);
    EXPECT_GE(truth.depth_of_a, of_a - 1e-15);
    EXPECT_LE(truth.depth_of_a, of_a + size_a.maxCoeff() / k_steps);
    sunk += of_b > 0.0 && of_a > 0.0 ? 1 : 0;
  }
  EXPECT_GT(sunk, 5);
  const Shot shot = aligned_boxes(size_a, size_b, {0.1, 0.2, 0.45});
  EXPECT_EQ(swapped(shot).truth.depth_of_a, shot.truth.depth_of_b);
  EXPECT_EQ(swapped(shot).truth.depth_of_b, shot.truth.depth_of_a);
  EXPECT_EQ(scaled(shot, 4.0).truth.depth_of_b, 4.0 * shot.truth.depth_of_b);
}

TEST(Shots, AboveAFaceAgreesWithBruteForce) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 40; ++i) {
    Genes genes;
    for (double& gene : genes) gene = static_cast<double>(random() >> 11) * 0x1p-53;
    Draw draw(genes);
    const Shot shot = above_face(box({2.0, 1.6, 1.2}), 0.6, box({0.5, 0.4, 0.3}), draw.rotation(), 0.2, -0.1,
                                 draw.logarithmic(1e-12, 0.1));
    EXPECT_GT(shot.truth.distance, 0.0);
    EXPECT_NEAR(shot.truth.distance, reference(shot), 1e-18 + 1e-12 * shot.truth.distance);
  }
}

TEST(Shots, MotionExchangeAndScaleKeepTheTruth) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 20; ++i) {
    Genes genes;
    for (double& gene : genes) gene = static_cast<double>(random() >> 11) * 0x1p-53;
    Draw draw(genes);
    const Shot first = make::base(draw);
    const Shot turned = moved(first, make::frame(draw, 10.0), make::frame(draw, 10.0));
    const double factor = 1e-3;
    for (const Shot& shot : {turned, swapped(turned), scaled(turned, factor), swapped(scaled(first, factor))}) {
      EXPECT_NEAR(reference(shot) / shot.scale, reference(first), (shot.rounding() + shot.truth.error) / shot.scale);
      EXPECT_NEAR(shot.truth.gap / shot.scale, first.truth.gap, 1e-15);
      if (first.truth.push) {
        EXPECT_NEAR(shot.truth.push->norm(), 1.0, 1e-14);
      }
    }
    // The bound is not idle: it is no more than a few hundred roundings of the coordinates.
    EXPECT_LT(turned.rounding(), 1e-12);
  }
}

TEST(Shots, ADirectionIsThatOfTheMovedFrame) {
  const Shot first = aligned_boxes({2.0, 1.6, 1.2}, {0.5, 0.4, 0.3}, {0.1, 0.05, 0.7});
  ASSERT_TRUE(first.truth.push);
  Genes genes;
  genes.fill(0.37);
  Draw draw(genes);
  const Shot turned = moved(first, make::frame(draw), make::frame(draw));
  for (const Shot& shot : {first, turned, swapped(turned)}) {
    Shot out = shot;
    out.X_AB.t += (-first.truth.gap + 1e-6) * *shot.truth.push;
    EXPECT_NEAR(reference(out), 1e-6, 1e-12);
  }
}

}  // namespace
}  // namespace sixdof::stability
