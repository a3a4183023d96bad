#include <sixdof/algorithm/ist/traversal.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <hwy/highway.h>

#include <gtest/gtest.h>

#include "random_spheres.h"

namespace sixdof::ist {
namespace {

constexpr double k_slope_error = 1e-8;  // of a slope from a central difference

constexpr double k_rounding = 1e-12;  // sums of some 1e4 terms in another order

/// Minus the derivative of overlap_volume() by d: the area of the disc bounded by the circle in which the spheres meet;
/// 0 where their surfaces do not cross.
double overlap_disc_area(double r1, double r2, double d) {
  if (d >= r1 + r2 || d <= std::abs(r1 - r2)) return 0.0;
  const double to_plane = (d * d + r1 * r1 - r2 * r2) / (2.0 * d);  // from the first centre
  return std::numbers::pi * std::max(0.0, r1 * r1 - to_plane * to_plane);
}

TEST(OverlapDiscArea, IsMinusTheDerivativeOfTheVolume) {
  constexpr double h = 1e-5;
  for (const double d : {0.45, 0.8, 1.1, 1.5}) {
    const double slope = (overlap_volume(1.0, 0.7, d + h) - overlap_volume(1.0, 0.7, d - h)) / (2.0 * h);
    EXPECT_NEAR(overlap_disc_area(1.0, 0.7, d), -slope, k_slope_error) << d;
  }
}

/// Centre of the circle in which two spheres meet; where one is inside the other, the centre of the inner one.
Eigen::Vector3d middle_of_overlap(const Sphere& s, const Sphere& t) {
  const double d = (t.center - s.center).norm();
  if (d + t.radius <= s.radius) return t.center;
  if (d + s.radius <= t.radius) return s.center;
  const double cosine = (s.radius * s.radius + d * d - t.radius * t.radius) / (2.0 * s.radius * d);
  return s.center + s.radius * cosine * (t.center - s.center) / d;
}

/// Centre of mass of the overlap, by its slices across the line of centres. Simpson's rule is exact for their areas
/// times the position, which are cubic on either side of the circle in which the spheres meet.
Eigen::Vector3d center_of_overlap(const Sphere& s, const Sphere& t) {
  const double d = (t.center - s.center).norm(), plane = (d * d + s.radius * s.radius - t.radius * t.radius) / (2 * d);
  if (d + t.radius <= s.radius) return t.center;
  if (d + s.radius <= t.radius) return s.center;
  const auto slice = [](double radius, double z) { return radius * radius - z * z; };
  const auto simpson = [](double from, double to, const auto& f) {
    return (to - from) / 6.0 * (f(from) + 4.0 * f(0.5 * (from + to)) + f(to));
  };
  const auto part = [&](const auto& weight) {
    return simpson(d - t.radius, plane, [&](double z) { return weight(z) * slice(t.radius, z - d); }) +
           simpson(plane, s.radius, [&](double z) { return weight(z) * slice(s.radius, z); });
  };
  const double position = part([](double z) { return z; }) / part([](double) { return 1.0; });
  return s.center + position * (t.center - s.center) / d;
}

/// The force of PairForce::cones for the volume 1, with both axes and the line of centres in one frame.
Eigen::Vector3d cone_direction(const Eigen::Vector3d& axis_s, const Eigen::Vector3d& axis_t,
                               const Eigen::Vector3d& line) {
  if (axis_s.isZero() && axis_t.isZero()) return line;
  if (axis_s.isZero()) return -axis_t;
  if (axis_t.isZero()) return axis_s;
  return 0.5 * (axis_s - axis_t);
}

/// All pairs, no tree.
PenetrationSum brute_force(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                           const Eigen::Vector3d& about) {
  PenetrationSum sum;
  for (std::size_t i = 0; i < a.leaves.size(); ++i) {
    for (std::size_t j = 0; j < b.leaves.size(); ++j) {
      const Sphere &s = a.leaves[i], &t = b.leaves[j];
      const double weight = a.weights.empty() ? 1.0 : a.weights[i] * b.weights[j];
      const Eigen::Vector3d center = X_AB * t.center;
      const double d = (center - s.center).norm();
      const double volume = weight * overlap_volume(s.radius, t.radius, d);
      if (volume == 0.0) continue;
      sum.volume += volume;
      if (law == PairForce::cones) {
        const Eigen::Vector3d line = (center - s.center).normalized();
        const Eigen::Vector3d force = volume * cone_direction(a.axes[i], X_AB.R * b.axes[j], line);
        sum.force += force;
        sum.moment += (center_of_overlap(s, {center, t.radius}) - about).cross(force);
        ++sum.count.leaf_pairs;
        continue;
      }
      const double size = law == PairForce::volume ? volume : weight * overlap_disc_area(s.radius, t.radius, d);
      const Eigen::Vector3d force = size * (center - s.center).normalized();
      sum.force += force;
      // The arm may end anywhere on the line of centres: here at the centre of A's sphere.
      sum.moment += (s.center - about).cross(force);
      if (law == PairForce::gradient) {
        const Eigen::Vector3d p = middle_of_overlap(s, {center, t.radius}) - about;
        sum.first_moment += volume * p;
        sum.second_moment += volume * p.squaredNorm();
      }
      ++sum.count.leaf_pairs;
    }
  }
  return sum;
}

double brute_force_gap(const SphereTree& a, const SphereTree& b, const Pose& X_AB) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Sphere& s : a.leaves) {
    for (const Sphere& t : b.leaves) gap = std::min(gap, (X_AB * t.center - s.center).norm() - s.radius - t.radius);
  }
  return gap;
}

