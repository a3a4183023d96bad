#include <sixdof/oracle/candidates.h>

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/oracle/overlap.h>

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
  find_swept_candidates(a.tree, b.tree, X_AB, displacement, swept);
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
  find_swept_candidates(torus.tree, torus.tree, X_AB, displacement, swept);
  std::vector<TrianglePair> selected, found;
  for (const double x : {0.1, 0.4, 0.9}) {
    select_candidates(swept, x, selected);
    find_candidates(torus.tree, torus.tree, moved(X_AB, x * displacement), found);
    EXPECT_LT(static_cast<double>(selected.size()), 1.2 * static_cast<double>(found.size())) << x;
    EXPECT_LT(selected.size(), swept.pairs.size());
  }
}

}  // namespace
}  // namespace sixdof
