#include <sixdof/conformance/declaration.h>

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/conformance/declared.h>

namespace sixdof::conformance {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::string& name, const std::string& value) {
  Declaration declaration;
  try {
    set_claim(declaration, name, value);
  } catch (const BadArgument& e) {
    return e.what();
  }
  return {};
}

TEST(ConformanceDeclaration, ClaimsAreSetByTheirNames) {
  Declaration declaration;
  set_claim(declaration, "collide", "bodies");
  set_claim(declaration, "open_meshes", "no");
  set_claim(declaration, "distance_error", "1e-6");
  set_claim(declaration, "scale_error", "none");
  set_claim(declaration, "repeat_error", "0");
  EXPECT_EQ(declaration.collide, Meaning::bodies);
  EXPECT_FALSE(declaration.open_meshes);
  EXPECT_EQ(declaration.distance_error, 1e-6);
  EXPECT_EQ(declaration.scale_error, k_no_claim);
  EXPECT_EQ(declaration.repeat_error, 0.0);
  EXPECT_EQ(declaration.motion_error, Declaration().motion_error) << "the others stay";
  set_claim(declaration, "collide", "surfaces");
  EXPECT_EQ(declaration.collide, Meaning::surfaces);
}

TEST(ConformanceDeclaration, RefusesWhatIsNoClaim) {
  EXPECT_THAT(refusal("speed", "1"), HasSubstr("claim speed: no such claim; there are collide, open_meshes, dist"));
  EXPECT_EQ(refusal("collide", "yes"), "claim collide=yes: must be bodies or surfaces");
  EXPECT_EQ(refusal("open_meshes", "bodies"), "claim open_meshes=bodies: must be yes or no");
  for (const char* const value : {"", "-1", "1x", "nan", "many"}) {
    EXPECT_THAT(refusal("order_error", value), HasSubstr("must be a number, 0 or more, or none")) << value;
  }
}

TEST(ConformanceDeclaration, OfAnUnknownAlgorithmIsThatOfAnExactOne) {
  const Declaration mine = declaration_of("mine");
  EXPECT_TRUE(mine.settings.empty() && mine.known_failures.empty());
  EXPECT_EQ(mine.collide, Meaning::surfaces);
  EXPECT_EQ(declaration_of("exact").collide, Meaning::bodies);
  EXPECT_EQ(declaration_of("fcl-rss").known_failures.size(), 1u);
  EXPECT_EQ(declaration_of("ist").scale_error, k_no_claim);
}

}  // namespace
}  // namespace sixdof::conformance
