#include <sixdof/models/manifest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <sixdof/geometry/shape_facts.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/models/recipe.h>

namespace sixdof {
namespace {

constexpr double k_listed_digits = 1e-4;  // of values that the list keeps in four digits

TEST(Collection, HasAHundredClosedObjectsOfEveryKindAndSize) {
  std::map<std::string, std::size_t> kinds;
  std::size_t closed = 0;
  bool open_seen = false;
  for (const CollectionObject& object : collection()) {
    EXPECT_GE(object.triangles, 1'000U) << object.name;
    EXPECT_LE(object.triangles, 2'000'000U) << object.name;
    EXPECT_EQ(object.hash.size(), 32U) << object.name;
    EXPECT_FALSE(object.licence.empty()) << object.name;
    open_seen = open_seen || !object.closed;
    EXPECT_NE(object.closed, open_seen) << "closed objects come first: " << object.name;
    if (!object.closed) continue;
    ++closed;
    ++kinds[object.kind];
  }
  EXPECT_GE(closed, 100U);
  for (const char* kind : {"scan", "cad", "organic", "thin", "handles", "boxy"}) EXPECT_GE(kinds[kind], 5U) << kind;
  EXPECT_EQ(kinds.size(), 6U);
  const auto largest = std::ranges::max(collection(), {}, &CollectionObject::triangles);
  EXPECT_EQ(largest.triangles, 2'000'000U);
}

TEST(Collection, NamesAndHashesAreUniqueAndNamesAreNoCounts) {
  std::set<std::string> names, hashes;
  for (const CollectionObject& object : collection()) {
    EXPECT_TRUE(names.insert(object.name).second) << object.name;
    EXPECT_TRUE(hashes.insert(object.hash).second) << object.name;
    EXPECT_EQ(parse_model_name(object.name).triangles.has_value(), object.source == "recipe") << object.name;
  }
  for (const FetchedModel& model : collection_files()) {
    for (const FetchedModel& other : fetched_models()) {
      EXPECT_NE(model.name, other.name);
      EXPECT_NE(model.file, other.file);
    }
  }
}

TEST(Collection, NothingIsLeftOutWithoutAReason) {
  EXPECT_FALSE(left_out_of_collection().empty());
  for (const LeftOut& file : left_out_of_collection()) EXPECT_FALSE(file.reason.empty()) << file.path;
}

/// The manifest's facts, of recipes up to a size that takes no time, and of files that are fetched.
TEST(Collection, IsWhatTheManifestSays) {
  constexpr std::size_t k_quick = 20'000;
  std::size_t seen = 0;
  for (const CollectionObject& object : collection()) {
    if (object.triangles > k_quick) continue;
    const auto file = std::ranges::find(collection_files(), object.name, &FetchedModel::name);
    if (object.source != "recipe" &&
        (file == collection_files().end() || !std::filesystem::exists(model_cache() / file->file))) {
      continue;
    }
    const Mesh mesh = load_model(object.name);
    EXPECT_EQ(mesh.hash(), object.hash) << object.name;
    EXPECT_EQ(mesh.triangles().size(), object.triangles) << object.name;
    EXPECT_EQ(mesh.solid(), object.closed) << object.name;
    EXPECT_EQ(mesh.topology().components, object.shells) << object.name;
    const ShapeFacts facts = shape_facts(mesh);
    EXPECT_EQ(facts.genus, object.genus) << object.name;
    EXPECT_NEAR(facts.box_aspect, object.box_aspect, k_listed_digits) << object.name;
    EXPECT_NEAR(facts.box_fill, object.box_fill, k_listed_digits) << object.name;
    EXPECT_EQ(name_of(kind_of(facts)), object.kind == "scan" ? "organic" : object.kind) << object.name;
    ++seen;
  }
  EXPECT_GE(seen, 20U);  // the recipes
}

}  // namespace
}  // namespace sixdof
