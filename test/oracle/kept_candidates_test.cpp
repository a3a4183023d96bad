#include <sixdof/oracle/kept_candidates.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/oracle/overlap.h>

#include "bodies.h"
#include "instruction_sets.h"
#include "swept_pairs.h"

namespace sixdof {
namespace {

using bodies::Body;
using Eigen::Vector3d;

/// A pose that takes every point of B as far from where X_AB takes it as `length`, or less.
Pose near(std::mt19937_64& random, const Pose& X_AB, const Tree& b, double length) {
  const Vector3d axis = bodies::random_pose(random, 1.0).R.col(0), along = bodies::random_pose(random, 1.0).R.col(1);
  const double part = std::uniform_real_distribution<double>(0.0, 0.999)(random);
  const Eigen::AngleAxisd turn(part * length / b.radius(), axis);  // an arc is longer than its chord
  const Vector3d center = X_AB * b.center(), moved = center + (0.999 - part) * length * along;
  const Eigen::Matrix3d R = turn.toRotationMatrix() * X_AB.R;
  return {R, moved - R * b.center()};
}

/// Every pair that intersects at a pose within the margin is found, in the order of a search at that pose, whether the
/// search is done at once or in parts. Returns the largest number of them at one pose.
std::size_t expect_all_within(const Body& a, const Body& b, const Pose& X_AB, double margin, std::mt19937_64& random) {
  CandidateSearch whole, in_parts;
  whole.start(a.tree, b.tree, X_AB, margin);
  whole.advance(a.tree, b.tree, CandidateSearch::k_whole);
  EXPECT_TRUE(whole.is_complete());
  in_parts.start(a.tree, b.tree, X_AB, margin);
  std::size_t parts = 0;
  for (; !in_parts.is_complete(); ++parts) in_parts.advance(a.tree, b.tree, 3);
  EXPECT_EQ(parts, (in_parts.expansions + 2) / 3);
  std::size_t crossings = 0;
  for (int i = 0; i < 4; ++i) {
    const Pose pose = near(random, X_AB, b.tree, margin);
    CandidateScratch scratch;
    std::vector<TrianglePair> found;
    find_candidates(a.tree, b.tree, pose, scratch, found);
    const std::vector<TrianglePair> crossing = swept::crossings_among(a.tree, b.tree, pose, found);
    crossings = std::max(crossings, crossing.size());
    for (const CandidateSearch* search : {&whole, &in_parts}) {
      const auto next = [&, from = search->pairs.begin()](const TrianglePair& pair) mutable {
        from = std::find_if(from, search->pairs.end(), [&](TrianglePair x) { return x.a == pair.a && x.b == pair.b; });
        return from != search->pairs.end();
      };
      EXPECT_TRUE(std::all_of(crossing.begin(), crossing.end(), next));
    }
  }
  return crossings;
}

void expect_all_within_margins() {
  const Body torus(bodies::bumpy_torus(61, 33)), small(bodies::bumpy_torus(43, 25, 0.2, 0.6));
  std::mt19937_64 random(7);
  for (const auto& [a, b] : {std::pair(&torus, &small), std::pair(&small, &torus)}) {
    std::size_t crossings = 0;
    for (const double margin : {1e-9, 1e-4, 0.01, 0.1}) {
      for (int i = 0; i < 3; ++i) {
        const Pose X_AB = bodies::random_pose(random, 0.4);
        crossings += expect_all_within(*a, *b, X_AB, margin, random);
      }
    }
    EXPECT_GT(crossings, 500u);
  }
}

TEST(CandidateSearch, FindsWhatIntersectsWithinTheMarginOnEveryInstructionSet) {
  for_each_instruction_set(expect_all_within_margins);
}

TEST(CandidateSearch, FindsItWhereFloatsCannotTellVolumesApart) {
  // Both have a part far away, so that floats round their coordinates by more than a triangle's size.
  const auto with_far_part = [](const Mesh& mesh) {
    const Pose far{Eigen::Matrix3d::Identity(), Vector3d(1, 0.2, 0.1)};
    return bodies::together(mesh, bodies::moved(bodies::bumpy_sphere(1, 0.1, 4e-6), far));
  };
  const Body a(with_far_part(bodies::bumpy_torus(31, 17, 0.2, 4e-6)));
  const Body b(with_far_part(bodies::bumpy_torus(21, 13, 0.2, 3e-6)));
  std::mt19937_64 random(9);
  std::size_t crossings = 0;
  for (const double margin : {1e-9, 5e-8, 5e-7}) {
    for (int i = 0; i < 6; ++i) crossings += expect_all_within(a, b, bodies::random_pose(random, 1e-6), margin, random);
  }
  EXPECT_GT(crossings, 500u);
}

void expect_equal(const Overlap& x, const Overlap& y) {
  EXPECT_EQ(x.crossings, y.crossings);
  EXPECT_EQ(x.volume, y.volume);
  EXPECT_EQ(x.area, y.area);
  EXPECT_EQ(x.moment, y.moment);
  EXPECT_EQ(x.reference, y.reference);
  if (x.volume > 0.0) {
    EXPECT_EQ(x.centroid, y.centroid);
  }
}

/// Poses of a screw motion.
/// @param turn the share of a step that is rotation
std::vector<Pose> screw(std::mt19937_64& random, const Pose& X_AB, const Tree& b, double step, int count,
                        double turn = 0.5) {
  const Vector3d axis = bodies::random_pose(random, 1.0).R.col(0), along = bodies::random_pose(random, 1.0).R.col(1);
  const Vector3d center = X_AB * b.center();
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(turn * i * step / b.radius(), axis).toRotationMatrix() * X_AB.R;
    poses.push_back({R, center + (1.0 - turn) * i * step * along - R * b.center()});
  }
  return poses;
}

TEST(WarmStart, OfOverlapsChangesNoBit) {
  const Body torus(bodies::bumpy_torus(61, 33)), small(bodies::bumpy_torus(43, 25, 0.2, 0.6));
  const Body plate(bodies::box({-1, -1, -0.2}, {1, 1, 0.2})), block(bodies::box({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}));
  std::mt19937_64 random(11);
  for (const auto& [a, b] :
       {std::pair(&torus, &small), std::pair(&small, &torus), std::pair(&plate, &block), std::pair(&block, &torus)}) {
    OverlapQuery cold(a->solid, b->solid), warm(a->solid, b->solid);
    std::size_t crossings = 0;
    for (const double step : {0.0, 1e-12, 1e-6, 1e-4, 1e-3, 0.03, 0.3}) {
      std::vector<Pose> poses = screw(random, bodies::random_pose(random, 0.4), b->tree, step, 40);
      const std::vector<Pose> shifted = screw(random, bodies::random_pose(random, 0.4), b->tree, step, 40, 0.0);
      poses.insert(poses.end(), shifted.begin(), shifted.end());
      poses.insert(poses.end(), poses.rbegin(), poses.rend());  // there and back
      poses.push_back({Eigen::Matrix3d::Identity(), Vector3d(30, 0, 0)});
      poses.push_back({Eigen::Matrix3d::Identity(), Vector3d::Zero()});  // faces and edges in common
      for (const Pose& pose : poses) {
        const Overlap expected = cold.evaluate(pose);
        expect_equal(warm.evaluate(pose, true), expected);
        crossings += expected.crossings;
      }
    }
    EXPECT_GT(crossings, 1000u);
  }
}

/// Pairs of volumes that a search at one pose expands.
std::size_t expansions_at(const Body& a, const Body& b, const Pose& X_AB) {
  CandidateSearch search;
  search.start(a.tree, b.tree, X_AB, 0.0);
  search.advance(a.tree, b.tree, CandidateSearch::k_whole);
  return search.expansions;
}

class WarmStartOfFineMeshes : public ::testing::Test {
 protected:
  const Body a{bodies::bumpy_torus(301, 151)}, b{bodies::bumpy_torus(241, 121, 0.2, 0.8)};
  const double edge = 0.01;  ///< Of a triangle, about.
  std::mt19937_64 random{13};
};

TEST_F(WarmStartOfFineMeshes, SparesMostSearchesOfASlowMotionAndNoQueryDoesAWholeOne) {
  for (const auto& [step, share] : {std::pair(0.002, 0.1), {0.02, 0.3}}) {
    for (int k = 0; k < 3; ++k) {
      OverlapQuery warm(a.solid, b.solid);
      std::size_t cold_sum = 0, warm_sum = 0, least_cold = ~std::size_t{0}, most_warm = 0;
      int queries = 0;
      for (const Pose& pose : screw(random, bodies::random_pose(random, 0.3), b.tree, step * edge, 200)) {
        const std::size_t before = warm.warm_expansions();
        warm.evaluate(pose, true);
        if (++queries <= 2) continue;  // the first has no motion to know, and the second none to begin in time
        const std::size_t cold = expansions_at(a, b, pose), here = warm.warm_expansions() - before;
        cold_sum += cold;
        least_cold = std::min(least_cold, cold);
        warm_sum += here;
        most_warm = std::max(most_warm, here);
      }
      EXPECT_LT(static_cast<double>(warm_sum), share * static_cast<double>(cold_sum)) << step;
      EXPECT_LT(2 * most_warm, least_cold) << step;
    }
  }
}

TEST_F(WarmStartOfFineMeshes, DoesWhatAColdOneDoesWherePosesAreFarApart) {
  OverlapQuery warm(a.solid, b.solid);
  std::size_t cold_sum = 0;
  for (int i = 0; i < 20; ++i) {
    const Pose pose = bodies::random_pose(random, 0.4);
    warm.evaluate(pose, true);
    cold_sum += expansions_at(a, b, pose);
  }
  EXPECT_EQ(warm.warm_expansions(), cold_sum);
}

TEST_F(WarmStartOfFineMeshes, TurnsBackWithoutHarm) {
  // Every turn makes a search ahead useless; it costs no more than it is worth.
  OverlapQuery warm(a.solid, b.solid);
  const std::vector<Pose> poses = screw(random, bodies::random_pose(random, 0.3), b.tree, 0.01 * edge, 40);
  std::size_t cold_sum = 0;
  for (int i = 0; i < 400; ++i) {
    const int place = i % 78 < 40 ? i % 78 : 78 - i % 78;
    warm.evaluate(poses[static_cast<std::size_t>(place)], true);
    cold_sum += expansions_at(a, b, poses[static_cast<std::size_t>(place)]);
  }
  EXPECT_LT(static_cast<double>(warm.warm_expansions()), 0.4 * static_cast<double>(cold_sum));
}

/// A box whose faces are grids of n by n squares.
Mesh grid_box(const Vector3d& low, const Vector3d& high, std::uint32_t n) {
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> numbers;
  std::vector<Vector3d> points;
  const auto number_of = [&](const std::array<std::uint32_t, 3>& at) {
    const auto [found, is_new] = numbers.emplace(at, static_cast<std::uint32_t>(points.size()));
    if (is_new) points.push_back(low + (high - low).cwiseProduct(Vector3d(at[0], at[1], at[2])) / n);
    return found->second;
  };
  std::vector<Triangle> triangles;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
          const auto corner = [&](std::uint32_t u, std::uint32_t v) {
            std::array<std::uint32_t, 3> at{};
            at[axis] = upper ? n : 0;
            at[(axis + 1) % 3] = i + (upper ? u : v);
            at[(axis + 2) % 3] = j + (upper ? v : u);
            return number_of(at);
          };
          triangles.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
          triangles.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
        }
      }
    }
  }
  return Mesh::build(std::move(points), std::move(triangles), "grid box");
}

