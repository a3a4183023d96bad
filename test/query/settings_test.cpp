#include <sixdof/query/settings.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

std::vector<Parameter> parameters() {
  return {
      {.name = "voxel",
       .meaning = "edge of a voxel",
       .unit = "diagonal",
       .default_value = "0.01",
       .low = 1e-4,
       .high = 0.5},
      {.name = "layers", .meaning = "layers", .unit = "1", .default_value = "3", .low = 1, .high = 9, .integer = true},
      {.name = "depth", .meaning = "how", .unit = "", .default_value = "local", .choices = {"local", "field"}}};
}

TEST(Settings, AreCompleteAndPrintInOrder) {
  Settings settings(parameters());
  EXPECT_EQ(settings.to_string(), "voxel=0.01,layers=3,depth=local");
  settings.set_all({"depth=field", "voxel=0.02"});
  EXPECT_EQ(settings.number("voxel"), 0.02);
  EXPECT_EQ(settings.choice("depth"), "field");
  EXPECT_EQ(settings.to_string(), "voxel=0.02,layers=3,depth=field");
}

TEST(Settings, RefuseInvalidValuesAndNames) {
  Settings settings(parameters());
  for (const char* bad : {"voxel=0", "voxel=nan", "voxel=1,5", "voxel=", "voxel=0.01x", "layers=2.5", "depth=none",
                          "voxels=0.1", "voxel", "voxel=inf"}) {
    EXPECT_THROW(settings.set_all({bad}), BadArgument) << bad;
  }
  EXPECT_EQ(settings.to_string(), Settings(parameters()).to_string());
  EXPECT_THROW(Settings().set("voxel", "1"), BadArgument);
}

TEST(Settings, RefuseADefaultOrASweepThatIsNotAllowed) {
  const Parameter voxel = Parameter::number("voxel", "edge of a voxel", "diagonal", "0.01", 1e-4, 0.5);
  EXPECT_NO_THROW(Settings({voxel.swept({"0.02", "0.01"})}));
  EXPECT_THROW(Settings({voxel.swept({"0.02", "0.6"})}), BadArgument);
  EXPECT_THROW(Settings({Parameter::count("layers", "layers", "0", 1, 9)}), BadArgument);
}

}  // namespace
}  // namespace sixdof
