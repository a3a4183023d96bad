#include <sixdof/proximity/close_search.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/distance.h>
#include <sixdof/oracle/overlap.h>

#include "../geometry/shapes.h"
#include "../oracle/distance_truth.h"
#include "../oracle/swept_pairs.h"

// Bounds in doubles against all triangles that they stand for; and searches where floats cannot tell volumes apart:
// bodies of unlike size, bodies far apart, layers. Answers are compared with closed forms, the work with the number of
// pairs that have to be looked at.

namespace sixdof {
namespace {

constexpr double k_tessellation = 1e-5;      // of a distance of 0.005
constexpr double k_height_rounding = 2e-15;  // rounding of the least height, of order 1

using detail::CloseBounds;
using detail::CloseVolume;
using detail::NodePair;
using distance_truth::brute_force;
using Eigen::Vector3d;
using shapes::Generator;

/// Unit sphere of 2 `around` (`down` - 1) triangles, by latitudes and longitudes: convex, with all vertices on it.
Mesh sphere(std::uint32_t around, std::uint32_t down, double radius = 1.0) {
  std::vector<Vector3d> v{{0.0, 0.0, radius}};
  for (std::uint32_t j = 1; j < down; ++j) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double polar = std::numbers::pi * j / down, azimuth = 2.0 * std::numbers::pi * i / around;
      v.push_back(radius *
                  Vector3d(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)));
    }
  }
  v.push_back({0.0, 0.0, -radius});
  const auto at = [around](std::uint32_t j, std::uint32_t i) { return 1 + (j - 1) * around + i % around; };
  const auto south = static_cast<std::uint32_t>(v.size() - 1);
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i < around; ++i) {
    t.push_back({0, at(1, i), at(1, i + 1)});
    t.push_back({south, at(down - 1, i + 1), at(down - 1, i)});
    for (std::uint32_t j = 1; j + 1 < down; ++j) {
      t.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1)});
      t.push_back({at(j, i), at(j + 1, i + 1), at(j, i + 1)});
    }
  }
  return Mesh::build(v, t);
}

Mesh scaled(const Mesh& mesh, double factor) {
  std::vector<Vector3d> v = mesh.vertices();
  for (Vector3d& p : v) p *= factor;
  return Mesh::build(v, mesh.triangles());
}

/// Distance of B from the surface of A if B lies inside A, which is convex: the least over A's faces of the distance of
/// B's vertices from the face's plane.
double distance_inside(const Mesh& a, const Mesh& b, const Pose& pose) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.triangles().size(); ++i) {
    const TriangleCorners c = distance_truth::corners_of(a, i);
    const Vector3d n = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    for (const Vector3d& p : b.vertices()) least = std::min(least, n.dot(c[0] - pose * p));
  }
  return least;
}

std::uint64_t work_of(const DistanceQuery& query) {
  return query.counts().nodes + query.counts().leaf_pairs + query.counts().triangles;
}

/// Asks for the distance in both orders of the meshes.
void expect_distance(const Mesh& a, const Mesh& b, const Pose& pose, double truth, double tolerance,
                     std::uint64_t most_work) {
  const DistanceOracle oracle(a, b), swapped(b, a);
  DistanceQuery query(oracle), other(swapped);
  EXPECT_NEAR(query.distance(pose).distance, truth, tolerance);
  EXPECT_LE(work_of(query), most_work);
  EXPECT_NEAR(other.distance(pose.inverse()).distance, truth, tolerance);
  EXPECT_LE(work_of(other), most_work);
}

/// Triangles of a volume in tree order: first and one past the last.
std::pair<std::uint32_t, std::uint32_t> triangles_of(const Tree& tree, const CloseVolume& v) {
  if (v.triangle != CloseVolume::k_whole) return {v.triangle, v.triangle + 1};
  if ((v.volume & NodePair::k_leaf) != 0) {
    const Tree::Child leaf = tree.leaves()[v.volume - NodePair::k_leaf].child;
    return {leaf.first(), leaf.first() + leaf.count()};
  }
  const Tree::Node& node = tree.nodes()[v.volume];
  return {node.first_triangle, node.first_triangle + node.triangle_count};
}

