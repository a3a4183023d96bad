// Formats that hold scenes: glTF and 3DS.
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

TEST_F(LoadGltf, NodesPlaceTheirMeshesAndMirrorsKeepOutsideOutside) {
  // A generic rotation above a translation with a mirroring, unequal scale; the mesh appears twice.
  const Pose turn = Pose::from_quaternion(0.5, -0.1, 0.7, 0.5, {0, 0, 0});
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
    const Eigen::Vector3d first = turn * Eigen::Vector3d(2 * p.x() + 1.5, -1.5 * p.y() - 2.25, 3 * p.z() + 0.75);
    const Eigen::Vector3d second = turn * Eigen::Vector3d(-p.y() + 10, 2 * p.x() + 20, 0.5 * p.z() + 30);
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
        R"({"primitives":[{"attributes":{"POSITION":0},"mode":1},{"attributes":{"POSITION":0,"NORMAL":77},"indices":1}]}],)"
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

TEST_F(LoadGltf, WhatIsWrongIsNamed) {
  const std::string good = gltf_json(float_torus(), "", k_plain_node);
  ASSERT_EQ(message(good), "accepted");
  EXPECT_THAT(message("{"), HasSubstr("a.glb: the JSON is malformed"));
  EXPECT_THAT(message("[]"), HasSubstr("no object"));
  EXPECT_THAT(message(std::string(100'000, '[')), HasSubstr("malformed"));
  EXPECT_THAT(message_with("\"2.0\"", "\"1.0\""), HasSubstr("asset: version 2.0"));
  EXPECT_THAT(message_with("\"scene\":0", "\"scene\":7"), HasSubstr("scenes[7]: there are only 1"));
  EXPECT_THAT(message_with("[0]}]", "[1]}]"), HasSubstr("scenes[0].nodes: 1 is no node"));
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":4)"), HasSubstr("nodes[0]: mesh 4 of 1"));
  EXPECT_THAT(message_with(R"("mesh":0)", R"("children":[0])"), HasSubstr("nodes[0]: is reached twice"));
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":0,"rotation":[0.707107,0,0,0])"), HasSubstr("norm 0.707107"));
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":0,"scale":[1,1])"), HasSubstr("scale must be 3 numbers"));
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":0,"scale":[1,1e300,1])"), HasSubstr("scale must be 3 numbers"));
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":0,"skin":0)"), HasSubstr("skinned"));
  EXPECT_THAT(message_with(R"("indices":1)", R"("indices":9)"), HasSubstr("accessors[9]: there are only 2"));
  EXPECT_THAT(message_with(R"("indices":1)", R"("indices":-1)"), HasSubstr("indices must be a whole number"));
  EXPECT_THAT(message_with(R"("indices":1)", R"("indices":0)"), HasSubstr("indices are unsigned SCALAR"));
  EXPECT_THAT(message_with(R"("indices":1)", R"("indices":1,"targets":[])"), HasSubstr("morph targets"));
  EXPECT_THAT(message_with(R"("POSITION")", R"("POSITIONS")"), HasSubstr("meshes[0].primitives[0]: POSITION"));
  EXPECT_THAT(message_with(R"("count":54)", R"("count":55)"),
              AllOf(HasSubstr("accessors[0]"), HasSubstr("do not fit")));
  EXPECT_THAT(message_with(R"("count":54)", R"("count":281474976710656)"), HasSubstr("do not fit"));
  EXPECT_THAT(message_with(R"("count":54)", R"("count":18446744073709551615)"), HasSubstr("count must be a whole"));
  EXPECT_THAT(message_with(R"("count":324)", R"("count":323)"), HasSubstr("323 corners do not make triangles"));
  EXPECT_THAT(message_with(R"("count":54)", R"("count":54,"sparse":{})"), HasSubstr("sparse"));
  EXPECT_THAT(message_with(R"("byteOffset":648)", R"("byteOffset":649)"),
              HasSubstr("bufferViews[1]: bytes 649 to 1297"));
  EXPECT_THAT(message_with(R"("byteLength":1296)", R"("byteLength":1301)"), HasSubstr("buffers[0]: has 1296 bytes"));
  EXPECT_THAT(message_with(R"("asset")", R"("extensionsRequired":["KHR_draco_mesh_compression"],"asset")"),
              HasSubstr("'KHR_draco_mesh_compression' is not supported"));
  EXPECT_THAT(message_of(write("b.gltf", gltf_json(float_torus(), R"(,"uri":"missing.bin")", k_plain_node))),
              HasSubstr("missing.bin: cannot be read"));
  EXPECT_THAT(message_of(write("b.gltf", gltf_json(float_torus(), R"(,"uri":"file:///etc/passwd")", k_plain_node))),
              HasSubstr("only files beside this one"));
  EXPECT_THAT(message_of(write("b.gltf", gltf_json(float_torus(), R"(,"uri":"data:x;base64,*")", k_plain_node))),
              HasSubstr("no base64"));
}

TEST_F(LoadGltf, BadDataAreNamed) {
  const std::string json = gltf_json(float_torus(), "", k_plain_node);
  std::string data = gltf_data(float_torus());
  const std::size_t first_index = 12 * float_torus().vertices().size();
  std::string bad = data;
  bad.replace(first_index + 2 * 7, 2, little(std::uint16_t{54}));
  EXPECT_THAT(message_of(write("a.glb", glb(json, bad))),
              HasSubstr("a.glb: meshes[0].primitives[0]: corner 7: vertex index 54 of 54"));
  bad = data;
  bad.replace(12 * 5 + 4, 4, little(std::nanf("")));
  EXPECT_THAT(message_of(write("a.glb", glb(json, bad))),
              HasSubstr("mesh 0: the coordinates of vertex 5 are not finite"));
}

TEST_F(LoadGltf, ADeepTreeIsRefusedBeforeItOverflowsTheStack) {
  const auto chain = [](std::size_t length) {
    std::string nodes = "[";
    for (std::size_t i = 0; i + 1 < length; ++i) nodes += R"({"children":[)" + std::to_string(i + 1) + "]},";
    return nodes + R"({"mesh":0}])";
  };
  EXPECT_EQ(message(gltf_json(float_torus(), "", chain(400))), "accepted");
  EXPECT_THAT(message(gltf_json(float_torus(), "", chain(20'000))), HasSubstr("lies deeper than 500 levels"));
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

TEST_F(Load3ds, WhatIsWrongIsNamed) {
  const std::string good = file_3ds(object_3ds(float_torus()));
  const auto with = [&](const std::string& part, std::size_t offset, const std::string& other) {
    std::string bad = good;
    const std::size_t at = bad.find(part);
    EXPECT_NE(at, std::string::npos);
    return message_of(write("a.3ds", bad.replace(at + offset, other.size(), other)));
  };
  EXPECT_THAT(with("MM", 0, "MN"), HasSubstr("a.3ds: byte 0: is no 3DS file"));
  EXPECT_THAT(with("MM", 2, little(std::uint32_t{4})), HasSubstr("byte 0: a chunk of 4 bytes"));
  EXPECT_THAT(with("==", 2, little(std::uint32_t{0})), HasSubstr("byte 16: a chunk of 0 bytes"));
  EXPECT_THAT(with("==", 2, little(std::uint32_t{0xFFFFFFFF})), HasSubstr("byte 16: a chunk of 4294967295 bytes"));
  const std::string points = std::string("\x10\x41", 2);
  const std::string faces = std::string("\x20\x41", 2);
  // A writer with 70,000 vertices leaves a count of 4,464.
  EXPECT_THAT(with(points, 6, little(std::uint16_t{4464})), HasSubstr("object 0: 4464 vertices take 53570 bytes"));
  EXPECT_THAT(with(points, 6, little(std::uint16_t{53})), HasSubstr("object 0: 53 vertices take"));
  EXPECT_THAT(with(faces, 6, little(std::uint16_t{109})), HasSubstr("object 0: 109 faces take"));
  EXPECT_THAT(with(faces, 6 + 2 + 8 * 11 + 2, little(std::uint16_t{54})),
              HasSubstr("object 0: face 11: vertex index 54 of 54"));
  EXPECT_THAT(with(points, 6 + 2 + 12 * 4, little(std::numeric_limits<float>::infinity())), HasSubstr("not finite"));
  EXPECT_THAT(message_of(write("a.3ds", file_3ds(""))), HasSubstr("no triangles"));
}

}  // namespace
}  // namespace sixdof
