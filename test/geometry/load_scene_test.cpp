// Formats that assimp reads.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "float_torus.h"
#include "mesh_files.h"
#include "scene_files.h"

namespace sixdof {
namespace {

using namespace testing_support;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Load3ds : public TestFolder {};

TEST_F(Load3ds, CoordinatesAndOrientationAreAsStored) {
  const auto file = write("a.3DS", file_3ds(object_3ds(float_torus())));
  ASSERT_EQ(message_of(file), "accepted");
  const Mesh mesh = load_mesh(file);
  EXPECT_TRUE(mesh.solid()) << mesh.why_not_solid();
  ASSERT_EQ(mesh.triangles().size(), float_torus().triangles().size());
  for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(mesh.vertices()[mesh.triangles()[i][k]], float_torus().vertices()[float_torus().triangles()[i][k]]);
    }
  }
}

TEST_F(Load3ds, ObjectsAddUp) {
  std::vector<Eigen::Vector3d> moved = float_torus().vertices();
  for (auto& p : moved) p.x() += 8.0;
  const Mesh other = Mesh::build(moved, float_torus().triangles());
  const Mesh mesh = load_mesh(write("a.3ds", file_3ds(object_3ds(float_torus()) + object_3ds(other))));
  EXPECT_TRUE(mesh.solid());
  EXPECT_EQ(mesh.topology().components, 2u);
}

TEST_F(Load3ds, MaterialsAndTheKeyFramerChangeNothing) {
  // Assimp would sort the triangles by material, and move vertices by the inverse of the object's axes.
  const std::string material = chunk_3ds(0xAFFF, chunk_3ds(0xA000, std::string("red\0", 4)));
  const std::string node = chunk_3ds(0xB002, chunk_3ds(0xB030, little(std::uint16_t{0})) +
                                                 chunk_3ds(0xB010, std::string("part\0\0\0\0\0\xFF\xFF", 11)));
  std::string objects = object_3ds(float_torus(), {3, 4, 8});
  const Mesh plain = load_mesh(write("a.3ds", file_3ds(object_3ds(float_torus()))));
  EXPECT_EQ(load_mesh(write("b.3ds", file_3ds(material + objects, chunk_3ds(0xB000, node)))).hash(), plain.hash());
}

TEST_F(Load3ds, DamagedFilesAreRefused) {
  const std::string good = file_3ds(object_3ds(float_torus()));
  const auto with = [&](const std::string& part, std::size_t offset, const std::string& other) {
    std::string bad = good;
    const std::size_t at = bad.find(part);
    EXPECT_NE(at, std::string::npos);
    return message_of(write("a.3ds", bad.replace(at + offset, other.size(), other)));
  };
  EXPECT_THAT(with("MM", 0, "MN"), HasSubstr("a.3ds: assimp cannot read it"));
  EXPECT_THAT(with("MM", 2, little(std::uint32_t{4})), HasSubstr("byte 0: a chunk of 4 bytes"));
  EXPECT_THAT(with("==", 2, little(std::uint32_t{0})), HasSubstr("byte 16: a chunk of 0 bytes"));
  EXPECT_THAT(with("==", 2, little(std::uint32_t{0xFFFFFFFF})), HasSubstr("byte 16: a chunk of 4294967295 bytes"));
  const std::string points = std::string("\x10\x41", 2);
  const std::string faces = std::string("\x20\x41", 2);
  // A writer with 70,000 vertices leaves a count of 4,464.
  for (const unsigned count : {4464u, 53u}) {
    EXPECT_THAT(with(points, 6, little(static_cast<std::uint16_t>(count))), HasSubstr("a.3ds: assimp"));
  }
  EXPECT_THAT(with(faces, 6, little(std::uint16_t{109})), HasSubstr("a.3ds: assimp cannot read it"));
  EXPECT_THAT(with(faces, 6 + 2 + 8 * 11 + 2, little(std::uint16_t{54})), HasSubstr("assimp finds it damaged"));
  EXPECT_THAT(with(points, 6 + 2 + 12 * 4, little(std::numeric_limits<float>::infinity())), HasSubstr("not finite"));
  EXPECT_THAT(message_of(write("a.3ds", file_3ds(""))), HasSubstr("a.3ds: assimp cannot read it"));
}

