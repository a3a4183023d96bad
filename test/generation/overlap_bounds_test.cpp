#include <sixdof/generation/overlap_bounds.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <sixdof/configuration/grid.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/models/recipe.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/oracle/solid.h>

#include "../configuration/shapes.h"

namespace sixdof {
namespace {

constexpr double k_near_rounding = 1e-9;  // relative: of the volume of a polyhedron from its corners

constexpr double k_rounding = 1e-12;  // relative

Eigen::Matrix3d random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

/// The overlap of two crossing plates is a bar as long as the shorter edge, with a rhombus for a section.
TEST(OverlapBound, IsTightForPlatesThatCross) {
  const Eigen::Vector3d size_a(2.0, 1.6, 0.01), size_b(1.8, 1.2, 0.02);
  for (const double degrees : {90.0, 60.0, 30.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    // About x: B's edge of 1.8 lies along A's of 2.
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix();
    const double expected = 1.8 * 0.01 * 0.02 / std::sin(angle);
    EXPECT_NEAR(overlap_upper_bound(size_a, size_b, R), expected, k_near_rounding * expected) << degrees;
    EXPECT_NEAR(overlap_upper_bound(size_b, size_a, R.transpose()), expected, k_near_rounding * expected) << degrees;
  }
}

TEST(OverlapBound, IsTheSmallerBoxWithoutARotation) {
  const Eigen::Vector3d size_a(2.0, 1.6, 1.2), size_b(1.0, 0.5, 0.25);
  EXPECT_NEAR(overlap_upper_bound(size_a, size_b, Eigen::Matrix3d::Identity()), size_b.prod(), k_rounding);
}

TEST(OverlapBound, IsNeverBelowAnOverlap) {
  const Mesh plate = make_box({.size = {2.0, 1.6, 0.05}}, 12), knot = load_model("torus-knot-600");
  std::mt19937_64 random(20);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  double closest = 0.0;
  for (const auto& [a, b] : {std::pair{&plate, &plate}, {&plate, &knot}, {&knot, &plate}}) {
    const Tree tree_a(*a), tree_b(*b);
    const Solid solid_a(*a, tree_a), solid_b(*b, tree_b);
    OverlapQuery query(solid_a, solid_b);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Matrix3d R = random_rotation(random);
      const double x = shift(random), y = shift(random), z = shift(random);
      const double volume = query.evaluate({R, {x, y, z}}).volume;
      const double bound = overlap_upper_bound(a->box().sizes(), b->box().sizes(), R);
      EXPECT_LE(volume, bound * (1.0 + k_rounding));
      closest = std::max(closest, volume / bound);
    }
  }
  EXPECT_GT(closest, 0.5);
}

TEST(VolumePeak, IsThatOfTheSteepestSlopes) {
  const OverlapMeasurement outer{.s = 5.0, .volume = 1.0}, inner{.s = 3.0, .volume = 2.0};
  // Up with slope 2 for a length x, down with slope 1 for the rest: 1 + 2 x = 2 + (2 - x).
  const VolumePeak one = volume_peak(outer, inner, std::array{SlopeRange{.low = -1.0, .high = 2.0}});
  EXPECT_DOUBLE_EQ(one.volume, 3.0);
  EXPECT_DOUBLE_EQ(one.s, 4.0);
  // It cannot fall, so it cannot exceed the volume of the inner end.
  const VolumePeak steady = volume_peak(outer, inner, std::array{SlopeRange{.low = 0.0, .high = 9.0}});
  EXPECT_DOUBLE_EQ(steady.volume, 2.0);
  // It can fall in the inner half only.
  const VolumePeak late =
      volume_peak(outer, inner, std::array{SlopeRange{.low = 0.0, .high = 1.0}, SlopeRange{.low = -4.0, .high = 1.0}});
  EXPECT_DOUBLE_EQ(late.volume, 2.8);  // 1 + x = 2 + 4 (2 - x) at x = 1.8
  EXPECT_DOUBLE_EQ(late.s, 3.2);
}

/// A ray that can be measured and bounded.
struct BoundedRay {
  const Mesh& a;
  const Mesh& b;
  Tree tree_a, tree_b;
  Solid solid_a, solid_b;
  std::vector<Eigen::Vector3d> areas_a, areas_b;
  ConfigurationRay ray;

  BoundedRay(const Mesh& first, const Mesh& second, const Eigen::Vector4d& rotation, const Eigen::Vector3d& direction)
      : a(first),
        b(second),
        tree_a(a),
        tree_b(b),
        solid_a(a, tree_a),
        solid_b(b, tree_b),
        areas_a(area_vectors(tree_a)),
        areas_b(area_vectors(tree_b)),
        ray(a, b, rotation) {
    ray.direction = direction;
  }

