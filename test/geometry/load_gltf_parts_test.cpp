// glTF: instances, accessors, extensions, containers.
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

/// A glTF file that is put together from accessors; all data are in buffer 0.
class Parts {
 public:
  std::size_t view(const std::string& bytes, const std::string& more = {}) {
    views_.push_back(R"({"buffer":0,"byteOffset":)" + std::to_string(data_.size()) + R"(,"byteLength":)" +
                     std::to_string(bytes.size()) + more + "}");
    data_ += bytes;
    data_.resize((data_.size() + 3) / 4 * 4, '\0');
    return views_.size() - 1;
  }
  /// @param view its `"bufferView":N,` or nothing
  std::size_t accessor(const std::string& view, int component, const std::string& type, std::size_t count,
                       const std::string& more = {}) {
    accessors_.push_back("{" + view + R"("componentType":)" + std::to_string(component) + R"(,"type":")" + type +
                         R"(","count":)" + std::to_string(count) + more + "}");
    return accessors_.size() - 1;
  }
  std::size_t accessor(std::size_t view, int component, const std::string& type, std::size_t count,
                       const std::string& more = {}) {
    return accessor(R"("bufferView":)" + std::to_string(view) + ",", component, type, count, more);
  }
  std::string glb_of(const std::string& scenes, const std::string& nodes, const std::string& meshes,
                     const std::string& more = {}) const {
    const auto list = [](const std::vector<std::string>& elements) {
      std::string text;
      for (const std::string& element : elements) text += (text.empty() ? "" : ",") + element;
      return "[" + text + "]";
    };
    return glb(R"({"asset":{"version":"2.0"})" + scenes + R"(,"nodes":)" + nodes + R"(,"meshes":)" + meshes +
                   R"(,"accessors":)" + list(accessors_) + R"(,"bufferViews":)" + list(views_) +
                   R"(,"buffers":[{"byteLength":)" + std::to_string(data_.size()) + "}]" + more + "}",
               data_);
  }

 private:
  std::string data_;
  std::vector<std::string> views_, accessors_;
};

constexpr int k_byte = 5120, k_unsigned_byte = 5121, k_short = 5122, k_unsigned_short = 5123, k_float = 5126;
const std::string k_one_scene = R"(,"scene":0,"scenes":[{"nodes":[0]}])";
const std::string k_cube_mesh = R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])";

/// Corner i of the unit cube is at the bits of i; 12 triangles.
const std::vector<std::uint16_t> k_cube_corners{0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                                2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes;
  for (const T value : values) bytes += little(value);
  return bytes;
}

/// Three numbers of each corner of the cube, `largest` for 1.
template <class T>
std::string cube_points(T largest, T padding_before = 0, bool padded = false) {
  std::string bytes;
  for (unsigned i = 0; i < 8; ++i) {
    for (unsigned k = 0; k < 3; ++k) bytes += little(static_cast<T>(i >> k & 1u ? largest : T{0}));
    if (padded) bytes += little(padding_before);
  }
  return bytes;
}

/// Accessors 0 and 1: the cube's corners and its triangles.
Parts cube() {
  Parts parts;
  parts.accessor(parts.view(cube_points(1.0f)), k_float, "VEC3", 8);
  parts.accessor(parts.view(bytes_of(k_cube_corners)), k_unsigned_short, "SCALAR", 36);
  return parts;
}

class LoadGltfCube : public TestFolder {
 protected:
  Mesh load(const std::string& bytes) const { return load_mesh(write("a.glb", bytes)); }
  std::string message(const std::string& bytes) const { return message_of(write("a.glb", bytes)); }
  /// A node with instances.
  static std::string instanced(const std::string& attributes, const std::string& more = {}) {
    return R"([{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{)" + attributes + "}}}" + more + "}]";
  }
};

