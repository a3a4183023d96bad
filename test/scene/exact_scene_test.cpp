#include <sixdof/scene/exact_scene.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/base/parallel.h>
#include <sixdof/scene/all_pairs.h>
#include <sixdof/scene/score.h>
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

Scene deforming(std::string_view family, double amplitude) {
  return make_scene(family, {.frames = 14, .amplitude = amplitude, .triangles = 1200, .seed = 7});
}

class EveryDeformingFamily : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryDeformingFamily, HasTheBitsOfAllPairsByEveryUpdate) {
  for (const double amplitude : {0.003, 0.1, 0.3}) {
    SCOPED_TRACE(amplitude);
    const Scene scene = deforming(GetParam(), amplitude);
    for (const Question question : {Question::touching, Question::near, Question::closest}) {
      SCOPED_TRACE(to_string(question));
      const SceneAnswers truth = replay(scene, *make_all_pairs(), question);
      if (amplitude == 0.1 || question != Question::touching) {
        EXPECT_GT(truth.pairs(), 0u);
      }
      for (const MeshUpdate update : {MeshUpdate::rule, MeshUpdate::refit, MeshUpdate::rebuild}) {
        const SceneAnswers exact = replay(scene, *make_exact_scene(update), question);
        for (std::size_t f = 0; f < truth.frames.size(); ++f) {
          ASSERT_EQ(exact.frames[f].pairs, truth.frames[f].pairs) << "frame " << f;
        }
        EXPECT_EQ(exact.hash, truth.hash);
      }
    }
  }
}