CloseVolume random_volume(const Tree& tree, Generator& generator) {
  const auto index = [&](std::size_t count) { return static_cast<std::uint32_t>(generator() % count); };
  const std::uint32_t kind = index(3);
  if (kind == 0) return {index(tree.nodes().size())};
  const std::uint32_t leaf = index(tree.leaves().size());
  if (kind == 1) return {NodePair::k_leaf + leaf};
  const Tree::Child child = tree.leaves()[leaf].child;
  return {NodePair::k_leaf + leaf, child.first() + index(child.count())};
}

TEST(CloseSearch, BoundsDoNotExceedTheDistanceOfAnyPair) {
  Generator generator(31);
  int tight = 0, pairs = 0;
  for (int i = 0; i < 40; ++i) {
    const double ratio = std::pow(10.0, -shapes::uniform(generator, 0.0, 7.0));
    const Mesh a = shapes::bumpy_sphere(2, 0.2, 1.0, shapes::uniform_vector(generator, 3.0));
    const Mesh b = shapes::bumpy_sphere(2, 0.3, ratio, shapes::uniform_vector(generator, 3.0));
    Pose pose = shapes::random_pose(generator, 0.0);
    const double apart = i % 4 == 0 ? std::pow(10.0, shapes::uniform(generator, 1.0, 9.0)) : 1.0 + 0.5 * ratio;
    pose.t = a.center() - pose.R * b.center() + apart * shapes::unit_vector(generator);
    const Tree tree_a(a), tree_b(b);
    const CloseBounds bounds(tree_a, tree_b, pose);
    for (int k = 0; k < 60; ++k) {
      const CloseVolume of_a = random_volume(tree_a, generator), of_b = random_volume(tree_b, generator);
      double truth = std::numeric_limits<double>::infinity();
      const auto [first_a, end_a] = triangles_of(tree_a, of_a);
      const auto [first_b, end_b] = triangles_of(tree_b, of_b);
      if ((end_a - first_a) * (end_b - first_b) > 3000) continue;
      for (std::uint32_t s = first_a; s < end_a; ++s) {
        for (std::uint32_t t = first_b; t < end_b; ++t) {
          truth =
              std::min(truth, triangle_triangle_distance(tree_a.corners()[s],
                                                         distance_truth::corners_of(b, tree_b.mesh_triangle()[t], pose))
                                  .distance);
        }
      }
      const double lower = bounds.lower_bound(bounds.shape_of_a(of_a), bounds.shape_of_b(of_b),
                                              shapes::unit_vector(generator), std::numeric_limits<double>::infinity());
      ASSERT_LE(lower, truth);
      ++pairs;
      // Not farther below than the volumes are large.
      tight += lower >= truth - std::sqrt(bounds.shape_of_a(of_a).squared_size) -
                            std::sqrt(bounds.shape_of_b(of_b).squared_size) - 1e-13 * apart;
    }
  }
  EXPECT_GT(pairs, 1500);
  EXPECT_EQ(tight, pairs);
}

TEST(CloseSearch, TheGapOfTrianglesAlongTheirClosestPointsIsTheirDistance) {
  Generator generator(37);
  for (const double apart : {3.0, 1e3, 1e6}) {
    const Mesh a = shapes::bumpy_sphere(2, 0.2, 1.0, shapes::uniform_vector(generator, 3.0));
    const Mesh b = shapes::bumpy_sphere(2, 0.3, 0.1, shapes::uniform_vector(generator, 3.0));
    Pose pose = shapes::random_pose(generator, 0.0);
    pose.t = a.center() - pose.R * b.center() + apart * shapes::unit_vector(generator);
    const Tree tree_a(a), tree_b(b);
    const CloseBounds bounds(tree_a, tree_b, pose);
    for (int k = 0; k < 500; ++k) {
      const TrianglePair pair{static_cast<std::uint32_t>(generator() % a.triangles().size()),
                              static_cast<std::uint32_t>(generator() % b.triangles().size())};
      const ClosestPoints closest = triangle_triangle_distance(
          tree_a.corners()[pair.a], distance_truth::corners_of(b, tree_b.mesh_triangle()[pair.b], pose));
      const double gap = bounds.gap_along((closest.on_b - closest.on_a).normalized(), pair);
      ASSERT_LE(gap, closest.distance);
      ASSERT_GE(gap, closest.distance - 1e-13 * (10.0 + apart));  // the rounding that CloseBounds allows for, and more
      ASSERT_LE(bounds.gap_along(shapes::unit_vector(generator), pair), closest.distance);
    }
  }
}