TEST(KeptCandidates, GiveUpAMarginThatFlushFacesFill) {
  // A plate slides over another at a distance that a margin contains, and a peg of it through the other.
  const Body a(grid_box({-1, -1, -0.2}, {1, 1, 0}, 32));
  const Body b(bodies::together(grid_box({-0.8, -0.8, 5e-4}, {0.8, 0.8, 0.2}, 32),
                                grid_box({0.855, 0.05, -0.1}, {0.955, 0.15, 0.1}, 8)));
  detail::KeptCandidates kept;
  CandidateScratch scratch;
  std::vector<TrianglePair> found;
  std::size_t most = 0, sum = 0, without = 0, crossings = 0;
  for (int i = 0; i < 150; ++i) {
    const Pose pose{Eigen::Matrix3d::Identity(), 4e-4 * i * Vector3d(0.6, 0.8, 0.0)};
    const auto pairs = kept.at(a.tree, b.tree, pose);
    find_candidates(a.tree, b.tree, pose, scratch, found);
    crossings = swept::crossings_among(a.tree, b.tree, pose, found).size();
    EXPECT_EQ(swept::crossings_among(a.tree, b.tree, pose, {pairs.begin(), pairs.end()}).size(), crossings);
    kept.count_crossings(crossings);
    most = std::max(most, pairs.size());
    sum += pairs.size();
    without += found.size();
  }
  EXPECT_GT(crossings, 20u);
  EXPECT_LT(most, 8 * without / 150) << "62 times as many without giving up";
  EXPECT_LT(sum, 2 * without);
}

}  // namespace
}  // namespace sixdof
