// Files that are made to end their reader: each ends its own import only, in a BadFile with words. What assimp reads,
// it gives as it does in this process.
#include <sys/wait.h>

#include <atomic>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include <sixdof/geometry/load_formats.h>

#include "float_torus.h"
#include "mesh_files.h"
#include "scene_files.h"

namespace sixdof {
namespace {

using namespace testing_support;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::size_t k_levels = 100'000;

std::string repeated(const std::string& text, std::size_t count) {
  std::string result;
  result.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i) result += text;
  return result;
}

class HostileFile : public TestFolder {
 protected:
  /// The file is read, or refused by words that name it: either way this process goes on.
  void ends(const std::string& name, const std::string& bytes) const {
    const auto file = write(name, bytes);
    EXPECT_THAT(message_of(file), AnyOf("accepted", StartsWith(file.string() + ": ")));
  }
  /// The file is refused by words that name it.
  std::string refusal(const std::string& name, const std::string& bytes) const {
    const auto file = write(name, bytes);
    const std::string message = message_of(file);
    EXPECT_THAT(message, StartsWith(file.string() + ": "));
    return message.substr(std::min(message.size(), file.string().size() + 2));
  }
};

std::string x3d(const std::string& scene) {
  return R"(<?xml version="1.0"?><X3D version="3.0"><Scene>)" + scene + "</Scene></X3D>";
}

const std::string k_shape =
    R"(<Shape><IndexedFaceSet coordIndex="0 2 1 -1 0 1 3 -1 0 3 2 -1 1 2 3 -1"><Coordinate point="0 0 0 1 0 0 0 1 0 0 0 1"/>)"
    "</IndexedFaceSet></Shape>";

TEST_F(HostileFile, X3dNestedDeeply) {
  for (const char* const name : {"Group", "Transform", "Switch"}) {
    const std::string tag = name;
    ends("a.x3d", x3d(repeated("<" + tag + ">", k_levels) + k_shape + repeated("</" + tag + ">", k_levels)));
  }
  refusal("b.x3d", x3d(repeated("<Group>", k_levels)));
}

TEST_F(HostileFile, X3dGroupsThatUseThemselves) {
  // Every level doubles what is below it.
  std::string doubled = k_shape;
  for (int i = 0; i < 26; ++i) {
    const std::string name = "G" + std::to_string(i);
    std::string outer = "<Group DEF=\"";
    outer.append(name).append("\">").append(doubled).append("</Group><Group USE=\"").append(name).append("\"/>");
    doubled = outer;
  }
  EXPECT_THAT(refusal("a.x3d", x3d(doubled)), HasSubstr("assimp, which reads this format, "));
  ends("b.x3d", x3d("<Group DEF=\"G\"><Group USE=\"G\"/>" + k_shape + "</Group>"));
  ends("c.x3d",
       x3d("<Group DEF=\"A\"><Group DEF=\"B\"><Group USE=\"A\"/></Group></Group><Group USE=\"B\"/>" + k_shape));
}

TEST_F(HostileFile, ColladaNestedDeeply) {
  const std::string good = collada_pyramid("2 2 0");
  const auto with = [&](const std::string& part, const std::string& other) {
    std::string bytes = good;
    return bytes.replace(bytes.find(part), part.size(), other);
  };
  const std::string node = "<instance_geometry url=\"#g\"/>";
  refusal("a.dae", with(node, repeated("<node>", k_levels) + node + repeated("</node>", k_levels)));
  refusal("b.dae", with(node, repeated("<node>", k_levels)));
  // Deep where nobody looks: read, or refused.
  ends("c.dae", with(node, node + "<extra>" + repeated("<a>", k_levels) + repeated("</a>", k_levels) + "</extra>"));
}

TEST_F(HostileFile, ColladaNodesThatUseThemselves) {
  std::string library;
  for (int i = 0; i < 30; ++i) {
    const std::string below = i == 0 ? std::string("<instance_geometry url=\"#g\"/>")
                                     : repeated("<instance_node url=\"#n" + std::to_string(i - 1) + "\"/>", 2);
    library += "<node id=\"n" + std::to_string(i) + "\">" + below + "</node>";
  }
  std::string bytes = collada_pyramid("2 2 0");
  bytes.replace(bytes.find("<library_visual_scenes>"), 0, "<library_nodes>" + library + "</library_nodes>");
  const std::string geometry = "<instance_geometry url=\"#g\"/></node></visual_scene>";
  bytes.replace(bytes.find(geometry), geometry.size(), "<instance_node url=\"#n29\"/></node></visual_scene>");
  EXPECT_THAT(refusal("a.dae", bytes), HasSubstr("assimp"));
  std::string cycle = collada_pyramid("2 2 0");
  cycle.replace(cycle.find(geometry), geometry.size(), "<instance_node url=\"#n\"/></node></visual_scene>");
  refusal("b.dae", cycle);
}

TEST_F(HostileFile, FbxNestedDeeply) {
  const std::string good = fbx_pyramid("-5");
  const std::string deep = repeated("A: {\n", k_levels);
  refusal("a.fbx", good + deep);
  refusal("b.fbx", "; FBX 7.3.0 project file\n" + deep + repeated("}\n", k_levels));
  ends("c.fbx", good + deep + repeated("}\n", k_levels));
}

TEST_F(HostileFile, ArchivesThatUnpackToMoreThanIsAllowed) {
  // Stored and deflated entries whose headers state sizes that nobody has.
  const auto entry = [](std::uint32_t packed, std::uint32_t unpacked, std::uint16_t method) {
    const std::string name = "3D/3dmodel.model";
    const std::string fields = little(std::uint16_t{20}) + little(std::uint16_t{0}) + little(method) +
                               little(std::uint32_t{0}) + little(std::uint32_t{0}) + little(packed) + little(unpacked) +
                               little(static_cast<std::uint16_t>(name.size())) + little(std::uint16_t{0});
    const std::string local = "PK\3\4" + fields + name + std::string(64, '\0');
    const std::string central =
        "PK\1\2" + little(std::uint16_t{20}) + fields + std::string(10, '\0') + little(std::uint32_t{0}) + name;
    return local + central + "PK\5\6" + std::string(4, '\0') + little(std::uint16_t{1}) + little(std::uint16_t{1}) +
           little(static_cast<std::uint32_t>(central.size())) + little(static_cast<std::uint32_t>(local.size())) +
           std::string(2, '\0');
  };
  for (const auto method : {std::uint16_t{0}, std::uint16_t{8}}) {
    refusal("a.3mf", entry(64, 0xFFFFFFF0u, method));
    refusal("b.3mf", entry(0xFFFFFFF0u, 0xFFFFFFF0u, method));
    refusal("c.zae", entry(64, 0xFFFFFFF0u, method));
  }
}

TEST_F(HostileFile, HugeCounts) {
  std::string bytes = collada_pyramid("2 2 0");
  const std::string count = R"(count="15")";
  for (const char* const other : {"4000000000", "18446744073709551615", "-1"}) {
    std::string damaged = bytes;
    ends("a.dae", damaged.replace(damaged.find(count), count.size(), std::string("count=\"") + other + '"'));
    damaged = bytes;
    ends("b.dae", damaged.replace(damaged.find(R"(count="5")"), 9, std::string("count=\"") + other + '"'));
    damaged = fbx_pyramid("-5");
    ends("c.fbx", damaged.replace(damaged.find("*15"), 3, std::string("*") + other));
  }
}

class SeparateImport : public TestFolder {
 protected:
  static loading::FileMesh here(const std::filesystem::path& file) {
    loading::FileMesh surface;
    loading::read_by_assimp(loading::read_source(file), loading::FileFrame::metres,
                            [&](loading::FileMesh&& read) { surface = std::move(read); });
    return surface;
  }
};

TEST_F(SeparateImport, GivesTheSameBits) {
  for (const auto& file :
       {write("a.dae", collada_pyramid("2 2 0.5")), write("b.x3d", x3d_pyramid()), write("c.fbx", fbx_pyramid("-5")),
        write("d.3ds", file_3ds(object_3ds(float_torus(), {3})))}) {
    const loading::FileMesh one = here(file);
    const loading::FileMesh other =
        loading::read_by_assimp_separately(loading::read_source(file), loading::FileFrame::metres);
    EXPECT_EQ(one.vertices, other.vertices) << file;
    EXPECT_EQ(one.triangles, other.triangles);
    EXPECT_EQ(one.repairs.notes, other.repairs.notes);
    EXPECT_EQ(text_of(one.repairs.forgiven), text_of(other.repairs.forgiven));
    EXPECT_EQ(message_of(file), "accepted");
  }
}

TEST_F(SeparateImport, SeveralThreadsAtOnce) {
  const auto good = write("a.fbx", fbx_pyramid("-5")), bad = write("b.fbx", fbx_pyramid("-9")),
             deadly = write("c.x3d", x3d(repeated("<Group>", k_levels)));
  const std::string hash = load_mesh(good).hash();
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 10; ++i) {
        if (load_mesh(good).hash() != hash) ++wrong;
        if (message_of(bad).find("vertex index out of range") == std::string::npos) ++wrong;
        if (i % 5 == t && message_of(deadly) == "accepted") ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

TEST_F(SeparateImport, NoProcessIsLeft) {
  message_of(write("a.fbx", fbx_pyramid("-5")));
  message_of(write("b.x3d", x3d(repeated("<Group>", k_levels))));
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
}

}  // namespace
}  // namespace sixdof
