// Formats that assimp reads.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include <sixdof/geometry/pose.h>

#include "mesh_files.h"
#include "scene_files.h"

namespace sixdof {
namespace {

using namespace testing_support;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// The torus with coordinates that a float can hold.
const Mesh& float_torus() {
  static const Mesh mesh = [] {
    const Mesh exact = bumpy_torus(9, 6, 0.73, 99);
    std::vector<Eigen::Vector3d> vertices;
    for (const auto& p : exact.vertices()) vertices.emplace_back(as_float(p.x()), as_float(p.y()), as_float(p.z()));
    return Mesh::build(std::move(vertices), exact.triangles());
  }();
  return mesh;
}

const std::string k_plain_node = R"([{"mesh":0}])";

class LoadGltf : public TestFolder {
 protected:
  std::string message(const std::string& json) const {
    return message_of(write("a.glb", glb(json, gltf_data(float_torus()))));
  }
  /// The message after one part of a good file has been replaced.
  std::string message_with(const std::string& part, const std::string& other) const {
    std::string json = gltf_json(float_torus(), "", k_plain_node);
    const std::size_t at = json.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return message(json.replace(at, part.size(), other));
  }
};

TEST_F(LoadGltf, GlbEmbeddedAndBesideGiveTheSameBits) {
  const std::string data = gltf_data(float_torus());
  write("some data.bin", data);
  const std::vector<std::filesystem::path> files{
      write("a.glb", glb(gltf_json(float_torus(), "", k_plain_node), data)),
      write("b.gltf", gltf_json(float_torus(), R"(,"uri":"data:application/octet-stream;base64,)" + base64(data) + '"',
                                k_plain_node)),
      write("c.gltf", gltf_json(float_torus(), R"(,"uri":"some%20data.bin")", k_plain_node))};
  for (const auto& file : files) {
    ASSERT_EQ(message_of(file), "accepted") << file;
    EXPECT_EQ(load_mesh(file).hash(), float_torus().hash()) << file;
  }
}

TEST_F(LoadGltf, TransformsAreAppliedAndMirrorsKeepOutsideOutside) {
  // A generic rotation above a translation with a mirroring, unequal scale; the mesh appears twice.
  const Pose rotation = Pose::from_quaternion(0.5, -0.1, 0.7, 0.5, {0, 0, 0});
  const std::string nodes =
      R"([{"rotation":[-0.1,0.7,0.5,0.5],"children":[1,2]},{"translation":[1.5,-2.25,0.75],"scale":[2,-1.5,3],"mesh":0},)"
      R"({"matrix":[0,2,0,0,-1,0,0,0,0,0,0.5,0,10,20,30,1],"mesh":0}])";
  const Mesh mesh = load_mesh(write("a.glb", glb(gltf_json(float_torus(), "", nodes), gltf_data(float_torus()))));
  const Mesh& torus = float_torus();
  const std::size_t n = torus.vertices().size();
  ASSERT_EQ(mesh.vertices().size(), 2 * n);
  EXPECT_TRUE(mesh.solid()) << mesh.why_not_solid();
  EXPECT_EQ(mesh.topology().components, 2u);
  // Assimp keeps transforms in single precision; coordinates reach 40.
  constexpr double k_tolerance = 40.0 * 4.0 * 6e-8;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d& p = torus.vertices()[i];
    const Eigen::Vector3d first = rotation * Eigen::Vector3d(2 * p.x() + 1.5, -1.5 * p.y() - 2.25, 3 * p.z() + 0.75);
    const Eigen::Vector3d second = rotation * Eigen::Vector3d(-p.y() + 10, 2 * p.x() + 20, 0.5 * p.z() + 30);
    EXPECT_LE((mesh.vertices()[i] - first).cwiseAbs().maxCoeff(), k_tolerance);
    EXPECT_LE((mesh.vertices()[n + i] - second).cwiseAbs().maxCoeff(), k_tolerance);
  }
  EXPECT_NEAR(mesh.volume(), (9.0 + 1.0) * torus.volume(), 10.0 * torus.volume() * 1e-5);
}

