#include <sixdof/scene/kept_pairs.h>

#include <algorithm>
#include <set>

#include "small_scenes.h"

namespace sixdof::scene::detail {
namespace {

TEST(Bodies, MotionBoundsTheWayOfEveryVertex) {
  const Scene scene = make_scene("cube", {.bodies = 60, .frames = 20, .size_ratio = 10.0, .step = 0.3, .seed = 9});
  Bodies bodies(scene);
  double tightest = 0.0;
  for (const Frame& frame : scene.frames) {
    for (const Moved& moved : moves_of(frame)) {
      const std::uint32_t r = bodies.rank(moved.body);
      const Pose before = bodies.pose(r);
      const double bound = bodies.move(r, moved.X_WB);
      const Box& box = bodies.box(r);
      double farthest = 0.0;
      for (const Eigen::Vector3d& p : scene.meshes[scene.bodies[moved.body].mesh]->vertices()) {
        const Eigen::Vector3d q = moved.X_WB * p;
        farthest = std::max(farthest, (q - before * p).norm());
        ASSERT_TRUE((q.array() >= box.lower).all() && (q.array() <= box.upper).all());
      }
      ASSERT_LE(farthest, bound);
      tightest = std::max(tightest, farthest / bound);
    }
  }
  EXPECT_GT(tightest, 0.8);  // the bound is no wild guess
}

TEST(Bodies, LowerBoundIsNoLargerThanTheDistance) {
  const Scene scene = make_scene("cube", {.bodies = 40, .frames = 1, .density = 0.2, .size_ratio = 4.0});
  const Bodies bodies(scene);
  NearQuery query;
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    for (std::uint32_t j = i + 1; j < bodies.size(); ++j) {
      NearHint none;
      const auto d = query.distance(bodies.mesh(i), bodies.mesh(j), bodies.relative(i, j), NearQuery::k_no_limit, none);
      ASSERT_LE(bodies.lower_bound(i, j), *d);
    }
  }
}

TEST(BoxTree, FindsEveryPairThatMeets) {
  const Scene scene = make_scene("giant", {.bodies = 300, .frames = 2});
  const Bodies bodies(scene);
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < bodies.size(); ++i) boxes.push_back(bodies.box(i));
  BoxTree tree;
  const auto every = [](std::uint32_t, std::uint32_t) { return true; };
  const auto check = [&] {
    std::set<std::uint64_t> meeting;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
        if (boxes[i].meets(boxes[j])) meeting.insert(std::uint64_t{i} << 32 | j);
      }
    }
    const std::vector<std::uint64_t> found = tree.meeting_pairs(every);
    EXPECT_TRUE(std::ranges::is_sorted(found));
    const std::set<std::uint64_t> unique(found.begin(), found.end());
    EXPECT_EQ(unique.size(), found.size());
    EXPECT_TRUE(std::ranges::includes(unique, meeting));
    EXPECT_LE(found.size(), meeting.size() + 2);  // boxes are rounded outwards
    for (std::uint32_t i = 0; i < boxes.size(); i += 37) {
      std::size_t count = 0;
      tree.for_each_meeting(boxes[i], [&](std::uint32_t) { ++count; });
      std::size_t expected = 0;
      for (const Box& box : boxes) expected += box.meets(boxes[i]) ? 1 : 0;
      EXPECT_EQ(count, expected);
    }
  };
  tree.build(boxes);
  check();
  for (std::uint32_t i = 0; i < boxes.size(); i += 3) {
    boxes[i].lower += 2.5;
    boxes[i].upper += 2.5 + 0.1 * i / 300.0;
    tree.set(i, boxes[i]);
  }
  check();
}

TEST(KeptPairs, HaveEveryPairWithinTheReach) {
  for (const double moving : {1.0, 0.05}) {
    const Scene scene =
        make_scene("cube", {.bodies = 200, .frames = 25, .density = 0.05, .size_ratio = 5.0, .moving = moving});
    Bodies bodies(scene);
    Motions motions(bodies.size());
    KeptPairs kept(bodies);
    std::size_t near = 0, found = 0;
    for (std::uint32_t f = 0; f < scene.frames.size(); ++f) {
      std::vector<std::uint32_t> ranks;
      for (const Moved& moved : moves_of(scene.frames[f])) {
        ranks.push_back(bodies.rank(moved.body));
        motions.add(ranks.back(), bodies.move(ranks.back(), moved.X_WB), f + 1);
      }
      kept.update(bodies, motions, ranks, scene.margin);
      std::set<BodyPair> pairs;
      for (const KeptPair& pair : kept.pairs()) pairs.insert({pair.a, pair.b});
      ASSERT_EQ(pairs.size(), kept.pairs().size());
      found += pairs.size();
      for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        for (std::uint32_t j = i + 1; j < bodies.size(); ++j) {
          if (bodies.box(i).gap(bodies.box(j)) > scene.margin) continue;
          ++near;
          ASSERT_TRUE(pairs.contains({i, j})) << "frame " << f;
        }
      }
    }
    EXPECT_GT(near, 500u);
    EXPECT_LT(found, 6 * near);
  }
}

}  // namespace
}  // namespace sixdof::scene::detail
