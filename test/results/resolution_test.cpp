#include <sixdof/results/resolution.h>

#include <gtest/gtest.h>

namespace sixdof::results {
namespace {

TEST(CountText, HasCommasBetweenThousands) {
  EXPECT_EQ(count_text(0), "0");
  EXPECT_EQ(count_text(999), "999");
  EXPECT_EQ(count_text(1000), "1,000");
  EXPECT_EQ(count_text(1234567), "1,234,567");
  EXPECT_EQ(count_text(-100), "-100");
}

TEST(ResolutionText, IsThatOfThePapersFigure) {
  RowGroup group;
  EXPECT_EQ(resolution_text(group), "");
  group.values = {{"voxels_x", 728.0}, {"voxels_y", 24.0}, {"points", 15669.0}};
  EXPECT_EQ(resolution_text(group), "") << "a count is missing";
  group.values["voxels_z"] = 303.0;
  EXPECT_EQ(resolution_text(group), "728x24x303, 15,669");
  group.values = {{"spheres_a", 10000.0}};
  EXPECT_EQ(resolution_text(group), "10,000");
  group.values["spheres_b"] = 10000.0;
  EXPECT_EQ(resolution_text(group), "10,000");
  group.values["spheres_b"] = 1000.0;
  EXPECT_EQ(resolution_text(group), "10,000 and 1,000");
}

}  // namespace
}  // namespace sixdof::results