class TraversalTest : public ::testing::Test {
 protected:
  const SphereTree a_ = with_axes(build_sphere_tree(random_spheres(400, 21)));
  const SphereTree b_ = with_axes(build_sphere_tree(random_spheres(250, 22)));
  const Eigen::Vector3d about_{0.4, -1.3, 0.8};
  TraversalScratch scratch_;
};

TEST_F(TraversalTest, SumsEqualThoseOverAllPairs) {
  std::mt19937_64 random(31);
  int touching = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose X = random_pose(random, 1.0);
    for (const auto& [a, b] : {std::pair{&a_, &b_}, std::pair{&b_, &a_}}) {
      for (const PairForce law : {PairForce::cones, PairForce::volume, PairForce::gradient}) {
        const PenetrationSum truth = brute_force(*a, *b, X, law, about_);
        const PenetrationSum sum = penetration(*a, *b, X, law, about_, scratch_);
        EXPECT_EQ(sum.count.leaf_pairs, truth.count.leaf_pairs);
        EXPECT_NEAR(sum.volume, truth.volume, k_rounding);
        EXPECT_LE((sum.force - truth.force).norm(), k_rounding);
        EXPECT_LE((sum.moment - truth.moment).norm(), k_rounding);
        EXPECT_LE((sum.first_moment - truth.first_moment).norm(), k_rounding);
        EXPECT_NEAR(sum.second_moment, truth.second_moment, k_rounding);
        EXPECT_EQ(overlaps(*a, *b, X, scratch_).any, truth.count.leaf_pairs > 0);
      }
    }
    touching += brute_force(a_, b_, X, PairForce::volume, about_).count.leaf_pairs > 0 ? 1 : 0;
  }
  EXPECT_GT(touching, 5);
  EXPECT_LT(touching, 40);
}

/// However a small sphere lies in a large one, and for concentric spheres.
TEST(PairForce, OfConesLeadsOutOfALargeSphereAlongItsAxis) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.48, -0.6, 0.64), about(0.3, 0.1, -0.7);
  SphereTree large = build_sphere_tree({{{0.2, 0.3, -0.1}, 2.0}}), small = build_sphere_tree({{{1.0, 0.0, 0.5}, 0.3}});
  TraversalScratch scratch;
  std::mt19937_64 random(40);
  for (int i = 0; i < 20; ++i) {
    Pose X = random_pose(random, 1.0);
    const Eigen::Vector3d offset = i == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(0.4 * X.t.normalized());
    X.t = large.leaves[0].center + offset - X.R * small.leaves[0].center;  // the small sphere is inside
    large.axes = {axis};
    small.axes = {Eigen::Vector3d::Zero()};
    const double volume = small.leaves[0].volume();
    const PenetrationSum sum = penetration(large, small, X, PairForce::cones, about, scratch);
    EXPECT_NEAR(sum.volume, volume, k_rounding);
    EXPECT_LE((sum.force - volume * axis).norm(), k_rounding);
    EXPECT_LE((sum.moment - (X * small.leaves[0].center - about).cross(volume * axis)).norm(), k_rounding);
    // B's axis leads A's sphere out of B: the force on B is against it.
    large.axes = {Eigen::Vector3d::Zero()};
    small.axes = {axis};
    const PenetrationSum by_b = penetration(large, small, X, PairForce::cones, about, scratch);
    EXPECT_LE((by_b.force + volume * (X.R * axis)).norm(), k_rounding);
    // Axes that oppose each other agree about the direction; equal ones cancel.
    large.axes = {Eigen::Vector3d(-(X.R * axis))};
    EXPECT_LE((penetration(large, small, X, PairForce::cones, about, scratch).force - by_b.force).norm(), k_rounding);
    large.axes = {Eigen::Vector3d(X.R * axis)};
    EXPECT_LE(penetration(large, small, X, PairForce::cones, about, scratch).force.norm(), k_rounding);
  }
}

