#include <sixdof/scene/scene_file.h>

#include <fstream>
#include <iterator>

#include "../cli/scratch_folder.h"
#include "small_scenes.h"

namespace sixdof::scene {
namespace {

class SceneFile : public test::ScratchFolder {};

std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(SceneFile, ComesBackBitForBit) {
  Scene scene = make_scene("robot", {.bodies = 40, .frames = 5, .seed = 2});
  scene.name = "arm";
  save_scene(scene, path("s.h5"));
  const Scene read = load_scene(path("s.h5"));
  EXPECT_EQ(read.hash(), scene.hash());
  EXPECT_EQ(read.name, "arm");
  EXPECT_EQ(read.recipe, scene.recipe);
  EXPECT_EQ(read.ignored, scene.ignored);
  EXPECT_EQ(read.motions(), scene.motions());
  EXPECT_EQ(read.bodies[30].fixed, true);
  EXPECT_TRUE(is_scene(path("s.h5")));
  save_scene(read, path("t.h5"));
  EXPECT_EQ(bytes_of(path("t.h5")), bytes_of(path("s.h5")));
}

TEST_F(SceneFile, KeepsASceneInWhichNothingMoves) {
  const Scene scene = make_scene("still", {.bodies = 12, .frames = 4});
  save_scene(scene, path("s.h5"));
  EXPECT_EQ(load_scene(path("s.h5")).hash(), scene.hash());
  EXPECT_EQ(load_scene(path("s.h5")).frames.size(), 4u);
}

TEST_F(SceneFile, KeepsTheVerticesOfBodiesThatDeform) {
  const Scene scene = make_scene("twist", {.frames = 4, .amplitude = 0.1, .triangles = 300, .seed = 2});
  save_scene(scene, path("s.h5"));
  const Scene read = load_scene(path("s.h5"));
  EXPECT_EQ(read.hash(), scene.hash());
  ASSERT_EQ(read.deformations.size(), 4u);
  EXPECT_TRUE(read.deformations[0].empty());
  EXPECT_EQ(*read.deformations[3][0].vertices, *scene.deformations[3][0].vertices);
  save_scene(read, path("t.h5"));
  EXPECT_EQ(bytes_of(path("t.h5")), bytes_of(path("s.h5")));
}

TEST_F(SceneFile, RefusesDamagedVertices) {
  const Scene scene = make_scene("wave", {.frames = 3, .triangles = 200});
  save_scene(scene, path("s.h5"));
  const std::string whole = bytes_of(path("s.h5"));
  for (std::size_t at = whole.size() / 2; at < whole.size(); at += 4001) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 16);
    std::ofstream(path("bad.h5"), std::ios::binary) << bytes;
    try {
      EXPECT_EQ(load_scene(path("bad.h5")).hash(), scene.hash());  // padding
    } catch (const BadFile&) {
    }
  }
}

TEST_F(SceneFile, RefusesDamage) {
  const Scene scene = make_scene("cube", {.bodies = 30, .frames = 3});
  save_scene(scene, path("s.h5"));
  const std::string whole = bytes_of(path("s.h5"));
  const auto write = [&](const std::string& bytes) { std::ofstream(path("bad.h5"), std::ios::binary) << bytes; };
  write(whole.substr(0, whole.size() / 2));
  EXPECT_THROW(load_scene(path("bad.h5")), BadFile);
  // A bit of every 997th byte: whatever it hits, the scene is refused or the byte is padding.
  std::size_t refused = 0, same = 0;
  for (std::size_t at = 500; at < whole.size(); at += 997) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 4);
    write(bytes);
    try {
      EXPECT_EQ(load_scene(path("bad.h5")).hash(), scene.hash());
      ++same;
    } catch (const BadFile&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 3 * same);
}

TEST_F(SceneFile, RefusesWhatIsNoScene) {
  std::ofstream(path("text.h5")) << "frame,body\n";
  EXPECT_THROW(load_scene(path("text.h5")), BadFile);
  EXPECT_NE(message_of<BadFile>([&] { load_scene(path("none.h5")); }).find("no such file"), std::string::npos);
}

TEST_F(SceneFile, WritesNothingOfAWrongScene) {
  Scene scene = row_of_spheres(3, 0.1, 0.0, 1, 0.0);
  scene.bodies[0].id = 11;
  EXPECT_THROW(save_scene(scene, path("s.h5")), BadArgument);
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
}

}  // namespace
}  // namespace sixdof::scene