TEST(CloseSearch, SmallBodiesInsideLargeOnesTakeFewPairs) {
  const Mesh a = sphere(90, 45);
  Generator generator(32);
  for (const double ratio : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8}) {
    const Mesh b = scaled(a, ratio);
    for (int i = 0; i < 3; ++i) {
      Pose pose = shapes::random_pose(generator, 0.5);
      if (i == 0) pose.t = 0.98 * Vector3d(0.36, 0.48, 0.8);
      expect_distance(a, b, pose, distance_inside(a, b, pose), 4e-15, 3000);
    }
  }
}

TEST(CloseSearch, SmallBodiesBelowAFanTakeFewPairs) {
  // All slices lie in one plane, which cuts all axes: their boxes overlap, and only one slice is the closest.
  constexpr std::uint32_t k_slices = 512;
  std::vector<Vector3d> v{{0.0, 0.0, 0.0}};
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i < k_slices; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / k_slices;
    v.push_back({0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.0});
    t.push_back({0, 1 + i, 1 + (i + 1) % k_slices});
  }
  Generator generator(36);
  const Mesh b = sphere(180, 89, 1e-3);
  for (int i = 0; i < 5; ++i) {
    const Pose frame = shapes::random_pose(generator, 0.1);
    const Mesh a = shapes::moved(Mesh::build(v, t), frame);
    Pose pose = shapes::random_pose(generator, 0.0);
    pose.t = frame * Vector3d(0.13, 0.06 * i, 0.37);
    double truth = std::numeric_limits<double>::infinity();
    for (const Vector3d& p : b.vertices()) truth = std::min(truth, (frame.inverse() * (pose * p)).z());
    expect_distance(a, b, pose, truth, 4e-16, 12'000);
  }
}

TEST(CloseSearch, AScaledCopyInTheCentreTakesPairsAlongTheFacesThatTie) {
  // Every face is parallel to that of the copy, and the distances of those on a latitude are equal up to rounding.
  const Mesh a = sphere(180, 89);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.triangles().size(); ++i) {
    const TriangleCorners c = distance_truth::corners_of(a, i);
    least = std::min(least, (c[1] - c[0]).cross(c[2] - c[0]).normalized().dot(c[0]));
  }
  for (const auto& [ratio, most_work] : {std::pair(1e-3, 500'000u), std::pair(1e-4, 200'000u)}) {
    const Mesh b = scaled(a, ratio);
    const DistanceOracle oracle(a, b);
    DistanceQuery query(oracle);
    EXPECT_NEAR(query.distance(Pose{}).distance, (1.0 - ratio) * least, k_height_rounding);
    EXPECT_LE(work_of(query), most_work);
  }
}

TEST(CloseSearch, SmallBodiesAboveAFaceTakeFewPairs) {
  const Mesh a = shapes::box({1.0, 1.0, 1.0});
  const Mesh unit = sphere(180, 89);
  Generator generator(33);
  for (const double ratio : {1.0, 1e-4, 1e-6, 1e-8}) {
    const Mesh b = scaled(unit, ratio);
    for (const double gap : {1e-2 * ratio, 1e-8}) {
      Pose pose = shapes::random_pose(generator, 0.0);
      pose.t = Vector3d(0.1, 0.2, 0.0);
      double lowest = 0.0;
      for (const Vector3d& p : b.vertices()) lowest = std::min(lowest, (pose * p).z());
      pose.t.z() = 1.0 + gap - lowest;
      const double truth = pose.t.z() + lowest - 1.0;  // `gap`, rounded
      // At equal size floats tell most pairs apart, and doubles are used for the rest only where these are many.
      const std::uint64_t most_work = ratio == 1.0 ? 3000 : 600;
      expect_distance(a, b, pose, truth, 4e-16, most_work);
      const DistanceOracle oracle(a, b);
      DistanceQuery query(oracle);
      EXPECT_FALSE(query.collide(pose));
      EXPECT_LE(work_of(query), most_work);
      pose.t.z() -= 2.0 * gap;
      EXPECT_TRUE(query.collide(pose));
    }
  }
}