TEST_F(TraversalTest, WeightsScaleTheOverlaps) {
  std::mt19937_64 random(38);
  std::uniform_real_distribution<double> weight(1.0, 3.0);
  SphereTree a = a_, b = b_;
  for (SphereTree* tree : {&a, &b}) {
    std::vector<double> weights(tree->leaves.size());
    for (double& w : weights) w = weight(random);
    set_weights(*tree, std::move(weights));
  }
  int touching = 0;
  for (int i = 0; i < 20; ++i) {
    const Pose X = random_pose(random, 1.0);
    const PenetrationSum truth = brute_force(a, b, X, PairForce::gradient, about_);
    // With a sufficient budget the same pairs are summed, in another order.
    for (const PenetrationSum& sum : {penetration(a, b, X, PairForce::gradient, about_, scratch_),
                                      penetration_within_budget(a, b, X, PairForce::gradient, about_, 1u << 30)}) {
      EXPECT_NEAR(sum.volume, truth.volume, k_rounding);
      EXPECT_LE((sum.force - truth.force).norm(), k_rounding);
      EXPECT_LE((sum.moment - truth.moment).norm(), k_rounding);
      EXPECT_LE((sum.first_moment - truth.first_moment).norm(), k_rounding);
      EXPECT_NEAR(sum.second_moment, truth.second_moment, k_rounding);
    }
    touching += truth.volume > 0.0 ? 1 : 0;
  }
  EXPECT_GT(touching, 3);
}

TEST_F(TraversalTest, SeparationEqualsTheSmallestGap) {
  std::mt19937_64 random(32);
  for (const double reach : {4.0, 30.0, 1e4, 1e7}) {
    std::uint64_t tests = 0;
    for (int i = 0; i < 20; ++i) {
      Pose X = random_pose(random, 0.4);
      X.t += X.t.normalized() * reach;
      const double gap = brute_force_gap(a_, b_, X);
      ASSERT_GT(gap, 0.0);
      EXPECT_NEAR(separation(a_, b_, X).distance, gap, k_rounding * reach / 4.0);
      EXPECT_NEAR(separation(b_, a_, X.inverse()).distance, gap, k_rounding * reach / 4.0);
      tests += separation(a_, b_, X).count.sphere_tests;
    }
    EXPECT_LT(tests / 20, a_.leaves.size() * b_.leaves.size() / 20) << reach;  // few of them are tested
  }
}

/// The traversal computes in single precision, in units of one of the bodies.
TEST_F(TraversalTest, SumsEqualThoseOverAllPairsForAnySizes) {
  std::mt19937_64 random(36);
  const auto scaled = [](std::vector<Sphere> spheres, double factor) {
    for (Sphere& s : spheres) {
      s.center *= factor;
      s.radius *= factor;
    }
    return build_sphere_tree(std::move(spheres));
  };
  for (const auto& [size_a, size_b] : {std::pair{1e-12, 1e-12}, {1e12, 1e12}, {1.0, 1e-4}, {1e-4, 1.0}, {1e9, 1e3}}) {
    const SphereTree a = scaled(random_spheres(300, 23), size_a), b = scaled(random_spheres(200, 24), size_b);
    int touching = 0;
    for (int i = 0; i < 20; ++i) {
      const Pose X = random_pose(random, 0.5 * std::max(size_a, size_b));
      const PenetrationSum truth = brute_force(a, b, X, PairForce::volume, about_);
      const PenetrationSum sum = penetration(a, b, X, PairForce::volume, about_, scratch_);
      EXPECT_EQ(sum.count.leaf_pairs, truth.count.leaf_pairs) << size_a << ' ' << size_b;
      EXPECT_NEAR(sum.volume, truth.volume, k_rounding * truth.volume);
      EXPECT_LE((sum.force - truth.force).norm(), k_rounding * truth.volume);
      EXPECT_EQ(overlaps(a, b, X, scratch_).any, truth.count.leaf_pairs > 0);
      touching += truth.count.leaf_pairs > 0 ? 1 : 0;
    }
    EXPECT_GT(touching, 2) << size_a << ' ' << size_b;
  }
}

