#include <sixdof/oracle/crossing_parts.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <random>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/oracle/overlap.h>

#include "bodies.h"
#include "instruction_sets.h"
#include "swept_pairs.h"

namespace sixdof {
namespace {

using bodies::Body;
using Eigen::Vector3d;

/// All pairs that the parts give, and in how many pieces.
struct Given {
  std::vector<TrianglePair> pairs;
  std::size_t pieces = 0, decided = 0;

  Given(detail::CrossingParts& parts, const Body& a, const Body& b, const Pose& X_AB) {
    for (detail::PairPiece piece = parts.next(); !piece.pairs.empty(); piece = parts.next()) {
      pairs.insert(pairs.end(), piece.pairs.begin(), piece.pairs.end());
      ++pieces;
      if (!piece.intersect) continue;
      ++decided;
      const std::vector<TrianglePair> these(piece.pairs.begin(), piece.pairs.end());
      EXPECT_EQ(swept::crossings_among(a.tree, b.tree, X_AB, these).size(), these.size());
    }
    EXPECT_TRUE(parts.next().pairs.empty());
  }
};

/// The pairs that intersect come in the order of find_candidates(), whoever searches.
Given expect_order_of_one_search(const Body& a, const Body& b, const Pose& X_AB, detail::CrossingParts& parts) {
  CandidateScratch scratch;
  std::vector<TrianglePair> found;
  find_candidates(a.tree, b.tree, X_AB, scratch, found);
  const auto expected = swept::crossings_among(a.tree, b.tree, X_AB, found);
  const auto expect_same = [&](const Given& given) {
    // As selective as one search, but that each thread learns by itself which axes pay.
    EXPECT_LE(given.pairs.size(), 2 * found.size() + 64);
    const auto crossing = swept::crossings_among(a.tree, b.tree, X_AB, given.pairs);
    ASSERT_EQ(crossing.size(), expected.size());
    for (std::size_t i = 0; i < crossing.size(); ++i) {
      EXPECT_EQ(std::pair(crossing[i].a, crossing[i].b), std::pair(expected[i].a, expected[i].b));
    }
  };
  parts.start(a.solid, b.solid, X_AB);
  const Given alone(parts, a, b, X_AB);
  expect_same(alone);
  parts.start(a.solid, b.solid, X_AB);
  parts.help();  // does all
  const Given after(parts, a, b, X_AB);
  expect_same(after);
  EXPECT_EQ(after.pieces, alone.pieces);
  parts.start(a.solid, b.solid, X_AB);
  {
    std::vector<std::jthread> helpers;
    for (int i = 0; i < 3; ++i) helpers.emplace_back([&] { parts.help(); });
    expect_same(Given(parts, a, b, X_AB));
  }
  return alone;
}

TEST(CrossingParts, GiveTheOrderOfOneSearch) {
  const Body torus(bodies::bumpy_torus(121, 65)), small(bodies::bumpy_torus(43, 25, 0.2, 0.6));
  for_each_instruction_set([&] {
    std::mt19937_64 random(5);
    detail::CrossingParts parts;
    std::size_t most = 0;
    for (int i = 0; i < 6; ++i) {
      const Pose X_AB = bodies::random_pose(random, 0.4);
      most = std::max(most, expect_order_of_one_search(torus, small, X_AB, parts).pieces);
      most = std::max(most, expect_order_of_one_search(small, torus, X_AB.inverse(), parts).pieces);
    }
    EXPECT_GT(most, 16u);
  });
}

TEST(CrossingParts, WithManyCandidatesAreDecidedWhereTheyAreSearched) {
  const Body torus(bodies::bumpy_torus(61, 33));
  detail::CrossingParts parts;
  const Pose flush{Eigen::Matrix3d::Identity(), Vector3d::Zero()};
  EXPECT_GT(expect_order_of_one_search(torus, torus, flush, parts).decided, 8u);
  const Pose generic{Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix(), {0.4, 0.1, 0.0}};
  EXPECT_EQ(expect_order_of_one_search(torus, torus, generic, parts).decided, 0u);
}

TEST(CrossingParts, AreOneWhereTreesAreTooSmallToDivide) {
  const Body a(bodies::box({-0.51, -0.32, -0.43}, {0.37, 0.61, 0.29}));
  const Body b(bodies::box({-0.33, -0.42, -0.23}, {0.47, 0.31, 0.39}, true));
  std::mt19937_64 random(6);
  detail::CrossingParts parts;
  for (int i = 0; i < 20; ++i) {
    EXPECT_LE(expect_order_of_one_search(a, b, bodies::random_pose(random, 0.4), parts).pieces, 1u);
  }
}

/// Every bit of an answer; its members fill it.
bool are_same(const Overlap& x, const Overlap& y) { return std::memcmp(&x, &y, sizeof(Overlap)) == 0; }

/// Several threads give the bits of one. Returns the crossings.
std::size_t expect_same_bits(const Body& a, const Body& b, const std::vector<Pose>& poses) {
  OverlapQuery alone(a.solid, b.solid);
  std::size_t crossings = 0;
  for (const unsigned threads : {2u, 3u, 8u}) {
    OverlapQuery query(a.solid, b.solid, threads);
    for (const Pose& X_AB : poses) {
      const Overlap expected = alone.evaluate(X_AB);
      crossings += expected.crossings;
      EXPECT_TRUE(are_same(query.evaluate(X_AB), expected)) << threads << " threads";
    }
  }
  return crossings;
}

TEST(ThreadsOfAnOverlap, GiveTheBitsOfOneThread) {
  const Body torus(bodies::bumpy_torus(121, 65)), sphere(bodies::bumpy_sphere(4));
  std::mt19937_64 random(7);
  std::vector<Pose> poses;
  for (int i = 0; i < 30; ++i) poses.push_back(bodies::random_pose(random, 0.6));
  poses.push_back({Eigen::Matrix3d::Identity(), Vector3d::Zero()});     // ties
  poses.push_back({Eigen::Matrix3d::Identity(), Vector3d(0, 0, 1.5)});  // boxes that meet, surfaces that do not
  poses.push_back({Eigen::Matrix3d::Identity(), Vector3d(9, 9, 9)});    // apart
  EXPECT_GT(expect_same_bits(torus, sphere, poses), 1000u);
  EXPECT_GT(expect_same_bits(sphere, torus, poses), 1000u);
  EXPECT_GT(expect_same_bits(torus, torus, poses), 1000u);
}

TEST(ThreadsOfAnOverlap, LeaveAWarmStartAsItIs) {
  const Body torus(bodies::bumpy_torus(121, 65)), sphere(bodies::bumpy_sphere(4));
  OverlapQuery alone(torus.solid, sphere.solid), query(torus.solid, sphere.solid, 2);
  std::size_t crossings = 0;
  for (int i = 0; i < 50; ++i) {
    const Pose X_AB{Eigen::AngleAxisd(0.001 * i, Vector3d(1, 2, 3).normalized()).toRotationMatrix(),
                    Vector3d(0.4 + 0.0002 * i, 0.1, 0.0)};
    const Overlap expected = alone.evaluate(X_AB);
    EXPECT_TRUE(are_same(query.evaluate(X_AB, i % 3 != 0), expected));
    crossings += expected.crossings;
  }
  EXPECT_GT(crossings, 1000u);
}

TEST(ThreadsOfAnOverlap, RefusePosesThatAreNotFinite) {
  const Body torus(bodies::bumpy_torus(31, 17));
  OverlapQuery query(torus.solid, torus.solid, 2);
  Pose X_AB;
  X_AB.t.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(query.evaluate(X_AB), BadArgument);
  X_AB.t.x() = 0.2;
  EXPECT_THROW(query.evaluate(X_AB, Vector3d(0, std::numeric_limits<double>::infinity(), 0)), BadArgument);
  EXPECT_GT(query.evaluate(X_AB).crossings, 0u);
}

}  // namespace
}  // namespace sixdof