TEST(CloseSearch, SmallBodiesBesideLargeOnesHaveTheBitsOfBruteForce) {
  const Mesh a = shapes::bumpy_sphere(2, 0.2);
  Generator generator(34);
  for (int i = 0; i < 10; ++i) {
    const double ratio = std::pow(10.0, -shapes::uniform(generator, 1.0, 9.0));
    const Mesh b = shapes::bumpy_sphere(2, 0.3, ratio);
    Pose pose = shapes::random_pose(generator, 0.0);
    const Vector3d u = shapes::unit_vector(generator);
    pose.t = 3.0 * u;
    // On a corner of the triangle of A that is closest.
    const Separation from_outside = brute_force(a, b, pose);
    pose.t = from_outside.witness_a + (1.5 + shapes::uniform(generator, 0.0, 1.0)) * ratio * u;
    const Separation truth = brute_force(a, b, pose);
    const DistanceOracle oracle(a, b);
    DistanceQuery query(oracle);
    const Separation d = query.distance(pose);
    EXPECT_EQ(d.distance, truth.distance);
    if (truth.distance == 0.0) continue;
    EXPECT_EQ(d.triangle_a, truth.triangle_a);
    EXPECT_EQ(d.triangle_b, truth.triangle_b);
  }
}

TEST(CloseSearch, BodiesFarApartTakeFewPairs) {
  const Mesh a = sphere(180, 89);
  const DistanceOracle oracle(a, a);
  DistanceQuery query(oracle);
  for (const double far : {1e5, 1e6, 1e7, 1e8, 1e9, 1e10}) {
    const Pose pose{Eigen::Matrix3d::Identity(), far * Vector3d(1.0, 0.1, 0.0)};
    double reach = 0.0;  // of the sphere along the line between the centres
    for (const Vector3d& p : a.vertices()) reach = std::max(reach, p.dot(pose.t.normalized()));
    // The closest points are not exactly on that line: up to the square of the size / distance.
    EXPECT_NEAR(query.distance(pose).distance, pose.t.norm() - 2.0 * reach, 4e-16 * far + 4.0 / far);
    EXPECT_LE(work_of(query), 3000u) << far;
  }
}

/// A ball of radius 0.01 at (1500, 0, 0), alone, and beside a block of 2e5 times its size.
struct Details {
  Mesh ball, both;

  static Details make() {
    const Mesh unit = sphere(180, 89, 0.01);
    std::vector<Vector3d> v = unit.vertices();
    for (Vector3d& p : v) p.x() += 1500.0;
    const Mesh ball = Mesh::build(v, unit.triangles());
    const Mesh block = shapes::box({1000.0, 1000.0, 1000.0});
    std::vector<Triangle> t = unit.triangles();
    const auto first = static_cast<std::uint32_t>(v.size());
    for (const Triangle& f : block.triangles()) t.push_back({f[0] + first, f[1] + first, f[2] + first});
    v.insert(v.end(), block.vertices().begin(), block.vertices().end());
    return {ball, Mesh::build(v, t)};
  }
};

/// Ball before ball, with the centres this far apart along x and 0.001 along y.
Pose ball_to_ball(double apart) {
  return {Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitZ()).toRotationMatrix(), {3000.0 + apart, 0.001, 0.0}};
}

