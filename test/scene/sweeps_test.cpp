#include <sixdof/scene/sweeps.h>

#include <algorithm>

#include <sixdof/generation/impact_truth.h>
#include <sixdof/scene/all_pairs.h>
#include <sixdof/scene/exact_scene.h>
#include <sixdof/scene/truth.h>
#include "small_scenes.h"

namespace sixdof::scene {
namespace {

/// A contact ends where surfaces are within Sweeps::k_touching of the radii; motions here are a few radii long.
constexpr double k_close = 1e-8;

/// Two spheres of radius 1 whose gap is 1; the first moves by `step` towards the second, and through it.
Scene approach(double step) { return row_of_spheres(2, 1.0, step, 2, 0.0); }

TEST(Sweeps, AContactBetweenFramesIsThatOfTheMotion) {
  const Scene scene = approach(2.5);
  const SceneAnswers impacts = replay(scene, *make_exact_scene(), Question::impacts);
  EXPECT_TRUE(impacts.frames[0].pairs.empty()) << "nothing comes before the first frame";
  ASSERT_EQ(impacts.frames[1].pairs.size(), 1u);
  const NearPair& found = impacts.frames[1].pairs.front();
  EXPECT_EQ(found.pair, (BodyPair{10, 11}));
  const Mesh& mesh = *scene.meshes[0];
  const Pose X_WA = scene.bodies[0].pose.pose(), X_WB = scene.bodies[1].pose.pose();  // bodies 11 and 10
  const Pose start = X_WA.inverse() * X_WB;
  const TrueImpact truth =
      ImpactTruth(mesh, mesh)
          .find(sixdof::Motion::of(mesh, start, X_WA.R.transpose() * Eigen::Vector3d(2.5, 0.0, 0.0)));
  ASSERT_EQ(truth.bracket.kind, ImpactBracket::Kind::hit);
  EXPECT_NEAR(found.distance, truth.bracket.t_touch, k_close);
}

TEST(Sweeps, ABodyThatPassesThroughAnotherIsSeen) {
  const Scene scene = approach(8.0);
  EXPECT_EQ(replay(scene, *make_all_pairs(), Question::touching).pairs(), 0u) << "in no frame";
  const SceneAnswers impacts = replay(scene, *make_all_pairs(), Question::impacts);
  ASSERT_EQ(impacts.frames[1].pairs.size(), 1u);
  // The gap of the spheres is 1, that of their facets a little more.
  EXPECT_NEAR(impacts.frames[1].pairs.front().distance, 1.0 / 8.0, 0.02);
}

TEST(Sweeps, BodiesThatTouchAlreadyOrMoveApartMeetNoMore) {
  EXPECT_EQ(replay(approach(-2.0), *make_exact_scene(), Question::impacts).pairs(), 0u);
  EXPECT_EQ(replay(approach(0.9), *make_exact_scene(), Question::impacts).pairs(), 0u) << "they stop before";
  const Scene overlapping = row_of_spheres(2, -0.5, 0.2, 4, 0.0);
  EXPECT_EQ(replay(overlapping, *make_exact_scene(), Question::impacts).pairs(), 0u);
  const Scene longer = row_of_spheres(2, 1.0, 0.6, 4, 0.0);  // meets in the second step, and stays in contact
  const SceneAnswers impacts = replay(longer, *make_exact_scene(), Question::impacts);
  EXPECT_EQ(impacts.frames[1].pairs.size(), 0u);
  EXPECT_EQ(impacts.frames[2].pairs.size(), 1u);
  EXPECT_EQ(impacts.frames[3].pairs.size(), 0u);
}

TEST(Sweeps, CountsWhatItDoesNotDecide) {
  // A box slides along the top of another, at a gap of a millionth of its way: each step is one gap long.
  Scene scene;
  scene.meshes.push_back(std::make_shared<const Mesh>(make_box({.size = {1.0, 1.0, 1.0}}, 12)));
  const auto at = [](double x, double z) { return RecordedPose::of(Eigen::Matrix3d::Identity(), {x, 0.1, z}); };
  scene.bodies = {{1, 0, true, {}}, {2, 0, false, at(-0.4, 1.0 + 5e-7)}};
  scene.frames.resize(2);
  scene.frames[1].push_back({1, at(0.1, 1.0 + 5e-7)});
  scene.check();
  for (const auto& algorithm : {make_exact_scene(), make_all_pairs()}) {
    const auto query = algorithm->prepare(scene, Question::impacts);
    for (const Frame& frame : scene.frames) {
      query->update(moves_of(frame));
      EXPECT_TRUE(query->answer().pairs.empty());
    }
    EXPECT_EQ(query->work().undecided, 1u) << algorithm->traits().name;
  }
}

/// Pairs of the cube's bodies, which all move and turn, against poses between the frames.
TEST(Sweeps, AgreesWithPosesBetweenFrames) {
  const Scene scene = make_scene("all-move", {.bodies = 40, .frames = 3, .seed = 5});
  detail::Bodies bodies(scene);
  detail::Sweeps sweeps(scene, bodies);
  NearQuery query;
  std::size_t hits = 0, misses = 0;
  const auto is_nested_at_first = [&](const std::vector<sixdof::Motion>& motions, std::uint32_t a, std::uint32_t b) {
    return query.is_nested(bodies.mesh(a), bodies.mesh(b), motions[a].start.inverse() * motions[b].start);
  };
  for (std::size_t f = 1; f < scene.frames.size(); ++f) {
    sweeps.clear();
    std::vector<sixdof::Motion> motions(bodies.size());
    for (std::uint32_t rank = 0; rank < bodies.size(); ++rank) motions[rank].start = bodies.pose(rank);
    for (const Moved& each : moves_of(scene.frames[f])) {
      const std::uint32_t rank = bodies.rank(each.body);
      sweeps.add(bodies, rank, each.X_WB);
      const Pose from = bodies.pose(rank);
      const Eigen::Vector3d center = scene.meshes[bodies.mesh_index(rank)]->center();
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(each.X_WB.R * from.R.transpose()));
      motions[rank] = {from, each.X_WB * center - from * center, turn.angle() * turn.axis(), center};
      bodies.move(rank, each.X_WB);
    }
    const auto distance = [&](std::uint32_t a, std::uint32_t b, double t) {
      NearHint none;
      const Pose X_AB = motions[a].pose_at(t).inverse() * motions[b].pose_at(t);
      return *query.distance(bodies.mesh(a), bodies.mesh(b), X_AB, NearQuery::k_no_limit, none);
    };
    for (std::uint32_t a = 0; a < bodies.size(); ++a) {
      for (std::uint32_t b = a + 1; b < bodies.size(); ++b) {
        if (distance(a, b, 0.0) == 0.0 || is_nested_at_first(motions, a, b)) continue;
        const auto found = sweeps.first_contact(bodies, query, a, b);
        EXPECT_FALSE(found.undecided);
        const std::optional<double> t = found.t;
        double least = 1.0;
        for (int i = 0; i < 20; ++i) least = std::min(least, distance(a, b, t.value_or(1.0) * i / 20.0));
        EXPECT_GT(least, 0.0) << "before the contact";
        if (t) {
          EXPECT_LT(distance(a, b, *t), k_close * (bodies.radius(a) + bodies.radius(b)));
        }
        ++(t ? hits : misses);
      }
    }
  }
  EXPECT_GT(hits, 0u);
  EXPECT_GT(misses, 100u);
}

TEST(Sweeps, SkipsWhatCannotMeet) {
  const Scene scene = make_scene("cube", {.bodies = 200, .frames = 4, .seed = 3});
  const auto work_of = [&](const SceneAlgorithm& algorithm) {
    const auto query = algorithm.prepare(scene, Question::impacts);
    for (const Frame& frame : scene.frames) {
      query->update(moves_of(frame));
      static_cast<void>(query->answer());
    }
    return query->work().narrow;
  };
  EXPECT_LE(work_of(*make_exact_scene()), work_of(*make_all_pairs()));
  EXPECT_LT(work_of(*make_all_pairs()), 200u * 199u / 2u * 3u / 4u) << "of all pairs in three frames";
}

}  // namespace
}  // namespace sixdof::scene