/// A pyramid over a square of side 2 with height 3, its foot at (10, 0, 0), in other formats.
class LoadOthers : public TestFolder {
 protected:
  void expect_pyramid(const Mesh& mesh) const {
    EXPECT_TRUE(mesh.solid()) << mesh.why_not_solid();
    EXPECT_EQ(mesh.triangles().size(), 6u);
    EXPECT_EQ(mesh.volume(), 4.0);
    EXPECT_EQ(mesh.box().min(), Eigen::Vector3d(10, 0, 0));
    EXPECT_EQ(mesh.box().max(), Eigen::Vector3d(12, 2, 3));
    EXPECT_EQ(mesh.repairs().forgiven.of(Forgiven::nonplanar_polygons).count, 0u);
  }
};

TEST_F(LoadOthers, Collada) {
  expect_pyramid(load_mesh(write("a.dae", collada_pyramid("2 2 0"))));
  const Mesh lifted = load_mesh(write("b.DAE", collada_pyramid("2 2 0.5")));
  EXPECT_EQ(lifted.repairs().forgiven.of(Forgiven::nonplanar_polygons).count, 1u);
  EXPECT_EQ(lifted.repairs().forgiven.of(Forgiven::nonplanar_polygons).first_place, "mesh 0: face 0");
  EXPECT_THAT(message_of(write("c.dae", collada_pyramid("2 nan 0"))), HasSubstr("c.dae: mesh 0: vertex 2: not finite"));
  EXPECT_THAT(message_of(write("d.dae", "<COLLADA")), HasSubstr("d.dae: assimp cannot read it"));
}

/// A box of 1 x 2 x 3 whose COLLADA file states unit and axes in these words.
std::string collada_box(const std::string& asset) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
         asset +
         R"(</asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="24">)"
         R"(0 0 0 1 0 0 0 2 0 1 2 0 0 0 3 1 0 3 0 2 3 1 2 3</float_array><technique_common><accessor source="#pa" count="8" )"
         R"(stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>)"
         R"(</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)"
         R"(<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 3 0 3 1 4 5 7 4 7 6 0 1 5 0 5 4 )"
         R"(2 6 7 2 7 3 0 4 6 0 6 2 1 3 7 1 7 5</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>)"
         R"(<visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>)"
         R"(<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

class LoadColladaFrame : public TestFolder {
 protected:
  struct Expected {
    const char* words;          ///< Behind the file's name.
    Eigen::Vector3d low, high;  ///< Of the box.
    const char* note;
  };
  void expect(const std::string& asset, const std::vector<Expected>& cases) const {
    const auto file = write("part.dae", collada_box(asset));
    for (const Expected& wanted : cases) {
      const Mesh mesh = load_mesh(file.string() + wanted.words);
      EXPECT_TRUE(mesh.solid());
      EXPECT_EQ(mesh.name(), "part");
      // Assimp holds the unit in single precision.
      constexpr double k_rounding = 3.0 * 6e-8;
      EXPECT_LT((mesh.box().min() - wanted.low).norm(), k_rounding) << wanted.note;
      EXPECT_LT((mesh.box().max() - wanted.high).norm(), k_rounding) << wanted.note;
      ASSERT_EQ(mesh.repairs().notes.size(), 1u);
      EXPECT_EQ(mesh.repairs().notes[0], wanted.note);
    }
  }
};

