#include <sixdof/configuration/set_catalogue.h>

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
  SetCatalogue catalogue;
  catalogue.add_file(suite.directory() / "torus-1k-cone-1k.h5");
  ASSERT_EQ(catalogue.sets().size(), 1u);
  EXPECT_EQ(catalogue.sets()[0].pair, "torus-1k-cone-1k");
  EXPECT_EQ(catalogue.sets()[0].buckets.size(), 3u);
  EXPECT_THROW(catalogue.add_file(suite.directory() / "torus-1k-cone-1k.h5"), BadArgument);
}

TEST(SetCatalogue, SaysWhatIsWrongWithAManifest) {
  const auto file = std::filesystem::temp_directory_path() / "sixdof-bad-manifest.json";
  for (const char* bad :
       {"", "{", "[]", R"({"sets": [{"pair": "x"}]})",
        R"({"sets": [{"pair": "X y", "a": {"name": "s"}, "b": {"name": "s"}, "file": "f", "buckets": []}]})",
        R"({"sets": [{"pair": "x", "a": {"name": "s"}, "b": {"name": "s"}, "file": "f", "buckets": ["speed/1"]}]})"}) {
    std::ofstream(file) << bad;
    try {
      SetCatalogue::read(file);
      ADD_FAILURE() << bad;
    } catch (const BadFile& e) {
      EXPECT_THAT(e.what(), HasSubstr("sixdof-bad-manifest.json: set 0: ")) << bad;
    }
  }
  std::filesystem::remove(file);
  EXPECT_THROW(SetCatalogue::read(file), BadFile);
}

}  // namespace
}  // namespace sixdof