TEST_F(LoadGltfCube, InstancesAreCopies) {
  Parts parts = cube();
  parts.accessor(parts.view(bytes_of<float>({0, 0, 0, 5, 0, 0})), k_float, "VEC3", 2);
  for (const char* const list : {R"("extensionsUsed":["EXT_mesh_gpu_instancing"])",
                                 R"("extensionsRequired":["EXT_mesh_gpu_instancing"])", R"("extras":0)"}) {
    const Mesh two =
        load(parts.glb_of(k_one_scene, instanced(R"("TRANSLATION":2)"), k_cube_mesh, std::string(",") + list));
    EXPECT_EQ(two.volume(), 2.0) << list;
    EXPECT_EQ(two.box().max(), Eigen::Vector3d(6, 1, 1));
    EXPECT_TRUE(two.solid());
  }
}

TEST_F(LoadGltfCube, InstancesAreTurnedScaledAndMirroredBelowTheirNode) {
  Parts parts = cube();
  // A quarter turn about z, as normalized shorts; the second one is a mirror.
  parts.accessor(parts.view(bytes_of<std::int16_t>({0, 0, 23170, 23170, 0, 0, 0, 32767})), k_short, "VEC4", 2,
                 R"(,"normalized":true)");
  parts.accessor(parts.view(bytes_of<float>({2, 1, 1, -1, 1, 3})), k_float, "VEC3", 2);
  const Mesh mesh = load(
      parts.glb_of(k_one_scene, instanced(R"("ROTATION":2,"SCALE":3)", R"(,"translation":[10,0,0])"), k_cube_mesh));
  EXPECT_TRUE(mesh.solid()) << mesh.why_not_solid();
  EXPECT_NEAR(mesh.volume(), 5.0, k_sum_rounding);
  EXPECT_LT((mesh.box().min() - Eigen::Vector3d(9, 0, 0)).norm(), 1e-12);
  EXPECT_LT((mesh.box().max() - Eigen::Vector3d(10, 2, 3)).norm(), 1e-12);
}

TEST_F(LoadGltfCube, InstancesThatMakeNoSenseAreRefused) {
  Parts parts = cube();
  parts.accessor(parts.view(bytes_of<float>({0, 0, 0, 5, 0, 0})), k_float, "VEC3", 2);
  parts.accessor(parts.view(bytes_of<float>({1, 1, 1})), k_float, "VEC3", 1);
  parts.accessor(parts.view(bytes_of<float>({0, 0, 0, 0})), k_float, "VEC4", 1);
  const auto with = [&](const char* attributes) {
    return message(parts.glb_of(k_one_scene, instanced(attributes), k_cube_mesh));
  };
  EXPECT_THAT(with(R"("TRANSLATION":2,"SCALE":3)"), HasSubstr("nodes[0]: its instances differ in number"));
  EXPECT_THAT(with(R"("ROTATION":4)"), HasSubstr("nodes[0]: its rotation is no quaternion"));
  EXPECT_THAT(with(""), HasSubstr("nodes[0]: EXT_mesh_gpu_instancing states no instances"));
  EXPECT_THAT(with(R"("TRANSLATION":1)"), HasSubstr("accessors[1]: 3 numbers in an element are expected"));
}