/// The tree's rounding hides no overlap.
TEST_F(TraversalTest, FindsASmallOverlapWithASingleSphere) {
  std::mt19937_64 random(37);
  for (int i = 0; i < 200; ++i) {
    Pose X = random_pose(random, 1.0);
    const auto of = [&](const SphereTree& tree) { return tree.leaves[random() % tree.leaves.size()]; };
    const SphereTree single = build_sphere_tree({of(b_)});
    const Sphere sphere = single.leaves.front();
    X.t += X.t.normalized() * 5.0;
    const double gap = brute_force_gap(a_, single, X);
    const SphereSeparation nearest = separation(a_, single, X);
    const Eigen::Vector3d offset = a_.leaves[static_cast<std::size_t>(nearest.leaf_a)].center - X * sphere.center;
    X.t += offset.normalized() * (gap + 1e-9);
    const PenetrationSum truth = brute_force(a_, single, X, PairForce::volume, about_);
    ASSERT_GT(truth.count.leaf_pairs, 0u);
    EXPECT_EQ(penetration(a_, single, X, PairForce::volume, about_, scratch_).count.leaf_pairs, truth.count.leaf_pairs);
    EXPECT_TRUE(overlaps(a_, single, X, scratch_).any);
    X.t -= offset.normalized() * 2e-9;
    ASSERT_GT(brute_force_gap(a_, single, X), 0.0);
    EXPECT_FALSE(overlaps(a_, single, X, scratch_).any);
  }
}

TEST_F(TraversalTest, FindsASmallOverlapOfTwoBodies) {
  std::mt19937_64 random(38);
  for (int i = 0; i < 4000; ++i) {
    Pose X = random_pose(random, 1.0);
    X.t += X.t.normalized() * 5.0;
    for (int step = 0; step < 3; ++step) {  // after a step other leaves may be nearest
      const SphereSeparation nearest = separation(a_, b_, X);
      const Eigen::Vector3d offset = a_.leaves[static_cast<std::size_t>(nearest.leaf_a)].center -
                                     X * b_.leaves[static_cast<std::size_t>(nearest.leaf_b)].center;
      X.t += offset.normalized() * (nearest.distance + 1e-10);
      if (separation(a_, b_, X).distance < 0.0) break;
    }
    ASSERT_LT(separation(a_, b_, X).distance, 0.0);
    EXPECT_TRUE(overlaps(a_, b_, X, scratch_).any) << i;
    EXPECT_GT(penetration(a_, b_, X, PairForce::volume, about_, scratch_).count.leaf_pairs, 0u) << i;
  }
}

TEST_F(TraversalTest, ABudgetGivesAnEstimateThatConverges) {
  std::mt19937_64 random(33);
  double error_small = 0.0, error_large = 0.0;
  int counted = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose X = random_pose(random, 0.5);
    const PenetrationSum full = penetration(a_, b_, X, PairForce::volume, about_, scratch_);
    if (full.volume == 0.0) continue;
    for (const PairForce law : {PairForce::cones, PairForce::volume}) {
      const PenetrationSum all = penetration(a_, b_, X, law, about_, scratch_);
      const PenetrationSum unlimited = penetration_within_budget(a_, b_, X, law, about_, 1'000'000);
      EXPECT_LT(unlimited.count.sphere_tests, 1'000'000u);
      EXPECT_NEAR(unlimited.volume, all.volume, k_rounding);
      EXPECT_LE((unlimited.force - all.force).norm(), k_rounding);
      EXPECT_LE((unlimited.moment - all.moment).norm(), k_rounding);
    }

    const std::uint64_t half = full.count.sphere_tests / 2, most = full.count.sphere_tests * 9 / 10;
    const PenetrationSum rough = penetration_within_budget(a_, b_, X, PairForce::volume, about_, half);
    const PenetrationSum fine = penetration_within_budget(a_, b_, X, PairForce::volume, about_, most);
    EXPECT_LE(rough.count.sphere_tests, half + 16);  // one expanded pair of nodes beyond the budget
    EXPECT_GE(rough.count.sphere_tests, half);
    error_small += std::abs(rough.volume - full.volume) / full.volume;
    error_large += std::abs(fine.volume - full.volume) / full.volume;
    ++counted;
  }
  ASSERT_GT(counted, 10);
  EXPECT_LT(error_large, error_small);
  EXPECT_LT(error_large / counted, 0.1);
}

