#include <sixdof/geometry/save.h>

#include <clocale>
#include <limits>
#include <locale>
#include <map>

#include <gmock/gmock.h>

#include "mesh_files.h"

namespace sixdof {
namespace {

using ::testing::HasSubstr;
using testing_support::bumpy_torus;

class Save : public testing_support::TestFolder {};

const Mesh& mesh_at(double scale) {
  static std::map<double, Mesh> meshes;
  const auto found = meshes.find(scale);
  return found != meshes.end() ? found->second : meshes.emplace(scale, bumpy_torus(17, 11, scale, 4711)).first->second;
}

constexpr double k_scales[] = {1e-6, 0.73, 1e6, 3e-300};

TEST_F(Save, PlyOffAndObjComeBackBitForBit) {
  for (const double scale : k_scales) {
    const Mesh& mesh = mesh_at(scale);
    for (const char* name : {"torus.ply", "torus.off", "torus.obj", "TORUS.PLY"}) {
      save_mesh(mesh, path(name));
      const Mesh back = load_mesh(path(name));
      EXPECT_EQ(back.hash(), mesh.hash()) << name << " at " << scale;
      EXPECT_EQ(back.triangles(), mesh.triangles()) << name;
      EXPECT_EQ(back.repairs().welded_vertices, 0u);
      EXPECT_EQ(back.name(), std::filesystem::path(name).stem());
    }
  }
}

TEST_F(Save, SavingTwiceGivesTheSameBytes) {
  const Mesh& mesh = mesh_at(0.73);
  for (const char* extension : {"ply", "off", "obj", "stl"}) {
    save_mesh(mesh, path(std::string("first.") + extension));
    save_mesh(mesh, path(std::string("second.") + extension));
    EXPECT_EQ(read(path(std::string("first.") + extension)), read(path(std::string("second.") + extension)));
  }
}

TEST_F(Save, StlKeepsTheSolidAndLosesNoMoreThanSinglePrecision) {
  for (const double scale : {1e-6, 0.73, 1e6}) {
    const Mesh& mesh = mesh_at(scale);
    save_mesh(mesh, path("torus.stl"));
    const Mesh back = load_mesh(path("torus.stl"));
    EXPECT_TRUE(back.solid()) << back.why_not_solid();
    ASSERT_EQ(back.triangles().size(), mesh.triangles().size());
    // Half a unit in the last place of a float, of the largest coordinate.
    const double tolerance = 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon()) *
                             std::max(mesh.box().max().cwiseAbs().maxCoeff(), mesh.box().min().cwiseAbs().maxCoeff());
    double worst = 0.0;
    for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& p = mesh.vertices()[mesh.triangles()[i][k]];
        const auto& q = back.vertices()[back.triangles()[i][k]];
        worst = std::max(worst, (p - q).cwiseAbs().maxCoeff());
      }
    }
    EXPECT_LE(worst, tolerance);
    EXPECT_GT(worst, 0.0) << "the mesh has coordinates that a float cannot hold";
  }
}

TEST_F(Save, StlRefusesCoordinatesBeyondSinglePrecision) {
  const Mesh mesh = bumpy_torus(5, 4, 1e60, 1);
  try {
    save_mesh(mesh, path("torus.stl"));
    FAIL() << "saved";
  } catch (const BadFile& e) {
    EXPECT_THAT(e.what(), HasSubstr("torus.stl: vertex 0: a coordinate is too large"));
  }
  EXPECT_FALSE(std::filesystem::exists(path("torus.stl")));
}

TEST_F(Save, PlyTakesColoursAndTheirMeshLoads) {
  const Mesh& mesh = mesh_at(0.73);
  std::vector<Colour> colours;
  for (std::size_t i = 0; i < mesh.vertices().size(); ++i) {
    colours.push_back({static_cast<std::uint8_t>(i % 251), 7, static_cast<std::uint8_t>(i % 13)});
  }
  save_ply({mesh.vertices(), mesh.triangles(), colours}, path("coloured.ply"));
  EXPECT_EQ(load_mesh(path("coloured.ply")).hash(), mesh.hash());
  const std::string bytes = read(path("coloured.ply"));
  EXPECT_THAT(bytes, HasSubstr("property uchar green\n"));
  const std::size_t second_colour = bytes.find("end_header\n") + 11 + 27 + 24;
  EXPECT_EQ(bytes.substr(second_colour, 3), std::string("\x01\x07\x01"));

  colours.pop_back();
  EXPECT_THROW(save_ply({mesh.vertices(), mesh.triangles(), colours}, path("short.ply")), BadArgument);
  std::vector<Eigen::Vector3d> normals = mesh.vertices();
  save_ply({mesh.vertices(), mesh.triangles(), {}, normals}, path("normals.ply"));
  EXPECT_EQ(load_mesh(path("normals.ply")).hash(), mesh.hash());
  normals.pop_back();
  EXPECT_THROW(save_ply({mesh.vertices(), mesh.triangles(), {}, normals}, path("short.ply")), BadArgument);
  const std::vector<Triangle> foreign{{0, 1, static_cast<std::uint32_t>(mesh.vertices().size())}};
  EXPECT_THROW(save_ply({mesh.vertices(), foreign}, path("short.ply")), BadArgument);
  EXPECT_FALSE(std::filesystem::exists(path("short.ply")));
}

TEST_F(Save, RefusesUnknownFormatsAndMissingFolders) {
  const Mesh& mesh = mesh_at(0.73);
  EXPECT_THROW(save_mesh(mesh, path("torus.step")), BadFile);
  EXPECT_THROW(save_mesh(mesh, path("torus")), BadFile);
  EXPECT_THROW(save_mesh(mesh, path("nowhere/torus.ply")), BadFile);
}

// A decimal comma, and dots between thousands.
class CommaNumbers : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST_F(Save, NumbersDoNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const std::locale global = std::locale::global(std::locale(std::locale::classic(), new CommaNumbers));
  bool comma = false;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"}) {
    comma = comma || std::setlocale(LC_ALL, name) != nullptr;
  }
  for (const double scale : {0.73, 1e6}) {
    const Mesh& mesh = mesh_at(scale);
    for (const char* name : {"torus.ply", "torus.off", "torus.obj"}) {
      save_mesh(mesh, path(name));
      EXPECT_EQ(load_mesh(path(name)).hash(), mesh.hash()) << name;
    }
  }
  std::setlocale(LC_ALL, before.c_str());
  std::locale::global(global);
  RecordProperty("comma_locale_of_the_c_library", comma ? "yes" : "none installed");
}

}  // namespace
}  // namespace sixdof