TEST_F(LoadGltfCube, AFileThatPlacesAMeshTooOftenIsRefused) {
  Parts parts = cube();
  std::string node = R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":2}}}})", nodes;
  for (int i = 0; i < 1100; ++i) nodes += (i == 0 ? "[" : ",") + node;
  // 1,100 nodes of 20,000 cubes: without a bound, a GB a second. Copies of nothing take time.
  parts.accessor(parts.view(std::string(240'000, '\0')), k_float, "VEC3", 20'000);
  for (const std::string& mesh :
       {k_cube_mesh, std::string(R"([{"primitives":[{"attributes":{"POSITION":0},"mode":1}]}])")}) {
    EXPECT_THAT(message(parts.glb_of("", nodes + "]", mesh)),
                HasSubstr("more than 20000000 vertices and triangles of copies"));
  }
}

TEST_F(LoadGltfCube, IntegerCoordinatesAreRead) {
  const auto volume = [&](const std::string& points, int component, const char* more, const char* stride = "") {
    Parts parts;
    parts.accessor(parts.view(points, stride), component, "VEC3", 8, more);
    parts.accessor(parts.view(bytes_of(k_cube_corners)), k_unsigned_short, "SCALAR", 36);
    return load(parts.glb_of(k_one_scene, R"([{"mesh":0}])", k_cube_mesh,
                             R"(,"extensionsRequired":["KHR_mesh_quantization"])"))
        .volume();
  };
  const char* const k_normalized = R"(,"normalized":true)";
  EXPECT_EQ(volume(cube_points<std::int16_t>(32767), k_short, k_normalized), 1.0);
  EXPECT_EQ(volume(cube_points<std::int16_t>(-32768), k_short, k_normalized), -1.0) << "-32768 stands for -1 as well";
  EXPECT_EQ(volume(cube_points<std::uint16_t>(65535), k_unsigned_short, k_normalized), 1.0);
  EXPECT_EQ(volume(cube_points<std::int8_t>(127), k_byte, k_normalized), 1.0);
  EXPECT_EQ(volume(cube_points<std::uint8_t>(255), k_unsigned_byte, k_normalized), 1.0);
  EXPECT_EQ(volume(cube_points<std::int16_t>(3), k_short, ""), 27.0);
  EXPECT_EQ(volume(cube_points<std::int8_t>(-2), k_byte, ""), -8.0);
  EXPECT_EQ(volume(cube_points<std::int16_t>(32767, 99, true), k_short, k_normalized, R"(,"byteStride":8)"), 1.0);
}

TEST_F(LoadGltfCube, SparseAccessorsAreRead) {
  const auto file = [&](const std::string& sparse, bool with_base) {
    Parts parts;
    std::string base = cube_points(1.0f);
    base.replace(12 * 7, 12, bytes_of<float>({9, 9, 9}));  // to be patched
    parts.view(base);
    parts.view(bytes_of<std::uint8_t>({7}));
    parts.view(bytes_of<float>({1, 1, 1}));
    parts.view(bytes_of<std::uint32_t>({0, 1, 2, 3, 4, 5, 6, 7}));
    parts.view(cube_points(1.0f));
    parts.accessor(with_base ? R"("bufferView":0,)" : "", k_float, "VEC3", 8, R"(,"sparse":)" + sparse);
    parts.accessor(parts.view(bytes_of(k_cube_corners)), k_unsigned_short, "SCALAR", 36);
    return parts.glb_of(k_one_scene, R"([{"mesh":0}])", k_cube_mesh);
  };
  const std::string one = R"({"count":1,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":2}})";
  const std::string all = R"({"count":8,"indices":{"bufferView":3,"componentType":5125},"values":{"bufferView":4}})";
  EXPECT_EQ(load(file(one, true)).volume(), 1.0);
  EXPECT_EQ(load(file(all, true)).volume(), 1.0);
  EXPECT_EQ(load(file(all, false)).volume(), 1.0) << "what is not stated is zero";
  const auto with = [&](const std::string& part, const std::string& other, bool with_base = true) {
    std::string sparse = all;
    return message(file(sparse.replace(sparse.find(part), part.size(), other), with_base));
  };
  EXPECT_THAT(with(R"("count":8)", R"("count":9)"), HasSubstr("accessors[0].sparse: 9 elements of 8"));
  EXPECT_THAT(with(R"("count":8)", R"("count":18446744073709551615)"), HasSubstr("elements of 8"));
  EXPECT_THAT(with("5125", "5123"), HasSubstr("accepted")) << "twice as many shorts: 0, 0, 1, 0, ...";
  EXPECT_THAT(with(R"("bufferView":4)", R"("bufferView":2)"), HasSubstr("8 elements are out of range of a view of 12"));
  EXPECT_THAT(with("5125", "5126"), HasSubstr("accessors[0].sparse: indices are unsigned integers"));
  EXPECT_THAT(with(R"("bufferView":3)", R"("bufferView":4)"), HasSubstr("is out of range of 8 elements"));
  EXPECT_THAT(with(R"("bufferView":4)", R"("bufferView":77)"), HasSubstr("bufferViews[77] of 6"));
  EXPECT_THAT(message(file("{}", true)), HasSubstr("the JSON is malformed"));
}

