// glTF: structure, data, extensions.
#include <sixdof/geometry/load.h>

#include <cmath>

#include <gmock/gmock.h>

#include <sixdof/geometry/pose.h>

#include "float_torus.h"
#include "mesh_files.h"
#include "scene_files.h"

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-15;      // of the volume of one tetrahedron
constexpr double k_sum_rounding = 1e-12;  // of a volume of 5

using namespace testing_support;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":4)"), HasSubstr("nodes[0].mesh: meshes[4] of 1"));
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":0,"children":[7])"), HasSubstr("nodes[7]: nodes[7] of 1"));
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":0,"children":[0])"),
              HasSubstr("nodes[0]: is used twice, or below itself"));
  for (const char* index : {"-1", "0.5", "1.55e+164", "-1e99"}) {
    const std::string child = std::string(R"("mesh":0,"children":[)") + index + "]";
    EXPECT_THAT(message_with(R"("mesh":0)", child), HasSubstr("nodes[0].children: is not a whole number"));
    EXPECT_THAT(message_with(R"("POSITION":0)", std::string(R"("POSITION":)") + index),
                HasSubstr("POSITION: is not a whole number"));
  }
  EXPECT_THAT(message_with(R"("mesh":0)", R"("mesh":0,"scale":[1,1.79e308,1])"),
              HasSubstr("not finite where it is placed"));
  EXPECT_THAT(message_with(R"("indices":1)", R"("indices":9)"),
              HasSubstr("a.glb: meshes[0].primitives[0].indices: accessors[9] of 2"));
  EXPECT_THAT(message_with(R"("POSITION")", R"("POSITIONS")"), HasSubstr("key 'POSITION' not found"));
  EXPECT_THAT(message_with("5126", "5127"), HasSubstr("accessors[0]: component type 5127 is unknown"));
  EXPECT_THAT(message_with("VEC3", "VEC2"), HasSubstr("accessors[0]: 3 numbers in an element are expected"));
  EXPECT_THAT(message_with("5123", "5122"), HasSubstr("accessors[1]: indices are unsigned integers"));
  EXPECT_THAT(message_with(R"("indices":1)", R"("indices":1,"mode":7)"), HasSubstr("primitives[0]: mode 7 is unknown"));
  EXPECT_THAT(message_of(write("c.gltf", gltf_json(float_torus(), R"(,"uri":"data:;base64,AA!A")", k_plain_node))),
              HasSubstr("c.gltf: buffers[0].uri: is not base64"));
  EXPECT_THAT(message_of(write("b.gltf", gltf_json(float_torus(), R"(,"uri":"missing.bin")", k_plain_node))),
              AllOf(HasSubstr("b.gltf: buffers[0].uri: "), HasSubstr("missing.bin: cannot be read: No such file")));
}

TEST_F(LoadGltf, CountsThatDoNotFitTheFileAreRefused) {
  for (const char* count : {"55", "2000000000", "281474976710656", "18446744073709551615"}) {
    EXPECT_THAT(message_with(R"("count":54)", std::string(R"("count":)") + count),
                HasSubstr(std::string("accessors[0]: ") + count + " elements are out of range"));
    EXPECT_NE(message_with(R"("count":324)", std::string(R"("count":)") + count), "accepted");
  }
  EXPECT_THAT(message_with(R"("count":324)", R"("count":323)"), HasSubstr("323 corners are no whole number"));
  EXPECT_THAT(message_with(R"("byteOffset":648)", R"("byteOffset":649)"),
              HasSubstr("bufferViews[1]: 648 bytes from 649 on where the buffer has 1296"));
  const std::string whole = glb(gltf_json(float_torus(), "", k_plain_node), gltf_data(float_torus()));
  EXPECT_THAT(message_of(write("a.glb", whole + "tail")), HasSubstr("byte 8: not the file's size"));
}

TEST_F(LoadGltf, BadDataAreRefused) {
  const std::string json = gltf_json(float_torus(), "", k_plain_node);
  std::string data = gltf_data(float_torus());
  const std::size_t first_index = 12 * float_torus().vertices().size();
  std::string bad = data;
  bad.replace(first_index + 2 * 7, 2, little(std::uint16_t{54}));
  EXPECT_THAT(message_of(write("a.glb", glb(json, bad))),
              HasSubstr("a.glb: meshes[0].primitives[0]: index 7: vertex 54 of 54"));
  bad = data;
  bad.replace(12 * 5 + 4, 4, little(std::nanf("")));
  EXPECT_THAT(message_of(write("a.glb", glb(json, bad))),
              HasSubstr("a.glb: meshes[0].primitives[0]: vertex 5: not finite"));
}

TEST_F(LoadGltf, AGraphMayBeDeepButNotTwiceTheSame) {
  const auto chain = [](std::size_t length) {
    std::string nodes = "[";
    for (std::size_t i = 0; i + 1 < length; ++i) nodes += R"({"children":[)" + std::to_string(i + 1) + "]},";
    return nodes + R"({"mesh":0}])";
  };
  EXPECT_EQ(message(gltf_json(float_torus(), "", chain(100'000))), "accepted");
  std::string doubling = "[";
  for (int i = 1; i < 40; ++i) {
    const std::string next = std::to_string(i);
    doubling += R"({"children":[)" + next + "," + next + "]},";
  }
  EXPECT_THAT(message(gltf_json(float_torus(), "", doubling + R"({"mesh":0}])")),
              HasSubstr("nodes[39]: is used twice"));
}

TEST_F(LoadGltf, JsonMayBeNestedDeeply) {
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  for (const char* const place : {R"("mesh":0)", R"("type":"SCALAR")", R"("indices":1)", R"("name":"red")"}) {
    EXPECT_EQ(message_with(place, std::string(place) + R"(,"extras":)" + deep), "accepted") << place;
  }
}

}  // namespace
}  // namespace sixdof
