#include <sixdof/scene/truth.h>

#include <algorithm>
#include <array>

#include <sixdof/oracle/distance.h>
#include <sixdof/scene/all_pairs.h>
#include "small_scenes.h"

namespace sixdof::scene {
namespace {

/// Spheres that overlap in a row, turned without a trigonometric function: the scene has the same bits everywhere.
Scene overlapping_spheres() {
  Scene scene = row_of_spheres(4, -0.125, 0.25, 3, 0.5);
  const auto turn = [](RecordedPose& pose, std::uint32_t body) {
    const double sign = body % 2 == 0 ? 1.0 : -1.0;
    std::ranges::copy(std::array{0.8, 0.36, sign * 0.48, 0.0}, pose.numbers.begin());
  };
  for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) turn(scene.bodies[i].pose, i);
  for (Frame& frame : scene.frames) {
    for (Motion& motion : frame) turn(motion.pose, motion.body);
  }
  return scene;
}

// The cache on disk must not mix answers of two programs: algorithms of this project are asked for the truth's bits.
TEST(Truth, ItsBitsBelongToItsVersion) {
  const Scene scene = overlapping_spheres();
  const SceneAnswers truth = replay(scene, *make_all_pairs(), Question::wrenches);
  EXPECT_EQ(truth.pairs(), 9u);
  EXPECT_EQ(std::pair(k_truth_version, truth.hash), std::pair(8, std::string("67732e2cfb16e3a548127e245f65bd1e")))
      << "answers have other bits: raise k_truth_version, and name it and the new hash here";
}

/// A ball of radius 0.25 that goes along the x axis through a ball of radius 1 about the origin and out again.
Scene ball_through_a_ball() {
  Scene scene = row_of_spheres(1, 0.0, 0.0, 1, 0.1);
  scene.meshes.push_back(std::make_shared<const Mesh>(make_sphere({.radius = 0.25}, 80)));
  const auto at = [](double x) { return RecordedPose{{0.8, 0.36, 0.48, 0.0, x, 0.11, -0.19}}; };
  scene.bodies.push_back({77, 1, false, at(-1.6)});
  for (int f = 1; f <= 32; ++f) scene.frames.push_back({{1, at(-1.6 + 0.1 * f)}});
  return scene;
}

TEST(Truth, BodiesInsideOthersTouchThemAsTheOracleOfPairsHasIt) {
  const Scene scene = ball_through_a_ball();
  const SceneAnswers touching = replay(scene, *make_all_pairs(), Question::touching);
  DistanceOracle oracle(*scene.meshes[0], *scene.meshes[1]);
  DistanceQuery query(oracle);
  const Pose X_WA = scene.bodies[0].pose.pose();
  std::size_t apart = 0, met = 0, nested = 0;
  for (std::size_t f = 0; f < scene.frames.size(); ++f) {
    const RecordedPose& pose = f == 0 ? scene.bodies[1].pose : scene.frames[f][0].pose;
    const Pose X_AB = X_WA.inverse() * pose.pose();
    const bool collide = query.collide(X_AB);
    EXPECT_EQ(touching.frames[f].pairs.size(), collide ? 1u : 0u) << "frame " << f;
    const double distance = query.distance(X_AB).distance;
    ++(!collide ? apart : distance == 0.0 ? met : nested);
  }
  EXPECT_GT(apart, 4u);
  EXPECT_GT(met, 4u);
  EXPECT_GT(nested, 4u);
  // Distances are those of surfaces.
  const SceneAnswers near = replay(scene, *make_all_pairs(), Question::near);
  EXPECT_LT(near.pairs(), touching.pairs());
}

TEST(Truth, ABodyInsideAnOpenMeshDoesNotTouchIt) {
  Scene scene = ball_through_a_ball();
  const Mesh& closed = *scene.meshes[0];
  std::vector<Triangle> open(closed.triangles().begin(), closed.triangles().end() - 1);
  scene.meshes[0] = std::make_shared<const Mesh>(Mesh::build(closed.vertices(), open));
  const std::size_t of_surfaces = replay(scene, *make_all_pairs(), Question::touching).pairs();
  EXPECT_GT(of_surfaces, 4u);
  EXPECT_LT(of_surfaces, replay(ball_through_a_ball(), *make_all_pairs(), Question::touching).pairs());
}

}  // namespace
}  // namespace sixdof::scene