TEST_F(LoadGltf, StridesOffsetsOtherIndexTypesAndOtherScenes) {
  const Mesh& torus = float_torus();
  std::string data = "padding!";
  for (const auto& p : torus.vertices()) {
    for (const double x : p) data += little(static_cast<float>(x));
    data += little(17.5f) + little(18.5f);
  }
  const std::size_t n = torus.vertices().size();
  const std::size_t m = 3 * torus.triangles().size();
  const std::string view =
      R"({"buffer":0,"byteOffset":4,"byteLength":)" + std::to_string(4 + 20 * n) + R"(,"byteStride":20})";
  for (const auto& [type, bytes] :
       {std::pair{5121, indices<std::uint8_t>(torus)}, {5125, indices<std::uint32_t>(torus)}}) {
    const std::string json =
        R"({"asset":{"version":"2.0"},"scene":1,"scenes":[{"nodes":[0]},{"nodes":[1]}],"nodes":[{"mesh":1},{"mesh":2}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":0}]},{"primitives":[{"attributes":{"POSITION":0},"mode":5}]},)"
        R"({"primitives":[{"attributes":{"POSITION":0},"mode":1},{"attributes":{"POSITION":0},"indices":1}]}],)"
        R"("accessors":[{"bufferView":0,"byteOffset":4,"componentType":5126,"count":)" +
        std::to_string(n) + R"(,"type":"VEC3"},{"bufferView":1,"componentType":)" + std::to_string(type) +
        R"(,"count":)" + std::to_string(m) + R"(,"type":"SCALAR"}],"bufferViews":[)" + view +
        R"(,{"buffer":0,"byteOffset":)" + std::to_string(data.size()) + R"(,"byteLength":)" +
        std::to_string(bytes.size()) + R"(}],"buffers":[{"byteLength":)" + std::to_string(data.size() + bytes.size()) +
        "}]}";
    const auto file = write("a.glb", glb(json, data + bytes));
    ASSERT_EQ(message_of(file), "accepted");
    EXPECT_EQ(load_mesh(file).hash(), torus.hash()) << type;
  }
}

TEST_F(LoadGltf, DamagedStructureIsRefused) {
  const std::string good = gltf_json(float_torus(), "", k_plain_node);
  ASSERT_EQ(message(good), "accepted");
  EXPECT_THAT(message("{"), HasSubstr("a.glb: the JSON is malformed"));
  EXPECT_THAT(message("[]"), HasSubstr("a.glb: the JSON is malformed"));
  EXPECT_THAT(message(std::string(100'000, '[')), HasSubstr("malformed"));
  EXPECT_THAT(message_with("\"2.0\"", "\"1.0\""), HasSubstr("version 2 is expected"));
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":4)"), HasSubstr("Array index 4 is out of bounds"));
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":0,"children":[7])"), HasSubstr("nodes[7]: is missing or shared"));
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":0,"children":[0])"), HasSubstr("deeper than 500 levels"));
  for (const char* index : {"-1", "0.5", "1.55e+164", "-1e99"}) {
    const std::string child = std::string(R"("mesh":0,"children":[)") + index + "]";
    EXPECT_THAT(message_with(R"("mesh":0)", child), HasSubstr("nodes[0].children: an index is not a whole number"));
    EXPECT_THAT(message_with(R"("POSITION":0)", std::string(R"("POSITION":)") + index),
                HasSubstr("POSITION: an index is not a whole number"));
  }
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":0,"scale":[1,1e300,1])"), HasSubstr("not finite"));
  EXPECT_THAT(message_with(R"("indices":1)", R"("indices":9)"), HasSubstr("a.glb: assimp cannot read it"));
  EXPECT_THAT(message_with(R"("POSITION")", R"("POSITIONS")"), HasSubstr("key 'POSITION' not found"));
  EXPECT_THAT(message_with("5126", "5122"), HasSubstr("three floats"));
  EXPECT_THAT(message_with(R"("count":54)", R"("count":54,"sparse":{})"), HasSubstr("sparse"));
  EXPECT_THAT(message_of(write("c.gltf", gltf_json(float_torus(), R"(,"uri":"data:;base64,AA!A")", k_plain_node))),
              HasSubstr("c.gltf: buffers[0].uri: is not base64"));
  EXPECT_THAT(message_of(write("b.gltf", gltf_json(float_torus(), R"(,"uri":"missing.bin")", k_plain_node))),
              AllOf(HasSubstr("b.gltf: assimp cannot read it"), HasSubstr("missing.bin")));
}