TEST_F(LoadColladaFrame, IsScaledToMetresAndTurnedOnlyIfAsked) {
  const Eigen::Vector3d zero(0, 0, 0), as_stored(1, 2, 3);
  expect(R"(<unit name="meter" meter="1"/><up_axis>Z_UP</up_axis>)",
         {{"", zero, as_stored, "the file's unit is 1 m and z points up; axes kept"},
          {"#as-stored", zero, as_stored, "the file's unit is 1 m and z points up; read as stored"},
          {"#y-up", {0, 0, -2}, {1, 3, 0}, "the file's unit is 1 m and z points up; turned so that y points up"}});
  expect(R"(<unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis>)",
         {{"", zero, 0.01 * as_stored, "the file's unit is 0.01 m and z points up; scaled to metres; axes kept"},
          {"#as-stored", zero, as_stored, "the file's unit is 0.01 m and z points up; read as stored"},
          {"#y-up",
           {0, 0, -0.02},
           {0.01, 0.03, 0},
           "the file's unit is 0.01 m and z points up; scaled to metres; turned so that y points up"}});
  expect(R"(<unit name="inch" meter="0.0254"/><up_axis>Y_UP</up_axis>)",
         {{"", zero, 0.0254 * as_stored, "the file's unit is 0.0254 m and y points up; scaled to metres; axes kept"},
          {"#y-up", zero, 0.0254 * as_stored,
           "the file's unit is 0.0254 m and y points up; scaled to metres; axes kept"}});
  expect("<up_axis>X_UP</up_axis>",
         {{"", zero, as_stored, "the file's unit is 1 m and x points up; axes kept"},
          {"#y-up", {-2, 0, 0}, {0, 1, 3}, "the file's unit is 1 m and x points up; turned so that y points up"}});
  expect("", {{"", zero, as_stored, "the file's unit is 1 m and y points up; axes kept"}});
}

TEST_F(LoadColladaFrame, WordsBehindANameThatMakeNoSenseAreRefused) {
  const auto file = write("part.dae", collada_box(R"(<unit meter="0"/>)"));
  EXPECT_THAT(message_of(file), HasSubstr("part.dae: the file's unit is 0 m"));
  EXPECT_THAT(message_of(file.string() + "#z-up"), HasSubstr("part.dae#z-up: '.dae#z-up' is no mesh format"));
  const auto off = write("part.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  EXPECT_EQ(load_mesh(off.string() + "#as-stored").hash(), load_mesh(off).hash());
  EXPECT_THAT(message_of(off.string() + "#y-up"), HasSubstr("part.off: #y-up is for COLLADA"));
  EXPECT_EQ(mesh_file_of(file.string() + "#as-stored"), file);
  EXPECT_EQ(mesh_file_of(file), file);
}

TEST_F(LoadColladaFrame, AFileMayHaveSuchANameItself) {
  const auto named = write("part.dae#as-stored", "text");
  EXPECT_EQ(mesh_file_of(named), named);
}

TEST_F(LoadOthers, X3d) { expect_pyramid(load_mesh(write("a.x3d", x3d_pyramid()))); }

TEST_F(LoadOthers, Fbx) {
  const Mesh mesh = load_mesh(write("a.fbx", fbx_pyramid("-5")));
  expect_pyramid(mesh);
  EXPECT_EQ(mesh.repairs().notes, std::vector<std::string>{"the file's unit is 1 cm and y points up; read as stored"});
  std::string metres = fbx_pyramid("-5");
  metres.replace(metres.find("Definitions:"), 0,
                 "GlobalSettings: {\n Version: 1000\n Properties70: {\n P: \"UpAxis\", \"int\", \"Integer\", \"\",2\n"
                 " P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",100\n }\n}\n");
  const Mesh large = load_mesh(write("c.fbx", metres));
  expect_pyramid(large);
  EXPECT_EQ(large.repairs().notes,
            std::vector<std::string>{"the file's unit is 100 cm and z points up; read as stored"});
  EXPECT_THAT(message_of(write("b.fbx", fbx_pyramid("-9"))), HasSubstr("vertex index out of range"));
}

TEST_F(LoadOthers, TheExtensionSaysTheFormat) {
  // Assimp would read a PLY file under any name, and never return from one without end_header.
  EXPECT_THAT(message_of(write("a.dae", "ply\nformat ascii 1.0\nelement vertex 3\n")),
              HasSubstr("a.dae: assimp cannot read it"));
}

}  // namespace
}  // namespace sixdof
