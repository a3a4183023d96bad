#include <sixdof/oracle/candidates.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/oracle/crossing.h>
#include <sixdof/oracle/overlap.h>

#include "../geometry/shapes.h"
#include "bodies.h"
#include "instruction_sets.h"
#include "swept_pairs.h"

namespace sixdof {
namespace {

using Eigen::Vector3d;
using swept::expect_swept;
using swept::leaves_of;
using swept::moved;

void expect_swept_of_tori() {
  const bodies::Body torus(bodies::bumpy_torus(31, 17));
  const bodies::Body small(bodies::bumpy_torus(13, 9, 0.2, 0.6));
  std::mt19937_64 random(23);
  for (const auto& [a, b] : {std::pair(&torus, &small), std::pair(&small, &torus), std::pair(&torus, &torus)}) {
    std::size_t crossings = 0;
    for (int i = 0; i < 8; ++i) {
      const Pose X_AB = bodies::random_pose(random, 0.5);
      const Vector3d displacement = 0.4 * bodies::random_pose(random, 1.0).R.col(0);
      crossings += expect_swept(a->solid, b->solid, X_AB, displacement);
    }
    EXPECT_GT(crossings, 0u);
  }
}

TEST(SweptPairs, ContainTheCrossingsOfEveryFractionOnEveryInstructionSet) {
  for_each_instruction_set(expect_swept_of_tori);
}

TEST(SweptPairs, ContainThemForDisplacementsAlongFaces) {
  const bodies::Body box(bodies::box({-0.5, -0.3, -0.4}, {0.5, 0.3, 0.4}));
  const bodies::Body other(bodies::box({-0.2, -0.6, -0.1}, {0.3, 0.2, 0.5}, true));
  const Pose X_AB{Eigen::Matrix3d::Identity(), Vector3d(0.25, 0.125, 0.0)};
  for (const Vector3d& displacement : {Vector3d(0.4, 0, 0), Vector3d(0, -0.3, 0), Vector3d(0, 0, 0.2),
                                       Vector3d(-0.2, 0.1, 0), Vector3d(1e-9, 0, 0), Vector3d(0, 0, 0)}) {
    EXPECT_GT(expect_swept(box.solid, other.solid, X_AB, displacement), 0u);
    EXPECT_GT(expect_swept(other.solid, box.solid, X_AB, displacement), 0u);
  }
}

TEST(SweptPairs, AreFewAtOneFraction) {
  const bodies::Body torus(bodies::bumpy_torus(61, 31));
  const Tree& tree = torus.tree;
  std::mt19937_64 random(5);
  const Pose X_AB = bodies::random_pose(random, 0.5);
  const Vector3d displacement = 0.3 * Vector3d(2, -1, 1).normalized();
  std::vector<SweptPair> of_leaves, of_triangles;
  CandidateScratch scratch;
  find_swept_leaves(tree, tree, X_AB, displacement, scratch, of_leaves);
  find_swept_triangles(tree, tree, X_AB, displacement, of_leaves, of_triangles);
  const std::vector<std::uint32_t> leaves = leaves_of(tree);
  for (const double x : {0.1, 0.4, 0.9}) {
    const auto at_x = [&](const SweptPair& pair) {
      return static_cast<double>(pair.first) <= x && x <= static_cast<double>(pair.last);
    };
    std::vector<TrianglePair> found;
    find_candidates(tree, tree, moved(X_AB, x * displacement), scratch, found);
    const auto triangles = std::count_if(of_triangles.begin(), of_triangles.end(), at_x);
    EXPECT_LT(static_cast<double>(triangles), 1.2 * static_cast<double>(found.size())) << x;
    EXPECT_LT(triangles, static_cast<std::ptrdiff_t>(of_triangles.size()));
    std::vector<TrianglePair> selected;
    select_triangles(tree, tree, moved(X_AB, x * displacement), 0.0, of_leaves, {x, x}, selected);
    EXPECT_LT(static_cast<double>(selected.size()), 1.2 * static_cast<double>(found.size())) << x;
    // The box and slab of a leaf hold more than its triangles: 2.5 to 2.8 times as many pairs, a quarter of all.
    std::set<std::pair<std::uint32_t, std::uint32_t>> leaves_found;
    for (const TrianglePair& pair : found) leaves_found.emplace(leaves[pair.a], leaves[pair.b]);
    const auto pairs_of_leaves = static_cast<double>(std::count_if(of_leaves.begin(), of_leaves.end(), at_x));
    EXPECT_LT(pairs_of_leaves, 4.0 * static_cast<double>(leaves_found.size())) << x;
    EXPECT_LT(pairs_of_leaves, 0.5 * static_cast<double>(of_leaves.size())) << x;
  }
}

TEST(SweptPairs, OfTrianglesComeInTheOrderOfThoseAtOnePose) {
  // Large enough for hundreds of pairs of nodes to wait at a time.
  const bodies::Body a(bodies::bumpy_torus(121, 65)), b(bodies::bumpy_torus(91, 47, 0.2, 0.8));
  std::mt19937_64 random(25);
  std::size_t common = 0;
  for (int i = 0; i < 6; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.4);
    const Vector3d displacement = 0.3 * X_AB.R.col(0);
    std::vector<SweptPair> leaves, swept;
    CandidateScratch scratch;
    find_swept_leaves(a.tree, b.tree, X_AB, displacement, scratch, leaves);
    find_swept_triangles(a.tree, b.tree, X_AB, displacement, leaves, swept);
    std::vector<TrianglePair> found;
    find_candidates(a.tree, b.tree, moved(X_AB, 0.5 * displacement), scratch, found);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> place;
    for (const SweptPair& pair : swept) place.emplace(std::pair(pair.a, pair.b), place.size());
    std::size_t last = 0;
    for (const TrianglePair& pair : found) {
      const auto at = place.find({pair.a, pair.b});
      if (at == place.end()) continue;  // a candidate at one pose alone, that does not cross
      ASSERT_GE(at->second, last);
      last = at->second;
      ++common;
    }
  }
  EXPECT_GT(common, 1000u);
}

TEST(Candidates, AreFewWhereTrianglesAreSmall) {
  // The slack is about a ten-thousandth of an edge here. Where the planes of triangles are allowed a hundred times as
  // much, which covers a normal that is off by its corners' slack, there are 3.6 candidates per crossing instead
  // of 2.2.
  const bodies::Body torus(bodies::bumpy_torus(601, 301));
  std::mt19937_64 random(5);
  CandidateScratch scratch;
  std::vector<TrianglePair> found;
  for (int i = 0; i < 3; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.5);
    find_candidates(torus.tree, torus.tree, X_AB, scratch, found);
    const std::size_t crossings = swept::crossings_among(torus.tree, torus.tree, X_AB, found).size();
    EXPECT_GT(crossings, 1000u);
    EXPECT_LT(static_cast<double>(found.size()), 2.3 * static_cast<double>(crossings));
  }
}

