#include <sixdof/scene/families.h>

#include <set>

#include "small_scenes.h"

namespace sixdof::scene {
namespace {

constexpr double k_count_margin = 200.0;   // of 2,000 motions drawn at random: five standard deviations
constexpr double k_extent_margin = 0.05;   // of the outermost of 400 bodies drawn at random
constexpr double k_ratio_rounding = 1e-9;  // of sizes
constexpr double k_rounding = 1e-12;       // of one quotient

TEST(SceneFamilies, AreSeededAndHaveTheirCounts) {
  std::set<std::string_view> names;
  for (const SceneFamily& family : scene_families()) {
    SCOPED_TRACE(family.name);
    EXPECT_TRUE(names.insert(family.name).second);
    const SceneNumbers numbers{.bodies = 60, .frames = 12, .seed = 5};
    const Scene scene = make_scene(family.name, numbers);
    EXPECT_EQ(scene.bodies.size(), 60u);
    EXPECT_EQ(scene.frames.size(), 12u);
    EXPECT_LT(scene.meshes.size(), 16u);  // shared
    EXPECT_EQ(make_scene(family.name, numbers).hash(), scene.hash());
    EXPECT_NE(make_scene(family.name, {.bodies = 60, .frames = 12, .seed = 6}).hash(), scene.hash());
    EXPECT_EQ(scene.motions() == 0, family.name == "still");
  }
  EXPECT_EQ(names.size(), 10u);
}

TEST(SceneFamilies, ObeyTheAxes) {
  const auto cube = [](SceneNumbers numbers) { return make_scene("cube", numbers); };
  const auto extent = [](const Scene& scene) {
    double largest = 0.0;
    for (const Body& body : scene.bodies) largest = std::max(largest, std::abs(body.pose.numbers[4]));
    return largest;
  };
  const Scene dense = cube({.bodies = 400, .frames = 1, .density = 0.08});
  const Scene thin = cube({.bodies = 400, .frames = 1, .density = 0.01});
  EXPECT_NEAR(extent(thin) / extent(dense), 2.0, k_extent_margin);
  const Scene some = cube({.bodies = 400, .frames = 21, .moving = 0.25});
  EXPECT_NEAR(static_cast<double>(some.motions()), 0.25 * 400 * 20, k_count_margin);
  const Scene sizes = cube({.bodies = 400, .frames = 1, .size_ratio = 8.0});
  double largest = 0.0, smallest = 1e9;
  for (const auto& mesh : sizes.meshes) {
    if (mesh->name() != "sphere") continue;
    largest = std::max(largest, mesh->diagonal());
    smallest = std::min(smallest, mesh->diagonal());
  }
  EXPECT_NEAR(largest / smallest, 8.0, k_ratio_rounding);
  EXPECT_NEAR(
      cube({.bodies = 40, .frames = 1, .margin = 0.4}).margin / cube({.bodies = 40, .frames = 1, .margin = 0.1}).margin,
      4.0, k_rounding);
}

TEST(SceneFamilies, ShuffledIsTheCube) {
  const SceneNumbers numbers{.bodies = 50, .frames = 3, .seed = 4};
  const Scene cube = make_scene("cube", numbers), other = make_scene("shuffled", numbers);
  ASSERT_EQ(cube.bodies.size(), other.bodies.size());
  std::size_t elsewhere = 0;
  for (std::size_t i = 0; i < cube.bodies.size(); ++i) {
    const Body& body = other.bodies[i];
    EXPECT_EQ(cube.bodies[body.id].pose.numbers, body.pose.numbers);
    elsewhere += body.id != i ? 1 : 0;
  }
  EXPECT_GT(elsewhere, 40u);
}

TEST(SceneFamilies, RefuseNumbersOutOfRange) {
  const auto refuses = [](SceneNumbers numbers) {
    return message_of<BadArgument>([&] { make_scene("cube", numbers); });
  };
  EXPECT_EQ(refuses({.bodies = 1}), "1 bodies: it must be in 2 .. 1000000");
  EXPECT_EQ(refuses({.frames = 0}), "0 frames: it must be in 1 .. 100000");
  EXPECT_EQ(refuses({.density = 0.0}), "density 0: it must be in 1e-09 .. 10");
  EXPECT_EQ(refuses({.moving = 1.5}), "share that moves 1.5: it must be in 0 .. 1");
  EXPECT_NE(message_of<BadArgument>([] { make_scene("cubes", {}); }).find("there are cube, pairs"), std::string::npos);
}

}  // namespace
}  // namespace sixdof::scene
