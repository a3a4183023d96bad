#include <sixdof/models/recipe.h>

#include <set>
#include <string>

#include <gtest/gtest.h>

#include <sixdof/geometry/shape_facts.h>
#include <sixdof/models/model_catalogue.h>

namespace sixdof {
namespace {

class EveryVariant : public ::testing::TestWithParam<Recipe> {};

TEST_P(EveryVariant, IsAClosedManifoldOfTheRequestedCountAndGenus) {
  const Recipe& recipe = GetParam();
  for (const std::size_t n : {recipe.minimum, std::size_t{12'345}}) {
    const Mesh mesh = recipe.make(n);
    EXPECT_EQ(mesh.triangles().size(), n + n % 2);
    EXPECT_TRUE(mesh.solid()) << mesh.why_not_solid();
    EXPECT_TRUE(mesh.topology().manifold);
    EXPECT_EQ(mesh.topology().components, 1U);
    EXPECT_EQ(shape_facts(mesh).genus, static_cast<std::int64_t>(recipe.genus));
    EXPECT_TRUE(mesh.repairs().zero_area_triangles.empty());
  }
}

TEST_P(EveryVariant, IsAModel) {
  const std::string name = std::string(GetParam().name) + "-9k";
  EXPECT_EQ(load_model(name).hash(), GetParam().make(9000).hash());
}

INSTANTIATE_TEST_SUITE_P(RecipeVariants, EveryVariant,
                         ::testing::ValuesIn(recipe_variants().begin(), recipe_variants().end()), [](const auto& test) {
                           std::string name(test.param.name);
                           std::erase(name, '-');
                           return name;
                         });

TEST(RecipeVariants, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names;
  for (const Recipe& recipe : recipes()) names.insert(recipe.name);
  for (const Recipe& recipe : recipe_variants()) EXPECT_TRUE(names.insert(recipe.name).second) << recipe.name;
}

}  // namespace
}  // namespace sixdof
