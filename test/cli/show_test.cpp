#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/ist/ist.h>
#include <sixdof/algorithm/vps/vps.h>
#include <sixdof/geometry/load.h>
#include <sixdof/geometry/save.h>
#include <sixdof/models/model_catalogue.h>
#include "bench/common/run_guarded.h"

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

using ::testing::HasSubstr;

class Show : public test::ScratchFolder {
 protected:
  test::ProgramResult show(const std::string& arguments) const {
    return test::run_program("SIXDOF_CACHE=off " + std::string(SIXDOF_PROGRAM) + " show " + arguments);
  }
  std::string read(const std::string& name) const {
    std::ostringstream bytes;
    bytes << std::ifstream(path(name), std::ios::binary).rdbuf();
    return bytes.str();
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder()), {}));
  }
};

double double_at(const std::string& bytes, std::size_t at) {
  double value = 0.0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

TEST_F(Show, WritesSpheresThatLoadAsAMesh) {
  const auto run = show("--algorithm ist --model torus-1k --parameter spheres=60 -p seed=3 -o " + path("s.ply"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("60 spheres as 2520 vertices and 4800 triangles"));
  const Mesh mesh = load_mesh(path("s.ply"));
  EXPECT_EQ(mesh.triangles().size(), 4800u);
  EXPECT_EQ(mesh.topology().components, 60u);  // disjoint
  EXPECT_THAT(read("s.ply"), HasSubstr("property uchar red\n"));

  Settings settings = make_ist_algorithm()->settings();
  settings.set_all({"spheres=60", "seed=3"});
  ::setenv("SIXDOF_CACHE", "off", 1);
  const auto tree = ist::build_inner_sphere_tree(load_model("torus-1k"), settings).tree;
  ::unsetenv("SIXDOF_CACHE");
  EXPECT_NEAR(mesh.volume(), 0.9 * tree.volume, 0.05 * tree.volume);  // 80 facets fill 87 % of a ball
  EXPECT_TRUE(load_model("torus-1k").box().contains(mesh.box()));
}

TEST_F(Show, WritesBallsOfALevelAndHalfABody) {
  ASSERT_EQ(show("--algorithm ist --model torus-1k -p spheres=60 --part balls --level 1 -o " + path("b.ply")).exit_code,
            0);
  EXPECT_LE(load_mesh(path("b.ply")).triangles().size(), 4u * 80u);
  ASSERT_EQ(show("--algorithm vps --model box-12 -p voxel_size=0.03 --keep 0.5 -o " + path("v.ply")).exit_code, 0);
  const Mesh half = load_mesh(path("v.ply"));
  const double voxel = 0.03 * load_model("box-12").diagonal();
  EXPECT_NEAR(half.box().max().x(), 0.0, voxel);
  EXPECT_NEAR(half.box().min().x(), -1.0, voxel);
  EXPECT_TRUE(half.topology().closed);
  EXPECT_NEAR(half.volume(), 1.0 * 1.6 * 1.2, voxel * half.area());
}

TEST_F(Show, WritesPointsWithNormals) {
  for (const char* algorithm : {"vps", "vps-field"}) {
    const auto run = show(std::string("--model box-12 --part points -p point_spacing=0.05 --algorithm ") + algorithm +
                          " -o " + path("p.ply"));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string bytes = read("p.ply");
    EXPECT_THAT(bytes, HasSubstr("property double nx\n"));
    EXPECT_THAT(bytes, HasSubstr("element face 0\n"));
    const auto shell = vps::PointShell::build(load_model("box-12"), 0.05 * load_model("box-12").diagonal());
    const std::size_t data = bytes.find("end_header\n") + std::strlen("end_header\n");
    constexpr std::size_t k_vertex_bytes = 6 * sizeof(double) + 3;
    ASSERT_EQ(bytes.size() - data, shell.points.size() * k_vertex_bytes);
    for (std::size_t i = 0; i < shell.points.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = data + i * k_vertex_bytes + k * sizeof(double);
        ASSERT_EQ(double_at(bytes, at), shell.points[i][static_cast<Eigen::Index>(k)]);
        ASSERT_EQ(double_at(bytes, at + 3 * sizeof(double)), shell.normals[i][static_cast<Eigen::Index>(k)]);
      }
    }
  }
}

TEST_F(Show, RefusesBadArgumentsAndLeavesNothingBehind) {
  const Mesh open = Mesh::build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, "open");
  save_mesh(open, path("open.ply"));
  const auto refuses = [&](const std::string& arguments, const std::string& words, int code = k_exit_error) {
    const auto result = show(arguments);
    EXPECT_EQ(result.exit_code, code) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_THAT(result.err, HasSubstr(words)) << arguments;
    EXPECT_EQ(files(), 1u) << arguments;
  };
  const std::string good = "--algorithm ist --model torus-1k -p spheres=5 -o " + path("x.ply") + " ";
  refuses("--algorithm exact --model torus-1k -o " + path("x.ply"), "exact: has no structure to show");
  refuses("--algorithm octree --model torus-1k -o " + path("x.ply"), "no such algorithm");
  refuses(good + "--part points", "ist has spheres, balls");
  refuses(good + "--part balls", "--level");
  refuses(good + "--level 2", "--level");
  refuses(good + "-p sphere=5", "no such parameter");
  refuses(good + "-p spheres=many", "spheres");
  refuses("--algorithm ist --model tourus-1k -o " + path("x.ply"), "tourus");
  refuses("--algorithm vps --model torus-1k -o " + path("x.obj"), "must end in .ply");
  refuses("--algorithm vps --model torus-1k -o " + path("no_such_folder/x.ply"), "no_such_folder");
  for (const char* algorithm : {"ist", "vps", "vps-field"}) {
    refuses(std::string("--algorithm ") + algorithm + " --model " + path("open.ply") + " -o " + path("x.ply"),
            "border edges");
  }
  refuses(good + "--level 0", "--level", k_exit_usage);
  refuses(good + "--keep 1.5", "--keep", k_exit_usage);
  refuses("--algorithm ist --model torus-1k", "--output", k_exit_usage);
}

}  // namespace
}  // namespace sixdof
