#include <sixdof/query/variant.h>

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/query/registry.h>

namespace sixdof {
namespace {

/// Its footprint is the setting that it was prepared with.
class Prepared final : public Query {
 public:
  Prepared(const Mesh&, const Mesh&, const Settings& settings)
      : size_(static_cast<std::size_t>(settings.number("size"))) {}
  Footprint footprint() const override { return {.bytes = size_, .counts = {}}; }

 private:
  std::size_t size_;
};

std::shared_ptr<const Algorithm> base() {
  return make_algorithm<Prepared>({.name = "it",
                                   .parameters = {Parameter::number("size", "a size", "1", "7", 1, 100),
                                                  Parameter::choice("mode", "a mode", "slow", {"slow", "fast"})}});
}

TEST(VariantAlgorithm, HasItsSettingsAsDefaultsAndInItsName) {
  const VariantAlgorithm variant(base(), {"size=3.5e1", "mode=fast"});
  EXPECT_EQ(variant.traits().name, "it@size=3.5e1,mode=fast");
  EXPECT_EQ(base_name(variant.traits().name), "it");
  EXPECT_EQ(base_name("it"), "it");
  EXPECT_EQ(variant_assignments(variant.traits().name), (std::vector<std::string>{"size=3.5e1", "mode=fast"}));
  EXPECT_EQ(variant_assignments(variant_name("it", {"size=2"})), std::vector<std::string>{"size=2"});
  EXPECT_EQ(variant_assignments("it"), std::vector<std::string>());
  EXPECT_EQ(variant.settings().to_string(), "size=3.5e1,mode=fast");
  EXPECT_EQ(&base_algorithm(variant), &variant.base());
  EXPECT_EQ(&base_algorithm(variant.base()), &variant.base());
  EXPECT_EQ(VariantAlgorithm(base()).traits().name, "it") << "without settings it is the algorithm";
}

TEST(VariantAlgorithm, PreparesAsTheAlgorithmDoes) {
  const VariantAlgorithm variant(base(), {"size=35"});
  const Mesh mesh = Mesh::build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_EQ(variant.prepare(mesh, mesh, variant.settings())->footprint().bytes, 35u);
  Settings other = variant.settings();
  other.set("size", "36");
  EXPECT_EQ(variant.prepare(mesh, mesh, other)->footprint().bytes, 36u);
}

TEST(VariantAlgorithm, RefusesSettingsThatAreNone) {
  for (const char* const wrong : {"size=0", "size=x", "length=3", "size", "mode=medium"}) {
    EXPECT_THROW(VariantAlgorithm(base(), {wrong}), BadArgument) << wrong;
  }
}

TEST(Registry, KnowsVariantsByTheirNames) {
  Registry registry;
  registry.add(std::make_unique<VariantAlgorithm>(base(), std::vector<std::string>{"size=35"}));
  registry.add(std::make_unique<VariantAlgorithm>(base(), std::vector<std::string>{"size=36"}));
  EXPECT_EQ(registry.find("it@size=36").settings().number("size"), 36.0);
  EXPECT_THROW(registry.find("it"), BadArgument);
  EXPECT_THROW(registry.add(std::make_unique<VariantAlgorithm>(base(), std::vector<std::string>{"size=36"})),
               BadArgument);
  EXPECT_THROW(registry.add(make_algorithm<Prepared>({.name = "it@size=37"})), BadArgument)
      << "only a variant has such a name";
}

}  // namespace
}  // namespace sixdof