TEST_F(LoadGltfCube, RequiredExtensionsThatMayChangeTheSurfaceAreRefusedByName) {
  const Parts parts = cube();
  const auto required = [&](const std::string& names, const char* list = "extensionsRequired") {
    return message(
        parts.glb_of(k_one_scene, R"([{"mesh":0}])", k_cube_mesh, std::string(",\"") + list + "\":[" + names + "]"));
  };
  for (const char* const name :
       {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "CESIUM_RTC", "XYZ_unknown"}) {
    const std::string quoted = '"' + std::string(name) + '"';
    EXPECT_THAT(required(R"("KHR_texture_transform",)" + quoted),
                HasSubstr("a.glb: extensionsRequired: " + std::string(name) + " is not supported"));
    EXPECT_EQ(required(quoted, "extensionsUsed"), "accepted") << "the file says that it can be read without";
  }
  for (const char* const name :
       {"KHR_texture_transform", "KHR_texture_basisu", "EXT_texture_webp", "KHR_materials_unlit",
        "KHR_materials_variants", "KHR_lights_punctual", "KHR_mesh_quantization"}) {
    EXPECT_EQ(required('"' + std::string(name) + '"'), "accepted") << name;
  }
  EXPECT_THAT(required("5"), HasSubstr("the JSON is malformed"));
  EXPECT_THAT(required(R"("\u001b[31m")"), HasSubstr(R"(\x1B[31m is not supported)"));
}

TEST_F(LoadGltfCube, CompressedDataWithoutACopyAreRefusedByName) {
  Parts draco;
  draco.accessor("", k_float, "VEC3", 8);
  draco.accessor("", k_unsigned_short, "SCALAR", 36);
  draco.view("data");
  const std::string primitive =
      R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0}}}]}])";
  EXPECT_THAT(
      message(draco.glb_of(k_one_scene, R"([{"mesh":0}])", primitive)),
      HasSubstr("meshes[0].primitives[0]: is compressed by KHR_draco_mesh_compression, which is not supported"));
  EXPECT_EQ(message(cube().glb_of(k_one_scene, R"([{"mesh":0}])", primitive)), "accepted") << "a copy is there";
  EXPECT_THAT(message(draco.glb_of(k_one_scene, R"([{"mesh":0}])", k_cube_mesh)),
              HasSubstr("accessors[0]: has no data"));
  const std::string meshopt =
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],"buffers":[{"byteLength":36}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36,"extensions":{"EXT_meshopt_compression":{"buffer":1}}}]})";
  EXPECT_THAT(message_of(write("b.gltf", meshopt)),
              HasSubstr("b.gltf: bufferViews[0]: is compressed by EXT_meshopt_compression, which is not supported"));
}

TEST_F(LoadGltfCube, WhichSceneIsReadIsSaid) {
  const Parts parts = cube();
  const std::string nodes =
      R"([{"mesh":0,"children":[1]},{"translation":[5,0,0],"camera":0,"children":[2]},{"mesh":0},)"
      R"({"mesh":0,"scale":[-2,-2,-2]}])";
  const auto read = [&](const std::string& scenes) { return load(parts.glb_of(scenes, nodes, k_cube_mesh)); };
  const Mesh first = read(R"(,"scenes":[{"nodes":[0]},{"nodes":[3]}])");
  EXPECT_EQ(first.volume(), 2.0);
  EXPECT_THAT(first.repairs().notes, ElementsAre("scene 0 of 2 is read, the default one"));
  const Mesh second = read(R"(,"scene":1,"scenes":[{"nodes":[0]},{"nodes":[3]}])");
  EXPECT_EQ(second.volume(), 8.0) << "turned inside out three times, and back";
  EXPECT_THAT(second.repairs().notes, ElementsAre("scene 1 of 2 is read, the default one"));
  const Mesh both = read(R"(,"scenes":[{"nodes":[0,3]}])");
  EXPECT_EQ(both.volume(), 10.0);
  EXPECT_THAT(both.repairs().notes, IsEmpty());
  const Mesh none = read("");
  EXPECT_EQ(none.volume(), 10.0);
  EXPECT_THAT(none.repairs().notes, ElementsAre("the file has no scenes: all nodes are read"));
  EXPECT_EQ(load(parts.glb_of("", "[]", k_cube_mesh)).volume(), 1.0);
  EXPECT_THAT(message(parts.glb_of(R"(,"scene":2,"scenes":[{"nodes":[0]}])", nodes, k_cube_mesh)),
              HasSubstr("scene: scenes[2] of 1"));
  EXPECT_THAT(message(parts.glb_of(R"(,"scenes":[{"nodes":[0,2]}])", nodes, k_cube_mesh)),
              HasSubstr("nodes[2]: is used twice, or below itself"));
}

