#include <sixdof/models/manifest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/save.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/models/recipe.h>

namespace sixdof {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// An empty folder of fetched models.
class FetchedModels : public ::testing::Test {
 protected:
  FetchedModels() : folder_(std::filesystem::temp_directory_path() / ("sixdof-models-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
    ::setenv("SIXDOF_MODELS", folder_.c_str(), 1);
  }
  ~FetchedModels() override {
    ::unsetenv("SIXDOF_MODELS");
    std::filesystem::remove_all(folder_);
  }

  static std::string message_for(const std::string& name) {
    try {
      load_model(name);
    } catch (const BadFile& e) {
      return e.what();
    }
    return "loaded";
  }

  std::filesystem::path folder_;
};

TEST(Manifest, EntriesAreCompleteAndNamesUnique) {
  EXPECT_GE(fetched_models().size(), 12U);
  std::set<std::string_view> names;
  for (const Recipe& recipe : recipes()) names.insert(recipe.name);
  for (const FetchedModel& model : fetched_models()) {
    EXPECT_TRUE(names.insert(model.name).second) << model.name;
    EXPECT_FALSE(parse_model_name(model.name).triangles) << model.name;
    EXPECT_TRUE(model.closed && model.manifold) << model.name;
    EXPECT_GT(model.triangles, 1000U);
    EXPECT_GT(model.size.minCoeff(), 0.0);
    EXPECT_EQ(model.hash.size(), 32U);
    EXPECT_FALSE(model.licence.empty() || model.package.empty() || model.summary.empty()) << model.name;
  }
}

TEST_F(FetchedModels, MissingFileIsReportedWithItsCommand) {
  EXPECT_THAT(message_for("bear"), AllOf(HasSubstr((folder_ / "bear.off").string()), HasSubstr("models/fetch bear")));
}

TEST_F(FetchedModels, DamagedFileIsRefused) {
  std::ofstream(folder_ / "bear.off") << "OFF\n3 1 0\n0 0 0\n1 0";
  EXPECT_THAT(message_for("bear"), AllOf(HasSubstr("bear.off"), HasSubstr("models/fetch bear")));
}

TEST_F(FetchedModels, AnotherMeshIsRefused) {
  const Mesh torus = make_torus({}, 27648);  // as many triangles as the bear
  save_mesh(torus, folder_ / "bear.off");
  EXPECT_THAT(message_for("bear"),
              AllOf(HasSubstr("bear.off"), HasSubstr(torus.hash()), HasSubstr("models/fetch bear")));
  EXPECT_EQ(load_model((folder_ / "bear.off").string()).hash(), torus.hash())
      << "a file by its path is not compared with the manifest";
}

TEST_F(FetchedModels, AreNotCoarsened) {
  try {
    load_model("bear-1k");
    FAIL() << "a bear of 1,000 triangles was made";
  } catch (const BadArgument& e) {
    EXPECT_THAT(e.what(), HasSubstr("bear has 27648 triangles"));
  }
}

TEST(Manifest, DescribesTheFetchedModels) {
  std::size_t seen = 0;
  for (const FetchedModel& model : fetched_models()) {
    if (!std::filesystem::exists(model_cache() / model.file)) continue;
    const Mesh mesh = load_model(model.name);
    EXPECT_EQ(mesh.name(), model.name);
    EXPECT_EQ(mesh.triangles().size(), model.triangles);
    EXPECT_TRUE(mesh.solid()) << model.name << ": " << mesh.why_not_solid();
    EXPECT_EQ(mesh.topology().manifold, model.manifold);
    const auto handles =
        static_cast<std::int64_t>(mesh.topology().components) - mesh.topology().euler_characteristic / 2;
    EXPECT_EQ(handles, static_cast<std::int64_t>(model.genus)) << model.name;
    EXPECT_LT((mesh.box().sizes() - model.size).norm(), 1e-3 * model.size.norm());  // four digits
    ++seen;
  }
  EXPECT_GT(seen, 0u) << "run models/fetch";
}

}  // namespace
}  // namespace sixdof