TEST(CloseSearch, SmallPartsOfLargeBodiesTakeFewPairs) {
  // Balls alone have the same closest pair, and floats tell their triangles apart.
  const auto [ball, both] = Details::make();
  const Pose pose = ball_to_ball(0.025);
  const DistanceOracle balls(ball, ball);
  const Separation truth = DistanceQuery(balls).distance(pose);
  EXPECT_NEAR(truth.distance, std::hypot(0.025, 0.001) - 0.02, k_tessellation);  // facets lie up to 6e-6 inside
  const DistanceOracle oracle(both, both);
  DistanceQuery query(oracle);
  const Separation d = query.distance(pose);
  EXPECT_EQ(d.distance, truth.distance);
  EXPECT_EQ(d.triangle_a, truth.triangle_a);
  EXPECT_EQ(d.triangle_b, truth.triangle_b);
  EXPECT_LE(work_of(query), 8000u);
  EXPECT_FALSE(query.collide(pose));
  EXPECT_LE(work_of(query), 8000u);
}

Overlap overlap_of(const Mesh& mesh, const Tree& tree, const Pose& pose) {
  const Solid solid(mesh, tree);
  return OverlapQuery(solid, solid).evaluate(pose);
}

TEST(CloseSearch, OverlapsOfSmallPartsHaveFewCandidates) {
  const auto [ball, both] = Details::make();
  const Tree tree_of_ball(ball), tree(both);
  const Pose pose = ball_to_ball(0.017);
  const Overlap truth = overlap_of(ball, tree_of_ball, pose), overlap = overlap_of(both, tree, pose);
  EXPECT_GT(truth.crossings, 300u);
  EXPECT_EQ(overlap.crossings, truth.crossings);
  constexpr double k_relative = 1e-8;  // of a volume of 1e-6, by sums whose terms round to 1e-16 of 1500 x 1e-5
  EXPECT_NEAR(overlap.volume, truth.volume, k_relative * truth.volume);
  EXPECT_LE((overlap.area - truth.area).norm(), k_relative * truth.area.norm());
  std::vector<TrianglePair> candidates;
  CandidateScratch scratch;
  find_candidates(tree, tree, pose, scratch, candidates);
  EXPECT_LE(candidates.size(), 10 * truth.crossings);

  // While B moves by a tenth of a radius.
  const Vector3d displacement(-6e-4, 8e-4, 0.0);
  std::vector<SweptPair> swept;
  find_swept_leaves(tree, tree, pose, displacement, scratch, swept);
  EXPECT_LE(swept.size(), 400 * truth.crossings);
  std::vector<SweptPair> triangles;
  find_swept_triangles(tree, tree, pose, displacement, swept, triangles);
  EXPECT_LE(triangles.size(), 400 * truth.crossings);
  const Solid solid(both, tree);
  EXPECT_GT(swept::expect_swept(solid, solid, pose, displacement), 5000u);
}

/// `count` square sheets of 10 x 10 squares, `spacing` apart.
Mesh layers(std::uint32_t count, double spacing) {
  constexpr std::uint32_t n = 10;
  std::vector<Vector3d> v;
  std::vector<Triangle> t;
  for (std::uint32_t l = 0; l < count; ++l) {
    const auto first = static_cast<std::uint32_t>(v.size());
    for (std::uint32_t i = 0; i <= n; ++i) {
      for (std::uint32_t j = 0; j <= n; ++j) v.push_back({0.1 * i, 0.1 * j, spacing * l});
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t j = 0; j < n; ++j) {
        const std::uint32_t c = first + i * (n + 1) + j;
        t.push_back({c, c + n + 1, c + n + 2});
        t.push_back({c, c + n + 2, c + 1});
      }
    }
  }
  return Mesh::build(v, t);
}

TEST(CloseSearch, LayersCloserThanFloatsTellTakePairsOfTheOuterOnesOnly) {
  for (const double spacing : {1e-6, 1e-7}) {
    const Mesh a = layers(50, spacing);
    const double thickness = a.box().sizes().z();
    Pose pose;
    pose.t = Vector3d(0.003, 0.002, 0.01);
    expect_distance(a, a, pose, 0.01 - thickness, 1e-17, 16'000);
    // Tilted: the corner of the lower layer of B that goes down.
    pose.R = Eigen::AngleAxisd(1e-3, Vector3d::UnitX()).toRotationMatrix();
    const double lowest = pose.t.z();  // about the edge y = 0
    expect_distance(a, a, pose, lowest - thickness, 1e-9, 16'000);
  }
}

}  // namespace
}  // namespace sixdof