  OverlapMeasurement measure(double s) const {
    const Overlap overlap = OverlapQuery(solid_a, solid_b).evaluate(ray.pose(s));
    return {.s = s, .volume = overlap.volume, .slope = -overlap.area.dot(ray.direction)};
  }
};

/// Compares slopes and volumes in an interval with their bounds by leaves or by triangles. Returns the excess of the
/// peak over the largest volume.
double expect_bounded(const BoundedRay& bounded, SlopeBounds::Items items, double outer_s, double inner_s) {
  std::vector<SweptPair> swept;
  // The interval is a part of the displacement for which pairs of leaves are collected.
  const double margin = 0.3 * (outer_s - inner_s);
  const double begin = outer_s + margin, length = outer_s - inner_s + 2.0 * margin;
  CandidateScratch scratch;
  find_swept_leaves(bounded.tree_a, bounded.tree_b, bounded.ray.pose(begin), -length * bounded.ray.direction, scratch,
                    swept);
  if (items == SlopeBounds::Items::triangles) {
    const std::vector<SweptPair> leaves = swept;
    find_swept_triangles(bounded.tree_a, bounded.tree_b, bounded.ray.pose(begin), -length * bounded.ray.direction,
                         leaves, swept);
  }
  const OverlapMeasurement outer = bounded.measure(outer_s), inner = bounded.measure(inner_s);
  SlopeBounds bounds(items, bounded.tree_a, bounded.areas_a, bounded.tree_b, bounded.areas_b);
  std::array<SlopeRange, SlopeBounds::k_parts> ranges;
  for (int again = 0; again < 2; ++again) {  // The second call does not depend on the first.
    ranges = bounds.bound(swept, bounded.ray.direction, bounded.ray.R.transpose() * bounded.ray.direction,
                          (begin - outer_s) / length, (begin - inner_s) / length, outer.slope, inner.slope);
  }
  const VolumePeak peak = volume_peak(outer, inner, ranges);
  EXPECT_LE(peak.s, outer_s);
  EXPECT_GE(peak.s, inner_s);
  // Rounding of measured slopes and volumes.
  const double area_slack = 1e-12 * bounded.a.diagonal() * bounded.a.diagonal();
  const double volume_slack = area_slack * bounded.a.diagonal();
  double largest = 0.0;
  constexpr std::size_t k_points = 3 * SlopeBounds::k_parts;
  for (std::size_t i = 0; i < k_points; ++i) {
    const double fraction = (static_cast<double>(i) + 0.5) / k_points;
    const OverlapMeasurement measured = bounded.measure(outer_s - fraction * (outer_s - inner_s));
    const SlopeRange& range = ranges[i / 3];
    EXPECT_LE(measured.slope, range.high + area_slack) << fraction;
    EXPECT_GE(measured.slope, range.low - area_slack) << fraction;
    EXPECT_LE(measured.volume, peak.volume + volume_slack) << fraction;
    largest = std::max(largest, measured.volume);
  }
  return peak.volume - std::max(largest, inner.volume);
}

/// The same by both. Returns the excess by triangles, which is no larger.
double expect_bounded(const BoundedRay& bounded, double outer_s, double inner_s) {
  const double by_leaves = expect_bounded(bounded, SlopeBounds::Items::leaves, outer_s, inner_s);
  const double by_triangles = expect_bounded(bounded, SlopeBounds::Items::triangles, outer_s, inner_s);
  constexpr double k_area_rounding = 1e-6;  // of sums of areas in floats (overlap_bounds.cpp)
  EXPECT_LE(by_triangles, by_leaves + k_area_rounding * bounded.a.volume());
  return by_triangles;
}

TEST(SlopeBounds, HoldInEveryDirection) {
  const Mesh knot = load_model("torus-knot-1200");
  const Mesh lump = test::lump_mesh(9, {0.3, 0.1, -0.5});
  std::mt19937_64 random(31);
  for (const auto& [a, b] : {std::pair(&knot, &lump), std::pair(&lump, &knot), std::pair(&knot, &knot)}) {
    for (int i = 0; i < 6; ++i) {
      const BoundedRay ray(*a, *b, test::random_rotation(random), test::random_direction(random));
      const double far = 0.5 * (a->diagonal() + b->diagonal());
      for (const double outer : {0.9, 0.7, 0.5, 0.3, 0.1}) expect_bounded(ray, outer * far, (outer - 0.08) * far);
    }
  }
}

TEST(SlopeBounds, HoldForFacesThatMeetFlat) {
  const Mesh a = test::boxes_mesh({{{3.0, 0, 0}, {0.1, 0.5, 0.5}}, {{-0.5, 0, 0}, {1.7, 0.5, 0.5}}}, "wall and block");
  const Mesh b = test::boxes_mesh({{{0.2, 0.1, 0}, {0.15, 0.7, 0.6}}}, "slab");
  for (const auto& [first, second] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    const BoundedRay ray(*first, *second, {1, 0, 0, 0}, Eigen::Vector3d::UnitX());
    for (double s = 0.1; s < 2.5; s += 0.21) expect_bounded(ray, s + 0.2, s);
  }
}

TEST(SlopeBounds, AreTightWhileConvexBodiesApproach) {
  // Of two balls the slope can only rise, which the normals tell.
  const Mesh ball = load_model("sphere-5k");
  std::mt19937_64 random(3);
  const BoundedRay ray(ball, ball, test::random_rotation(random), test::random_direction(random));
  for (const double s : {1.8, 1.6, 1.4}) EXPECT_LT(expect_bounded(ray, 1.9, s), 1e-12) << s;
}

}  // namespace
}  // namespace sixdof
