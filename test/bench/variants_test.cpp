#include "bench/harness/variants.h"

#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include "bench/harness/options.h"

namespace sixdof::bench {
namespace {

using ::testing::ElementsAre;

class EmptyQuery final : public Query {
 public:
  EmptyQuery(const Mesh&, const Mesh&, const Settings&) {}
};

/// Adds "it" and "other", with parameters x and y from 0 to 10, and the rival "foreign" with x.
void fill(Registry& registry) {
  const auto parameter = [](const char* name) { return Parameter::number(name, "a number", "1", "5", 0, 10); };
  registry.add(make_algorithm<EmptyQuery>({.name = "it", .parameters = {parameter("x"), parameter("y")}}));
  registry.add(make_algorithm<EmptyQuery>({.name = "other", .parameters = {parameter("x"), parameter("y")}}));
  registry.add(make_algorithm<EmptyQuery>({.name = "foreign", .parameters = {parameter("x")}, .runtime = "native"}));
}

struct Variants : ::testing::Test {
  Registry registry;
  Variants() { fill(registry); }

  std::vector<std::string> names() const {
    std::vector<std::string> list;
    for (const auto& algorithm : registry.all()) list.push_back(algorithm->traits().name);
    return list;
  }
};

TEST_F(Variants, AListOfValuesTakesThePlaceOfTheAlgorithm) {
  EXPECT_THAT(register_variants({"it:x=1,2.5", "other:y=3"}, {}, registry), ElementsAre("other:y=3"));
  EXPECT_THAT(names(), ElementsAre("it@x=1", "it@x=2.5", "other", "foreign"));
}

TEST_F(Variants, ParametersOfOneValueApplyToAllOfThem) {
  const auto settings = parse_parameters(register_variants({"it:y=7", "it:x=1,2"}, {}, registry), registry);
  EXPECT_EQ(settings.at("it@x=1").to_string(), "x=1,y=7");
  EXPECT_EQ(settings.at("it@x=2").to_string(), "x=2,y=7");
  EXPECT_EQ(settings.at("other").to_string(), "x=5,y=5");
}

TEST_F(Variants, TwoListsMakeEveryCombination) {
  register_variants({"it:x=1,2", "it:y=3,4"}, {}, registry);
  EXPECT_THAT(names(), ElementsAre("it@x=1,y=3", "it@x=1,y=4", "it@x=2,y=3", "it@x=2,y=4", "other", "foreign"));
}

TEST_F(Variants, OfASuiteStandBesideTheAlgorithm) {
  register_variants({}, {{"other", {"x=1", "y=2"}}, {"missing", {"x=1"}}}, registry);
  EXPECT_THAT(names(), ElementsAre("it", "other", "other@x=1,y=2", "foreign"));
  EXPECT_EQ(registry.find("other@x=1,y=2").settings().to_string(), "x=1,y=2");
}

TEST_F(Variants, OfRivalsAreThoseThatHaveTheParameter) {
  register_variants({"rivals:x=1,2"}, {}, registry);
  EXPECT_THAT(names(), ElementsAre("it", "other", "foreign@x=1", "foreign@x=2"));
}

TEST_F(Variants, RefuseWhatIsNone) {
  for (const char* const wrong : {"it:z=1,2", "it:x=1,20", "it:x=1,,2", "it:x=1,", "nobody:x=1,2", "it:x=1,1"}) {
    Registry fresh;
    fill(fresh);
    EXPECT_THROW(register_variants({wrong}, {}, fresh), BadArgument) << wrong;
  }
}

}  // namespace
}  // namespace sixdof::bench