/// Only the roots are expanded: the overlap volume of every two of their children's balls, times the leaves' densities.
TEST_F(TraversalTest, PairsBeyondTheBudgetAddTheirExpectedOverlap) {
  std::mt19937_64 random(39);
  for (int i = 0; i < 20; ++i) {
    const Pose X = random_pose(random, 0.5);
    double expected = 0.0;
    for (std::size_t m = 0; m < a_.children(0); ++m) {
      for (std::size_t n = 0; n < b_.children(0); ++n) {
        const Sphere p = a_.ball(0, m), q = b_.ball(0, n);
        const double density =
            std::min(1.0, a_.volumes[0][m] / p.volume()) * std::min(1.0, b_.volumes[0][n] / q.volume());
        expected += density * overlap_volume(p.radius, q.radius, (X * q.center - p.center).norm());
      }
    }
    const PenetrationSum estimate = penetration_within_budget(a_, b_, X, PairForce::volume, about_, 1);
    EXPECT_EQ(estimate.count.sphere_tests, 16u);
    EXPECT_NEAR(estimate.volume, expected, k_rounding * (1.0 + expected));
    // Balls have no axis: their force is along the line of centres.
    const PenetrationSum cones = penetration_within_budget(a_, b_, X, PairForce::cones, about_, 1);
    EXPECT_LE((cones.force - estimate.force).norm(), k_rounding * (1.0 + expected));
    EXPECT_LE((cones.moment - estimate.moment).norm(), k_rounding * (1.0 + expected));
  }
}

/// Each body's frame is moved by a rigid motion of its own, and the pose adapted.
TEST_F(TraversalTest, DoesNotDependOnTheFrames) {
  std::mt19937_64 random(35);
  const auto moved = [](std::vector<Sphere> spheres, const Pose& X) {
    for (Sphere& s : spheres) s.center = X * s.center;
    return spheres;
  };
  constexpr double k_moved = 1e-10;  // rounding of coordinates of 30 units, against overlaps of a hundredth
  int touching = 0;
  for (int i = 0; i < 10; ++i) {
    const Pose X = random_pose(random, 0.7), move_a = random_pose(random, 20.0), move_b = random_pose(random, 20.0);
    const SphereTree a = with_axes(build_sphere_tree(moved(random_spheres(400, 21), move_a)), move_a.R);
    const SphereTree b = with_axes(build_sphere_tree(moved(random_spheres(250, 22), move_b)), move_b.R);
    for (const PairForce law : {PairForce::cones, PairForce::volume}) {
      const PenetrationSum plain = penetration(a_, b_, X, law, about_, scratch_);
      const PenetrationSum other = penetration(a, b, move_a * X * move_b.inverse(), law, move_a * about_, scratch_);
      EXPECT_EQ(other.count.leaf_pairs, plain.count.leaf_pairs);
      EXPECT_NEAR(other.volume, plain.volume, k_moved);
      EXPECT_LE((other.force - move_a.R * plain.force).norm(), k_moved);
      EXPECT_LE((other.moment - move_a.R * plain.moment).norm(), k_moved);
      touching += plain.volume > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(touching, 10);
}

TEST_F(TraversalTest, EveryInstructionSetGivesTheSameBits) {
  std::mt19937_64 random(34);
  std::vector<Pose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back(random_pose(random, 0.6));
  constexpr PairForce k_laws[] = {PairForce::cones, PairForce::volume, PairForce::gradient};
  std::vector<PenetrationSum> reference;
  for (const Pose& X : poses) {
    for (const PairForce law : k_laws) reference.push_back(penetration(a_, b_, X, law, about_, scratch_));
  }
  int targets = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    std::size_t i = 0;
    for (const Pose& X : poses) {
      for (const PairForce law : k_laws) {
        const PenetrationSum sum = penetration(a_, b_, X, law, about_, scratch_);
        EXPECT_EQ(sum.volume, reference[i].volume);
        EXPECT_EQ(sum.force, reference[i].force);
        EXPECT_EQ(sum.moment, reference[i].moment);
        EXPECT_EQ(sum.first_moment, reference[i].first_moment);
        EXPECT_EQ(sum.second_moment, reference[i].second_moment);
        ++i;
      }
    }
    ++targets;
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GE(targets, 2);
}

}  // namespace
}  // namespace sixdof::ist
