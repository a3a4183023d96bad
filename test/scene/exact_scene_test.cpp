#include <sixdof/scene/exact_scene.h>

#include <string>

#include <sixdof/base/parallel.h>
#include <sixdof/scene/all_pairs.h>
#include <sixdof/scene/truth.h>
#include "small_scenes.h"

namespace sixdof::scene {
namespace {

/// Bodies of a family's test: enough that every family has pairs that touch and pairs that do not.
SceneNumbers numbers_of(std::string_view family) {
  SceneNumbers numbers{.bodies = 150, .frames = 12, .seed = 7};
  if (family == "pairs") numbers.bodies = 24;
  if (family == "robot") numbers.density = 0.5;
  return numbers;
}

class EveryFamily : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryFamily, HasTheBitsOfAllPairs) {
  const Scene scene = make_scene(GetParam(), numbers_of(GetParam()));
  for (const Question question : k_questions) {
    SCOPED_TRACE(to_string(question));
    const SceneAnswers truth = replay(scene, *make_all_pairs(), question);
    const SceneAnswers exact = replay(scene, *make_exact_scene(), question);
    for (std::size_t f = 0; f < truth.frames.size(); ++f) {
      ASSERT_EQ(exact.frames[f].pairs, truth.frames[f].pairs) << "frame " << f;
    }
    EXPECT_EQ(exact.hash, truth.hash);
    if (question == Question::near) {
      EXPECT_GT(truth.pairs(), 0u);
    }
  }
}

TEST_P(EveryFamily, HasTheSameBitsInAnyOrderOnAnyThreads) {
  const Scene scene = make_scene(GetParam(), numbers_of(GetParam()));
  for (const Question question : k_questions) {
    SCOPED_TRACE(to_string(question));
    std::string hash;
    for (const unsigned threads : {1u, 2u, 5u}) {
      parallel::with_threads(threads, [&] {
        const Scene order = shuffled(scene, threads);
        const std::string here = replay(order, *make_exact_scene(), question).hash;
        if (hash.empty()) hash = here;
        EXPECT_EQ(here, hash) << threads;
      });
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Families, EveryFamily,
                         ::testing::Values("cube", "pairs", "pile", "robot", "dust", "still", "all-move", "giant",
                                           "clusters", "shuffled"),
                         [](const auto& family) {
                           std::string name = family.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(ExactScene, KeepsTheAnswerWhileNothingMoves) {
  const Scene scene = make_scene("still", {.bodies = 200, .frames = 5});
  const auto query = make_exact_scene()->prepare(scene, Question::near);
  query->update({});
  const std::string hash = query->answer().hash();
  const SceneWork first = query->work();
  EXPECT_GT(first.candidates, 0u);
  for (int frame = 0; frame < 4; ++frame) {
    query->update({});
    EXPECT_EQ(query->answer().hash(), hash);
  }
  EXPECT_EQ(query->work().candidates, first.candidates);
  EXPECT_EQ(query->work().triangles, first.triangles);
}

TEST(ExactScene, PutsOffMostPairsThatMoveSlowly) {
  const Scene scene = make_scene("cube", {.bodies = 300, .frames = 30, .density = 0.3, .step = 1e-3, .seed = 2});
  const auto query = make_exact_scene()->prepare(scene, Question::near);
  for (const Frame& frame : scene.frames) {
    query->update(moves_of(frame));
    query->answer();
  }
  const SceneWork work = query->work();
  EXPECT_EQ(work.put_off + work.narrow, work.candidates);
  const SceneAnswers truth = replay(scene, *make_all_pairs(), Question::near);
  // The narrow phase is asked for pairs that are near, and for few others.
  EXPECT_LT(static_cast<double>(work.narrow), 1.5 * static_cast<double>(truth.pairs()) + 600.0);
  EXPECT_LT(work.candidates, 30u * scene.bodies.size() * scene.bodies.size() / 2 / 4);
}

TEST(ExactScene, FindsTheClosestPairAsItChanges) {
  Scene scene = row_of_spheres(5, 0.5, 0.0, 1, 0.0);
  // Body 10, the last one inserted, moves away from its neighbour, then onto it.
  for (const double x : {-3.0, 0.2, 0.6, -0.1})
    scene.frames.push_back({{4, RecordedPose::of(Eigen::Matrix3d::Identity(), {x, 0.1, -0.2})}});
  const SceneAnswers exact = replay(scene, *make_exact_scene(), Question::closest);
  EXPECT_EQ(exact.hash, replay(scene, *make_all_pairs(), Question::closest).hash);
  EXPECT_EQ(exact.frames[2].pairs.front().pair, (BodyPair{10, 11}));
  EXPECT_EQ(exact.frames[3].pairs.front().distance, 0.0);
  EXPECT_NE(exact.frames[1].pairs.front().pair.a, 10u);
}

TEST(ExactScene, AnswersWhereNoPairMatters) {
  Scene scene = row_of_spheres(4, -0.5, 0.0, 3, 1.0);
  for (Body& body : scene.bodies) body.fixed = true;
  for (Frame& frame : scene.frames) frame.clear();
  for (const Question question : k_questions) {
    const SceneAnswers exact = replay(scene, *make_exact_scene(), question);
    EXPECT_EQ(exact.pairs(), 0u);
    EXPECT_EQ(exact.hash, replay(scene, *make_all_pairs(), question).hash);
  }
}

TEST(ExactScene, LeavesOutIgnoredPairs) {
  Scene scene = row_of_spheres(4, -0.5, 0.0, 1, 0.0);  // neighbours overlap
  scene.ignored = {{11, 12}};
  const SceneAnswers exact = replay(scene, *make_exact_scene(), Question::touching);
  ASSERT_EQ(exact.frames[0].pairs.size(), 2u);
  EXPECT_EQ(exact.frames[0].pairs[0].pair, (BodyPair{10, 11}));
  EXPECT_EQ(exact.frames[0].pairs[1].pair, (BodyPair{12, 13}));
}

TEST(ExactScene, WrenchesOfASceneSumToZero) {
  const Scene scene = make_scene("pile", {.bodies = 60, .frames = 1, .seed = 3});
  const SceneAnswers exact = replay(scene, *make_exact_scene(), Question::wrenches);
  ASSERT_GT(exact.frames[0].wrenches.size(), 10u);
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();
  double scale = 0.0;
  for (const BodyWrench& wrench : exact.frames[0].wrenches) {
    const Body& body = scene.bodies[wrench.body];  // identifiers are indices here
    force += wrench.force;
    torque += wrench.torque + (body.pose.pose() * scene.meshes[body.mesh]->center()).cross(wrench.force);
    scale += wrench.force.norm();
  }
  EXPECT_GT(scale, 0.1);
  EXPECT_LT(force.norm(), 1e-12 * scale);
  EXPECT_LT(torque.norm(), 1e-10 * scale);
}

}  // namespace
}  // namespace sixdof::scene
