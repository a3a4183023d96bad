#include <algorithm>
#include <cmath>
#include <string>

#include <sixdof/scene/families.h>

#include "small_scenes.h"

namespace sixdof::scene {
namespace {

/// Rounding of a displacement of the size of the mesh.
constexpr double k_rounding = 1e-12;

class DeformingFamily : public ::testing::TestWithParam<std::string> {
 protected:
  static SceneNumbers numbers(double amplitude) {
    return {.frames = 6, .amplitude = amplitude, .triangles = 800, .seed = 5};
  }
};

/// Of all vertices in all frames, in diagonals of the mesh.
double largest_displacement(const Scene& scene) {
  const Mesh& rest = *scene.meshes.front();
  double largest = 0.0;
  for (const auto& frame : scene.deformations) {
    for (const Deformation& deformation : frame) {
      for (std::size_t i = 0; i < rest.vertices().size(); ++i) {
        largest = std::max(largest, ((*deformation.vertices)[i] - rest.vertices()[i]).norm());
      }
    }
  }
  return largest / rest.diagonal();
}

TEST_P(DeformingFamily, IsSeededAndDeformsOneMeshInEveryFrame) {
  const Scene scene = make_scene(GetParam(), numbers(0.03));
  EXPECT_EQ(scene.name, GetParam());
  EXPECT_TRUE(scene.deforms());
  EXPECT_TRUE(scene.deforms(0));
  EXPECT_FALSE(scene.deforms(1));
  EXPECT_EQ(scene.shapes(), scene.frames.size() - 1);
  EXPECT_GE(scene.bodies.size(), 2u);
  EXPECT_NEAR(static_cast<double>(scene.meshes.front()->triangles().size()), 800.0, 80.0);
  EXPECT_EQ(make_scene(GetParam(), numbers(0.03)).hash(), scene.hash());
  SceneNumbers other = numbers(0.03);
  other.seed = 6;
  EXPECT_NE(make_scene(GetParam(), other).hash(), scene.hash());
}

TEST_P(DeformingFamily, ReachesItsAmplitudeAndNoMore) {
  for (const double amplitude : {0.001, 0.03, 0.3}) {
    const double reached = largest_displacement(make_scene(GetParam(), numbers(amplitude)));
    EXPECT_LE(reached, amplitude * (1.0 + k_rounding)) << amplitude;
    EXPECT_GT(reached, 0.2 * amplitude) << amplitude;
  }
}

TEST_P(DeformingFamily, StaysABodyIfItIsOne) {
  const Scene scene = make_scene(GetParam(), numbers(0.3));
  const Mesh& rest = *scene.meshes.front();
  const Mesh last = rest.with_vertices(*scene.deformations.back().front().vertices);
  EXPECT_EQ(rest.solid(), GetParam() != "cloth");
  EXPECT_EQ(last.solid(), rest.solid());
  EXPECT_EQ(last.triangles(), rest.triangles());
  EXPECT_NE(last.hash(), rest.hash());
}

INSTANTIATE_TEST_SUITE_P(Families, DeformingFamily, ::testing::Values("wave", "twist", "cloth", "bump", "crumple"),
                         [](const auto& family) { return family.param; });

TEST(DeformingFamilies, MostOfABumpStaysWhereItIs) {
  const Scene scene = make_scene("bump", {.frames = 3, .amplitude = 0.1, .triangles = 2000, .seed = 3});
  const auto& rest = scene.meshes.front()->vertices();
  const auto& last = *scene.deformations.back().front().vertices;
  std::size_t still = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) still += (last[i] - rest[i]).norm() < 1e-6 ? 1 : 0;
  EXPECT_GT(2 * still, rest.size());
}

TEST(DeformingFamilies, RefuseNumbersOutOfRange) {
  const auto refuses = [](SceneNumbers numbers) {
    return message_of<BadArgument>([&] { make_scene("wave", numbers); });
  };
  EXPECT_EQ(refuses({.amplitude = 2.0}), "amplitude 2: it must be in 1e-06 .. 1");
  EXPECT_EQ(refuses({.triangles = 7}), "7 triangles: it must be in 100 .. 5000000");
}

TEST(DeformingFamilies, AreOfRigidBodiesWithOneFrame) {
  const Scene scene = make_scene("wave", {.frames = 1, .triangles = 200});
  EXPECT_FALSE(scene.deforms());
}

}  // namespace
}  // namespace sixdof::scene
