#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/hdf5.h>
#include <sixdof/models/model_catalogue.h>

namespace sixdof {
namespace {

/// Content hashes of a cache's files by their names. A name has the hash of the key, and the key has the version of the
/// structure.
std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> result;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const hdf5::Session session;
    result[file.path().stem().string()] = hdf5::File::open(file.path()).read_string("/", "content");
  }
  return result;
}

// A cache on disk outlives the program that filled it. What this build prepares must be what a program of the same
// version kept.
TEST(CachedBits, BelongToTheirVersions) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "cached_bits";
  std::filesystem::remove_all(folder);
  ::setenv("SIXDOF_CACHE", folder.c_str(), 1);
  const Mesh a = load_model("torus-knot-1k");
  const Mesh b = load_model("cone-1k");
  Registry registry;
  register_core_algorithms(registry);
  for (const auto& [name, parameters] :
       std::map<std::string, std::vector<std::string>>{{"ist", {"spheres=200", "spheres_b=100"}},
                                                       {"vps", {"voxel_size=0.05"}},
                                                       {"vps-field", {"voxel_size=0.05"}}}) {
    const Algorithm& algorithm = registry.find(name);
    Settings settings = algorithm.settings();
    settings.set_all(parameters);
    ASSERT_NE(algorithm.prepare(a, b, settings), nullptr);
  }
  ::unsetenv("SIXDOF_CACHE");
  const std::map<std::string, std::string> known{
      {"ist-cones-80119df10744f849aa165c6bf697b36a", "cc189eb9174ab37d8c4d32607d39811a"},
      {"ist-cones-f6daaa1d3f39aeb438dc5cb9e078448d", "e7c3622d113f6dc93cb31b09258f0636"},
      {"ist-packing-170c00af3499cb22dfe3d1264f0f7974", "d18592cc60a8a7bdca79b22e22b6e770"},
      {"ist-packing-8b5170387e6d72734026cadf1c9437a1", "2141c2facc6a9077efd0c7bab790f26d"},
      {"vps-field-43f173dd6491b3b9c1d9b69e0adb07b5", "15e8daa0b8dbed0ae979e74240b074aa"},
      {"vps-pointshell-f9241392fe44003c96880d88f4e8a7f1", "2d4241adb3c7cacc09c58ec523ab81d5"},
      {"vps-voxelmap-5b59bb6e9294ffa044a3599eafb8953b", "6bfa1d8fb4150ab4963adac9267da23a"},
  };
  EXPECT_EQ(contents(folder), known)
      << "a structure has other bits, or another key: raise the version in its key, and name file and content here";
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sixdof