TEST_F(LoadGltfCube, WhatIsNotAppliedIsSaid) {
  const Parts parts = cube();
  const Mesh mesh =
      load(parts.glb_of(k_one_scene, R"([{"mesh":0,"skin":0,"weights":[1]}])",
                        R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1,"targets":[{"POSITION":0}]}]}])",
                        R"(,"skins":[{"joints":[0]}],"animations":[{"channels":[],"samplers":[]}])"));
  EXPECT_EQ(mesh.volume(), 1.0);
  EXPECT_THAT(mesh.repairs().notes,
              ElementsAre("morph targets are not applied", "skins are not applied: meshes stand as they were bound",
                          "animations are not applied"));
}

TEST_F(LoadGltfCube, StripsAndFansTurnTheRightWay) {
  Parts parts = cube();
  // A tetrahedron as a strip of its four faces, and as a fan of three with the fourth apart.
  const std::vector<std::uint16_t> strip{0, 1, 2, 4, 0, 1}, fan{0, 2, 1, 4, 2}, last{1, 2, 4};
  parts.accessor(parts.view(bytes_of(strip)), k_unsigned_short, "SCALAR", strip.size());
  parts.accessor(parts.view(bytes_of(fan)), k_unsigned_short, "SCALAR", fan.size());
  parts.accessor(parts.view(bytes_of(last)), k_unsigned_short, "SCALAR", last.size());
  const Mesh of_strip = load(parts.glb_of(k_one_scene, R"([{"mesh":0}])",
                                          R"([{"primitives":[{"attributes":{"POSITION":0},"indices":2,"mode":5}]}])"));
  EXPECT_TRUE(of_strip.topology().closed && of_strip.topology().oriented) << of_strip.why_not_solid();
  EXPECT_NEAR(std::abs(of_strip.volume()), 1.0 / 6.0, k_rounding);
  const Mesh of_fan = load(parts.glb_of(k_one_scene, R"([{"mesh":0}])",
                                        R"([{"primitives":[{"attributes":{"POSITION":0},"indices":3,"mode":6},)"
                                        R"({"attributes":{"POSITION":0},"indices":4}]}])"));
  EXPECT_TRUE(of_fan.solid()) << of_fan.why_not_solid();
  EXPECT_NEAR(of_fan.volume(), 1.0 / 6.0, k_rounding);
}

TEST_F(LoadGltfCube, TransformsAreInDoublePrecision) {
  const Mesh mesh = load(cube().glb_of(k_one_scene, R"([{"mesh":0,"translation":[0.1,0.2,0.3]}])", k_cube_mesh));
  EXPECT_EQ(mesh.box().min(), Eigen::Vector3d(0.1, 0.2, 0.3));
}

TEST_F(LoadGltfCube, ContainersOfAnyChunks) {
  std::string good = cube().glb_of(k_one_scene, R"([{"mesh":0}])", k_cube_mesh);
  const auto sized = [](std::string bytes) {
    return bytes.replace(8, 4, little(static_cast<std::uint32_t>(bytes.size())));
  };
  EXPECT_EQ(message(sized(good + little(std::uint32_t{4}) + "OTHRdata")), "accepted");
  EXPECT_THAT(message(sized(good + "1234567")), HasSubstr("is cut off in a chunk's header"));
  EXPECT_THAT(message(sized(good + little(std::uint32_t{9}) + "OTHRdata")), HasSubstr("a chunk of 9 bytes is cut off"));
  EXPECT_THAT(message(sized(good + little(std::uint32_t{4}) + "JSON{}  ")), HasSubstr("one chunk has to be JSON"));
  good.replace(4, 4, little(std::uint32_t{1}));
  EXPECT_THAT(message(good), HasSubstr("byte 4: version 2 is expected"));
}

}  // namespace
}  // namespace sixdof