TEST_F(LoadGltf, CountsThatDoNotFitTheFileAreRefused) {
  for (const char* count : {"55", "2000000000", "281474976710656", "18446744073709551615"}) {
    EXPECT_THAT(message_with(R"("count":54)", std::string(R"("count":)") + count), HasSubstr("assimp cannot read it"));
    EXPECT_THAT(message_with(R"("count":324)", std::string(R"("count":)") + count), HasSubstr("a.glb: assimp"));
  }
  EXPECT_THAT(message_with(R"("count":324)", R"("count":323)"), HasSubstr("assimp finds it damaged"));
  EXPECT_THAT(message_with(R"("byteOffset":648)", R"("byteOffset":649)"), HasSubstr("out of range"));
  const std::string whole = glb(gltf_json(float_torus(), "", k_plain_node), gltf_data(float_torus()));
  EXPECT_THAT(message_of(write("a.glb", whole + "tail")), HasSubstr("byte 8: not the file's size"));
}

TEST_F(LoadGltf, BadDataAreRefused) {
  const std::string json = gltf_json(float_torus(), "", k_plain_node);
  std::string data = gltf_data(float_torus());
  const std::size_t first_index = 12 * float_torus().vertices().size();
  std::string bad = data;
  bad.replace(first_index + 2 * 7, 2, little(std::uint16_t{54}));
  for (int repeat = 0; repeat < 2; ++repeat) {
    EXPECT_THAT(message_of(write("a.glb", glb(json, bad))), HasSubstr("a.glb: assimp finds it damaged"));
  }
  EXPECT_EQ(message(json), "accepted") << "the damage of the file before must be forgotten";
  bad = data;
  bad.replace(12 * 5 + 4, 4, little(std::nanf("")));
  EXPECT_THAT(message_of(write("a.glb", glb(json, bad))), HasSubstr("a.glb: mesh 0: vertex 5: not finite"));
}

TEST_F(LoadGltf, AGraphThatExhaustsStackOrMemoryIsRefused) {
  const auto chain = [](std::size_t length) {
    std::string nodes = "[";
    for (std::size_t i = 0; i + 1 < length; ++i) nodes += R"({"children":[)" + std::to_string(i + 1) + "]},";
    return nodes + R"({"mesh":0}])";
  };
  EXPECT_EQ(message(gltf_json(float_torus(), "", chain(400))), "accepted");
  EXPECT_THAT(message(gltf_json(float_torus(), "", chain(20'000))), HasSubstr("lies deeper than 500 levels"));
  std::string doubling = "[";
  for (int i = 1; i < 40; ++i) {
    const std::string next = std::to_string(i);
    doubling += R"({"children":[)" + next + "," + next + "]},";
  }
  EXPECT_THAT(message(gltf_json(float_torus(), "", doubling + R"({"mesh":0}])")), HasSubstr("shared"));
}

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
    EXPECT_EQ(mesh.repairs().nonplanar_polygons.count, 0u);
  }
};

TEST_F(LoadOthers, Collada) {
  expect_pyramid(load_mesh(write("a.dae", collada_pyramid("2 2 0"))));
  const Mesh lifted = load_mesh(write("b.DAE", collada_pyramid("2 2 0.5")));
  EXPECT_EQ(lifted.repairs().nonplanar_polygons.count, 1u);
  EXPECT_EQ(lifted.repairs().nonplanar_polygons.first_place, "mesh 0: face 0");
  EXPECT_THAT(message_of(write("c.dae", collada_pyramid("2 nan 0"))), HasSubstr("c.dae: mesh 0: vertex 2: not finite"));
  EXPECT_THAT(message_of(write("d.dae", "<COLLADA")), HasSubstr("d.dae: assimp cannot read it"));
}

TEST_F(LoadOthers, X3d) { expect_pyramid(load_mesh(write("a.x3d", x3d_pyramid()))); }

TEST_F(LoadOthers, Fbx) {
  expect_pyramid(load_mesh(write("a.fbx", fbx_pyramid("-5"))));
  EXPECT_THAT(message_of(write("b.fbx", fbx_pyramid("-9"))), HasSubstr("vertex index out of range"));
}

TEST_F(LoadOthers, TheExtensionSaysTheFormat) {
  // Assimp would read a PLY file under any name, and never return from one without end_header.
  EXPECT_THAT(message_of(write("a.dae", "ply\nformat ascii 1.0\nelement vertex 3\n")),
              HasSubstr("a.dae: assimp cannot read it"));
}

}  // namespace
}  // namespace sixdof
