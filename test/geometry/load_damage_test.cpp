// Damaged files: cut off anywhere, or with bytes changed. load_mesh() returns a valid mesh or throws a BadFile. Assimp
// is tested with 3DS here; what makes it crash is in separate_import_test.cpp.
#include <sys/resource.h>

#include <optional>
#include <set>

#include <gmock/gmock.h>

#include <sixdof/geometry/save.h>

#include "mesh_files.h"
#include "scene_files.h"

namespace sixdof {
namespace {

using namespace testing_support;
using ::testing::HasSubstr;

const Mesh& torus() {
  static const Mesh mesh = bumpy_torus(5, 4, 0.73, 7);
  return mesh;
}

std::string text_of(const char* format) {
  const auto number = [](double x) {
    char text[40];
    std::snprintf(text, sizeof(text), "%.17g", x);
    return std::string(text);
  };
  const auto point = [&](std::uint32_t v) {
    const auto& p = torus().vertices()[v];
    return number(p.x()) + " " + number(p.y()) + " " + number(p.z()) + "\n";
  };
  std::string text;
  if (std::string(format) == "stl") {
    for (const Triangle& t : torus().triangles()) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const std::uint32_t v : t) text += "vertex " + point(v);
      text += "endloop\nendfacet\n";
    }
    return "solid torus\n" + text + "endsolid torus\n";
  }
  for (std::uint32_t v = 0; v < torus().vertices().size(); ++v) text += point(v);
  for (const Triangle& t : torus().triangles()) {
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  }
  return "ply\nformat ascii 1.0\nelement vertex 20\nproperty double x\nproperty double y\nproperty double z\n"
         "element face 40\nproperty list uchar int vertex_indices\nend_header\n" +
         text;
}

struct Kind {
  const char* name;
  const char* file;
  bool counted;  ///< The format says somewhere how long it is.
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

class Damage : public TestFolder, public ::testing::WithParamInterface<Kind> {
 protected:
  std::string good() const {
    const std::string name = GetParam().name;
    if (name == "ply_text") return text_of("ply");
    if (name == "stl_text") return text_of("stl");
    if (name == "glb") return glb(gltf_json(torus(), "", R"([{"mesh":0}])"), gltf_data(torus()));
    if (name == "gltf") {
      const std::string data = R"(,"uri":"data:;base64,)" + base64(gltf_data(torus())) + '"';
      return gltf_json(torus(), data, R"([{"mesh":0,"translation":[0.5,0.25,3]}])");
    }
    if (name == "3ds") return file_3ds(object_3ds(torus()));
    save_mesh(torus(), path(GetParam().file));
    return read(path(GetParam().file));
  }

  /// The mesh, or nothing if the file was refused with a message that names it. Everything else fails.
  std::optional<Mesh> load(const std::string& bytes) const {
    const auto file = write(GetParam().file, bytes);
    try {
      Mesh mesh = load_mesh(file);
      for (const auto& p : mesh.vertices()) EXPECT_TRUE(p.allFinite());
      for (const Triangle& t : mesh.triangles()) {
        for (const std::uint32_t v : t) EXPECT_LT(v, mesh.vertices().size());
      }
      return mesh;
    } catch (const BadFile& e) {
      EXPECT_THAT(e.what(), HasSubstr(file.string() + ": "));
      return std::nullopt;
    }
  }
};

TEST_P(Damage, CutOffAnywhereItIsRefusedOrWhole) {
  const std::string bytes = good();
  const std::optional<Mesh> whole = load(bytes);
  ASSERT_TRUE(whole);
  std::size_t refused = 0;
  // Every length near both ends, and random ones between.
  std::mt19937_64 generator(31337);
  std::set<std::size_t> lengths;
  for (std::size_t i = 0; i < std::min<std::size_t>(bytes.size(), 250); ++i) {
    lengths.insert({i, bytes.size() - 1 - i, generator() % bytes.size()});
  }
  for (const std::size_t length : lengths) {
    const std::optional<Mesh> mesh = load(bytes.substr(0, length));
    refused += mesh ? 0 : 1;
    if (!mesh) continue;
    // The last line needs no line break, so its last number may be cut. Everything before it must be right.
    const bool cut_in_number = bytes[length - 1] != '\n' && bytes[length - 1] != ' ' && bytes[length] != '\n';
    if (GetParam().counted && mesh->hash() != whole->hash()) {
      ASSERT_TRUE(cut_in_number) << length << " of " << bytes.size() << " bytes";
      ASSERT_EQ(bytes.find_first_of(" \n", length), bytes.size() - 1) << length << " of " << bytes.size() << " bytes";
    }
    if (!GetParam().counted) {
      ASSERT_LE(mesh->triangles().size(), whole->triangles().size());
      const std::size_t right = mesh->triangles().size() - (cut_in_number ? 1 : 0);
      for (std::size_t i = 0; i < right; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          ASSERT_EQ(mesh->vertices()[mesh->triangles()[i][k]], whole->vertices()[whole->triangles()[i][k]]);
        }
      }
    }
  }
  EXPECT_GT(refused, (GetParam().counted ? 9 : 8) * lengths.size() / 10);
}