/// Pairs of triangles that cross, as indices in tree order, by looking at all pairs.
std::vector<std::pair<std::uint32_t, std::uint32_t>> all_crossings(const Tree& a, const Tree& b, const Pose& X_AB) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t i = 0; i < a.corners().size(); ++i) {
    for (std::uint32_t j = 0; j < b.corners().size(); ++j) {
      TriangleCorners of_b = b.corners()[j];
      for (Vector3d& p : of_b) p = transform_point(X_AB, p);
      if (cross(a.corners()[i], of_b)) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

/// Rods of long strips that cross or touch.
void expect_all_crossings_of_rods() {
  const bodies::Body thick(shapes::rod(60, 0.2)), thin(shapes::rod(40, 0.05));
  shapes::Generator generator(31);
  std::size_t crossings = 0;
  for (const auto& [a, b] : {std::pair(&thick, &thin), std::pair(&thin, &thick)}) {
    for (int i = 0; i < 12; ++i) {
      Pose X_AB = shapes::random_pose(generator, 0.0);
      // Frames that are nearly parallel: three of the directions across their axes are ill-conditioned.
      if (i % 4 == 3) X_AB.R = Eigen::AngleAxisd(1e-3 * i, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
      X_AB.t = shapes::uniform(generator, 0.0, 0.26) * shapes::unit_vector(generator);
      std::vector<TrianglePair> candidates;
      CandidateScratch scratch;
      find_candidates(a->tree, b->tree, X_AB, scratch, candidates);
      std::set<std::pair<std::uint32_t, std::uint32_t>> found;
      for (const TrianglePair& pair : candidates) found.emplace(pair.a, pair.b);
      for (const auto& pair : all_crossings(a->tree, b->tree, X_AB)) {
        ++crossings;
        EXPECT_TRUE(found.contains(pair)) << i << ": " << pair.first << ", " << pair.second;
      }
      expect_swept(a->solid, b->solid, X_AB, 0.3 * shapes::unit_vector(generator));
    }
  }
  EXPECT_GT(crossings, 500u);
}

TEST(Candidates, OfLongTrianglesContainAllCrossingsOnEveryInstructionSet) {
  for_each_instruction_set(expect_all_crossings_of_rods);
}

TEST(Candidates, OfLongTrianglesThatDoNotTouchAreFew) {
  const bodies::Body rod(shapes::rod(2000, 0.1));
  shapes::Generator generator(33);
  std::size_t found = 0;
  for (int i = 0; i < 20; ++i) {
    Pose X_AB = shapes::random_pose(generator, 0.0);
    X_AB.t = 0.2001 * Vector3d::UnitZ().cross(X_AB.R.col(2)).normalized();
    std::vector<TrianglePair> pairs;
    CandidateScratch scratch;
    find_candidates(rod.tree, rod.tree, X_AB, scratch, pairs);
    found += pairs.size();
  }
  EXPECT_LT(found, 1000000u) << "89,311,400 without the axes across two boxes";
}

}  // namespace
}  // namespace sixdof
