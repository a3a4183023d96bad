#include <sixdof/configuration/set_catalogue.h>

#include <unistd.h>

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "small_suite.h"

namespace sixdof {
namespace {

using ::testing::HasSubstr;

TEST(SetCatalogue, ReadsAManifestWithoutOpeningSets) {
  const test::SuiteCopy suite(SIXDOF_SMALL_SUITE);
  std::filesystem::remove(suite.directory() / "torus-1k.h5");
  const SetCatalogue catalogue = SetCatalogue::read(suite.manifest());
  ASSERT_EQ(catalogue.sets().size(), 2u);
  EXPECT_EQ(catalogue.sets()[0].pair, "torus-1k");
  EXPECT_EQ(catalogue.sets()[1].b, "cone-1k");
  EXPECT_EQ(catalogue.sets()[1].file, suite.directory() / "torus-1k-cone-1k.h5");
  EXPECT_EQ(catalogue.sets()[0].buckets.size(), test::SmallSuite::buckets().size());
}

TEST(SetCatalogue, NamesAUsersSetAfterItsMeshes) {
  const test::SuiteCopy suite(SIXDOF_SMALL_SUITE);
  const ConfigurationSet set(suite.directory() / "torus-1k-cone-1k.h5");
  const auto& [version, a, b, grid, volume_grid] = set.description();
  SetCatalogue catalogue;
  const CatalogueEntry entry = catalogue.add(set.path(), a, b, {{BucketKind::distance, 0.5}});
  EXPECT_EQ(entry.pair, "torus-1k-cone-1k");
  EXPECT_EQ(entry.a, "torus-1k");
  EXPECT_EQ(entry.buckets.size(), 1u);
  EXPECT_EQ(catalogue.mesh("cone-1k")->identity.hash, b.hash);
  EXPECT_EQ(catalogue.mesh("cone-1k")->set, set.path());
  EXPECT_EQ(catalogue.mesh("cone-2k"), nullptr);
  EXPECT_THROW(catalogue.add(set.path(), a, b, {}), BadArgument) << "the same pair again";
}

TEST(SetCatalogue, KeepsMeshesOfOneNameApart) {
  const auto mesh = [](const std::string& name, const std::string& hash) {
    return MeshIdentity{.name = name, .hash = hash, .path = hash + "/" + name + ".obj"};
  };
  const MeshIdentity first = mesh("My Part", "0123456789ab"), second = mesh("My Part", "fedcba987654");
  SetCatalogue catalogue;
  const CatalogueEntry both = catalogue.add("1.h5", first, second, {});
  EXPECT_EQ(both.pair, "my-part-my-part");
  EXPECT_EQ(both.a, "my-part@01234567");
  EXPECT_EQ(both.b, "my-part@fedcba98");
  EXPECT_EQ(catalogue.mesh(both.b)->identity.path, second.path);
  EXPECT_EQ(catalogue.add("2.h5", first, first, {}).pair, "my-part");
  EXPECT_EQ(catalogue.add("3.h5", second, second, {}).pair, "my-part-fedcba98-fedcba98");
  EXPECT_THROW(catalogue.add("4.h5", first, first, {}), BadArgument);
  // A file is never taken for the model of its name.
  EXPECT_EQ(catalogue.mesh("my-part"), nullptr);
}

TEST(SetCatalogue, SaysWhatIsWrongWithAManifest) {
  const auto file =
      std::filesystem::temp_directory_path() / ("sixdof-bad-manifest" + std::to_string(::getpid()) + ".json");
  for (const char* bad :
       {"", "{", "[]", R"({"sets": [{"pair": "x"}]})",
        R"({"sets": [{"pair": "X y", "a": {"name": "s"}, "b": {"name": "s"}, "file": "f", "buckets": []}]})",
        R"({"sets": [{"pair": "x", "a": {"name": "s"}, "b": {"name": "s"}, "file": "f", "buckets": ["speed/1"]}]})"}) {
    std::ofstream(file) << bad;
    try {
      SetCatalogue::read(file);
      ADD_FAILURE() << bad;
    } catch (const BadFile& e) {
      EXPECT_THAT(e.what(), HasSubstr(file.filename().string() + ": set 0: ")) << bad;
    }
  }
  std::filesystem::remove(file);
  EXPECT_THROW(SetCatalogue::read(file), BadFile);
}

}  // namespace
}  // namespace sixdof
