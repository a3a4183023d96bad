#include <sixdof/models/model_catalogue.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/models/recipe.h>

namespace sixdof {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string message_for(const std::string& name) {
  try {
    load_model(name);
  } catch (const Error& e) {
    return e.what();
  }
  return "loaded";
}

TEST(ModelCatalogue, SplitsNames) {
  const auto parts = [](std::string_view name) {
    const ModelName n = parse_model_name(name);
    return std::pair(n.base, n.triangles.value_or(0));
  };
  EXPECT_EQ(parts("torus-100k"), std::pair(std::string("torus"), std::size_t{100'000}));
  EXPECT_EQ(parts("torus-knot-1m"), std::pair(std::string("torus-knot"), std::size_t{1'000'000}));
  EXPECT_EQ(parts("torus-knot"), std::pair(std::string("torus-knot"), std::size_t{0}));
  EXPECT_EQ(parts("sphere-12500"), std::pair(std::string("sphere"), std::size_t{12'500}));
  EXPECT_EQ(parts("k-k"), std::pair(std::string("k-k"), std::size_t{0}));
  EXPECT_EQ(parts("sphere-99999999999999999999"),
            std::pair(std::string("sphere-99999999999999999999"), std::size_t{0}));
  EXPECT_THROW(parse_model_name(""), BadArgument);
  EXPECT_THROW(parse_model_name("Torus-1k"), BadArgument);
  EXPECT_THROW(parse_model_name("torus 1k"), BadArgument);
}

TEST(ModelCatalogue, MakesTheModelOfARecipe) {
  const Mesh mesh = load_model("torus-2k");
  EXPECT_EQ(mesh.name(), "torus-2k");
  EXPECT_EQ(mesh.hash(), make_torus({}, 2000).hash());
}

TEST(ModelCatalogue, SuggestsSimilarNames) {
  EXPECT_THAT(message_for("toros-10k"), AllOf(HasSubstr("no model is called toros"), HasSubstr("did you mean torus")));
  EXPECT_THAT(message_for("zzzzzz-10k"), AllOf(HasSubstr("known: "), HasSubstr("circular-box")));
  EXPECT_THAT(message_for("cone"), HasSubstr("how many triangles, as in cone-10k"));
  EXPECT_THAT(message_for("torus-3"), HasSubstr("60 to 20000000"));
}

TEST(ModelCatalogue, AFileThatDoesNotExistButHasAModelsName) {
  EXPECT_THAT(message_for("./no-such-folder/fandisk.obj"),
              AllOf(HasSubstr("fandisk.obj: no such file"), HasSubstr("run models/fetch fandisk")));
  EXPECT_THAT(message_for("./no-such-folder/hull.obj"), Not(HasSubstr("models/fetch")));
}

TEST(Suggestions, AreNearOrContained) {
  const std::vector<std::string> names{"torus", "torus-knot", "cone"};
  EXPECT_THAT(suggestions("knot", names), ElementsAre("torus-knot"));
  EXPECT_THAT(suggestions("trous", names), ElementsAre("torus"));
  EXPECT_THAT(suggestions("sphere", names), IsEmpty());
  EXPECT_THAT(suggestions("toruss", names), ElementsAre("torus"));
  EXPECT_THAT(suggestions("frobnicate", {"a", "b"}), IsEmpty()) << "a letter is contained in most words";
}

}  // namespace
}  // namespace sixdof