TEST_P(EveryDeformingFamily, HasTheSameBitsOnAnyThreads) {
  const Scene scene = deforming(GetParam(), 0.1);
  std::string hash;
  for (const unsigned threads : {1u, 3u}) {
    parallel::with_threads(threads, [&] {
      const std::string here = replay(shuffled(scene, threads), *make_exact_scene(), Question::near).hash;
      if (hash.empty()) hash = here;
      EXPECT_EQ(here, hash) << threads;
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Families, EveryDeformingFamily, ::testing::Values("wave", "twist", "cloth", "bump", "crumple"),
                         [](const auto& family) { return family.param; });

TEST(ExactScene, WrenchesOfBodiesThatDeformHaveTheBitsOfAllPairs) {
  const Scene scene = deforming("bump", 0.1);
  const SceneAnswers truth = replay(scene, *make_all_pairs(), Question::wrenches);
  EXPECT_GT(truth.pairs(), 0u);
  EXPECT_EQ(replay(scene, *make_exact_scene(), Question::wrenches).hash, truth.hash);
}

TEST(ExactScene, FollowsBodiesThatShareAMeshAndAreFarApart) {
  // Two spheres of one mesh breathe, one of them flies away: beyond 50 diameters distances depend on the tree.
  Scene scene = row_of_spheres(3, 0.5, 40.0, 8, 0.4);
  scene.deformations.resize(8);
  for (std::size_t f = 1; f < 8; ++f) {
    std::vector<Eigen::Vector3d> vertices = scene.meshes[0]->vertices();
    for (Eigen::Vector3d& p : vertices) p *= 1.0 + 0.05 * static_cast<double>(f) * std::sin(3.0 * p.x());
    scene.deformations[f].push_back({0, std::make_shared<const std::vector<Eigen::Vector3d>>(vertices)});
  }
  scene.check();
  for (const double margin : {0.4, 400.0}) {
    scene.margin = margin;
    for (const Question question : {Question::touching, Question::near, Question::closest}) {
      EXPECT_EQ(replay(scene, *make_exact_scene(), question).hash, replay(scene, *make_all_pairs(), question).hash);
    }
  }
}

TEST(ExactScene, SeesThatABodyBecomesInsideOut) {
  // A small sphere rests inside a large one that is turned inside out: then it is inside no body.
  Scene scene;
  scene.meshes.push_back(std::make_shared<const Mesh>(make_sphere({.radius = 1.0}, 320)));
  scene.meshes.push_back(std::make_shared<const Mesh>(make_sphere({.radius = 0.1}, 80)));
  scene.bodies = {{1, 0, false, {}}, {2, 1, false, {}}};
  scene.frames.resize(3);
  scene.deformations.resize(3);
  std::vector<Eigen::Vector3d> vertices = scene.meshes[0]->vertices();
  for (Eigen::Vector3d& p : vertices) p.x() = -p.x();
  scene.deformations[1].push_back({0, std::make_shared<const std::vector<Eigen::Vector3d>>(vertices)});
  scene.check();
  const SceneAnswers exact = replay(scene, *make_exact_scene(), Question::touching);
  EXPECT_EQ(exact.frames[0].pairs.size(), 1u);
  EXPECT_EQ(exact.frames[1].pairs.size(), 0u);
  EXPECT_EQ(exact.hash, replay(scene, *make_all_pairs(), Question::touching).hash);
}

/// A planted error: updates forget one vertex, which stays where it was at the start.
class StaleVertex final : public SceneQuery {
 public:
  StaleVertex(const Scene& scene, Question question, std::uint32_t vertex)
      : rest_(scene.meshes[0]->vertices()[vertex]),
        vertex_(vertex),
        query_(make_exact_scene()->prepare(scene, question)) {}
  void deform(std::span<const Deformed> deformed) override {
    if (deformed.empty()) return;
    vertices_.assign(deformed[0].vertices.begin(), deformed[0].vertices.end());
    vertices_[vertex_] = rest_;
    const Deformed stale{0, vertices_};
    query_->deform(std::span(&stale, 1));
  }
  void update(std::span<const Moved> moved) override { query_->update(moved); }
  const SceneAnswer& answer() override { return query_->answer(); }

 private:
  const Eigen::Vector3d rest_;
  const std::uint32_t vertex_;
  std::vector<Eigen::Vector3d> vertices_;
  std::unique_ptr<SceneQuery> query_;
};

TEST(ExactScene, AnUpdateThatForgetsAVertexIsCaught) {
  const Scene scene = make_scene("bump", {.frames = 14, .margin = 0.3, .amplitude = 0.3, .triangles = 320, .seed = 7});
  // The vertex that travels farthest is the top of the bump, which meets the ball above.
  const auto& rest = scene.meshes[0]->vertices();
  const auto& last = *scene.deformations.back()[0].vertices;
  std::uint32_t top = 0;
  for (std::uint32_t i = 0; i < rest.size(); ++i) {
    if ((last[i] - rest[i]).norm() > (last[top] - rest[top]).norm()) top = i;
  }
  const auto stale = make_scene_algorithm<StaleVertex>({.name = "stale",
                                                        .version = "1",
                                                        .summary = "forgets a vertex",
                                                        .answers = {Question::near},
                                                        .own = true,
                                                        .deforms = true},
                                                       top);
  const SceneAnswers truth = replay(scene, *make_all_pairs(), Question::near);
  const Play play = scene::play(scene, *stale, Question::near, truth);
  EXPECT_FALSE(play.score.same_bits);
  EXPECT_GT(play.score.largest_error, 1e-3);
  const Play right = scene::play(scene, *make_exact_scene(), Question::near, truth);
  EXPECT_TRUE(right.score.same_bits);
  EXPECT_GT(right.timing.update_us, 0.0);
  EXPECT_NEAR(right.timing.update_us + right.timing.answer_us, right.timing.processor_us,
              1e-9 * right.timing.processor_us);
}

TEST(ExactScene, WhoTakesNoMeshThatDeformsSaysSo) {
  const Scene scene = deforming("wave", 0.1);
  const auto rigid = make_scene_algorithm<StaleVertex>(
      {.name = "rigid", .version = "1", .summary = "none", .answers = {Question::near}}, 0u);
  EXPECT_EQ(message_of<BadArgument>([&] { rigid->prepare(scene, Question::near); }),
            "rigid does not take scenes in which a mesh deforms");
}

}  // namespace
}  // namespace sixdof::scene