TEST_P(Damage, BytesChangedAtRandomNeverEndInMoreThanAnError) {
  const std::string bytes = good();
  std::mt19937_64 generator(20261121);
  constexpr int k_trials = 300;
  int refused = 0;
  for (int trial = 0; trial < k_trials; ++trial) {
    std::string damaged = bytes;
    // Half of the trials hit the beginning, where counts and names are.
    const std::size_t range = trial % 2 == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 400);
    for (std::uint64_t i = 0, n = 1 + generator() % 4; i < n; ++i) {
      damaged[generator() % range] = static_cast<char>(generator() & 0xFF);
    }
    if (!load(damaged)) ++refused;
  }
  EXPECT_GT(refused, 0);
}

TEST_P(Damage, PiecesRemovedDoubledOrSwappedNeverEndInMoreThanAnError) {
  const std::string bytes = good();
  std::mt19937_64 generator(5150);
  for (int trial = 0; trial < 100; ++trial) {
    std::string damaged = bytes;
    const std::size_t at = generator() % damaged.size();
    const std::size_t length = 1 + generator() % 40;
    const std::string piece = damaged.substr(at, length);
    if (trial % 3 != 1) damaged.erase(at, length);
    if (trial % 3 != 0) damaged.insert(generator() % damaged.size(), piece);
    load(damaged);
  }
}

constexpr Kind k_kinds[] = {
    {"ply_binary", "a.ply", true}, {"ply_text", "b.ply", true},   {"off", "a.off", true},
    {"obj", "a.obj", false},       {"stl_binary", "a.stl", true}, {"stl_text", "b.stl", true},
    {"glb", "a.glb", true},        {"gltf", "a.gltf", true},      {"3ds", "a.3ds", true},
};

INSTANTIATE_TEST_SUITE_P(Formats, Damage, ::testing::ValuesIn(k_kinds),
                         [](const auto& case_info) { return std::string(case_info.param.name); });

class HugeCounts : public TestFolder {};

TEST_F(HugeCounts, NoMemoryIsTakenForWhatIsNotThere) {
  // A tiny file that claims two billion elements; 2 GB would show in the process's peak.
  const auto peak = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;  // KiB
  };
  const auto before = peak();
  const std::string count = "2000000000";
  EXPECT_NE(message_of(write("a.off", "OFF\n" + count + " " + count + " 0\n0 0 0\n")), "accepted");
  EXPECT_NE(message_of(write("a.ply", "ply\nformat binary_little_endian 1.0\nelement vertex " + count +
                                          "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                                          count + "\nproperty list int int vertex_indices\nend_header\nxyz")),
            "accepted");
  EXPECT_NE(message_of(write("a.stl", std::string(80, ' ') + little(2'000'000'000u) + "xyz")), "accepted");
  const Mesh small = bumpy_torus(5, 4, 0.73, 7);
  std::string json = gltf_json(small, "", R"([{"mesh":0}])");
  json.replace(json.find(R"("bufferView":0,)"), 15,
               R"("sparse":{"count":1,"indices":{"bufferView":1,"componentType":5123},)"
               R"("values":{"bufferView":0}},)");
  json.replace(json.find(R"("count":20)"), 10, R"("count":)" + count);
  EXPECT_NE(message_of(write("a.glb", glb(json, gltf_data(small)))), "accepted");
  EXPECT_LT(peak() - before, 500'000);
}

}  // namespace
}  // namespace sixdof
