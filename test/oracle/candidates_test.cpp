#include <sixdof/oracle/candidates.h>

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

namespace sixdof {
namespace {

using Eigen::Vector3d;

Pose moved(const Pose& X_AB, const Vector3d& by) { return {X_AB.R, X_AB.t + by}; }

/// At many fractions of the displacement: the selected pairs give the same bits as the pairs found at that pose.
/// Returns the number of crossings.
std::size_t expect_same_overlap(const bodies::Body& a, const bodies::Body& b, const Pose& X_AB,
                                const Vector3d& displacement) {
  SweptCandidates swept;
  CandidateScratch scratch;
  find_swept_candidates(a.tree, b.tree, X_AB, displacement, scratch, swept);
  EXPECT_EQ(swept.first.size(), swept.pairs.size());
  EXPECT_EQ(swept.last.size(), swept.pairs.size());
  OverlapQuery query(a.solid, b.solid);
  std::vector<TrianglePair> pairs;
  std::size_t crossings = 0;
  constexpr int k_fractions = 23;
  for (int i = 0; i <= k_fractions; ++i) {
    const double x = static_cast<double>(i) / k_fractions;
    const Pose pose = moved(X_AB, x * displacement);
    const Vector3d reference(0.1, -0.4, 0.2);
    const Overlap expected = query.evaluate(pose, reference);
    select_candidates(swept, x, pairs);
    const Overlap selected = query.evaluate(pose, reference, pairs);
    EXPECT_EQ(selected.crossings, expected.crossings) << x;
    EXPECT_EQ(selected.volume, expected.volume) << x;
    EXPECT_EQ(selected.area, expected.area) << x;
    EXPECT_EQ(selected.moment, expected.moment) << x;
    crossings += expected.crossings;
  }
  return crossings;
}

void expect_same_overlap_of_tori() {
  const bodies::Body torus(bodies::bumpy_torus(31, 17));
  const bodies::Body small(bodies::bumpy_torus(13, 9, 0.2, 0.6));
  std::mt19937_64 random(23);
  for (const auto& [a, b] : {std::pair(&torus, &small), std::pair(&small, &torus), std::pair(&torus, &torus)}) {
    std::size_t crossings = 0;
    for (int i = 0; i < 8; ++i) {
      const Pose X_AB = bodies::random_pose(random, 0.5);
      const Vector3d displacement = 0.4 * bodies::random_pose(random, 1.0).R.col(0);
      crossings += expect_same_overlap(*a, *b, X_AB, displacement);
    }
    EXPECT_GT(crossings, 0u);
  }
}

TEST(SweptCandidates, ContainThePairsOfEveryFractionOnEveryInstructionSet) {
  for_each_instruction_set(expect_same_overlap_of_tori);
}

TEST(SweptCandidates, ContainThemForDisplacementsAlongFaces) {
  const bodies::Body box(bodies::box({-0.5, -0.3, -0.4}, {0.5, 0.3, 0.4}));
  const bodies::Body other(bodies::box({-0.2, -0.6, -0.1}, {0.3, 0.2, 0.5}, true));
  const Pose X_AB{Eigen::Matrix3d::Identity(), Vector3d(0.25, 0.125, 0.0)};
  for (const Vector3d& displacement : {Vector3d(0.4, 0, 0), Vector3d(0, -0.3, 0), Vector3d(0, 0, 0.2),
                                       Vector3d(-0.2, 0.1, 0), Vector3d(1e-9, 0, 0), Vector3d(0, 0, 0)}) {
    EXPECT_GT(expect_same_overlap(box, other, X_AB, displacement), 0u);
    EXPECT_GT(expect_same_overlap(other, box, X_AB, displacement), 0u);
  }
}

TEST(SweptCandidates, AreFewAtOneFraction) {
  const bodies::Body torus(bodies::bumpy_torus(61, 31));
  std::mt19937_64 random(5);
  const Pose X_AB = bodies::random_pose(random, 0.5);
  const Vector3d displacement = 0.3 * Vector3d(2, -1, 1).normalized();
  SweptCandidates swept;
  CandidateScratch scratch;
  find_swept_candidates(torus.tree, torus.tree, X_AB, displacement, scratch, swept);
  std::vector<TrianglePair> selected, found;
  for (const double x : {0.1, 0.4, 0.9}) {
    select_candidates(swept, x, selected);
    find_candidates(torus.tree, torus.tree, moved(X_AB, x * displacement), scratch, found);
    EXPECT_LT(static_cast<double>(selected.size()), 1.2 * static_cast<double>(found.size())) << x;
    EXPECT_LT(selected.size(), swept.pairs.size());
  }
}

TEST(SweptCandidates, ComeInTheOrderOfThePairsAtOnePose) {
  // Large enough for hundreds of pairs of nodes to wait at a time.
  const bodies::Body a(bodies::bumpy_torus(121, 65)), b(bodies::bumpy_torus(91, 47, 0.2, 0.8));
  std::mt19937_64 random(25);
  std::size_t common = 0;
  for (int i = 0; i < 6; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.4);
    SweptCandidates swept;
    CandidateScratch scratch;
    find_swept_candidates(a.tree, b.tree, X_AB, 0.3 * X_AB.R.col(0), scratch, swept);
    std::vector<TrianglePair> found;
    find_candidates(a.tree, b.tree, moved(X_AB, 0.15 * X_AB.R.col(0)), scratch, found);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> place;
    for (const TrianglePair& pair : swept.pairs) place.emplace(std::pair(pair.a, pair.b), place.size());
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
      expect_same_overlap(*a, *b, X_AB, 0.3 * shapes::unit_vector(generator));
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
