// The examples of doc/main.md, run as a reader would.
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/geometry/save.h>

#include "../cli/run_program.h"
#include "../cli/scratch_folder.h"

namespace sixdof {
namespace {

using ::testing::HasSubstr;

/// A corner of a cube, moved along x.
Mesh corner(double x, const std::string& name) {
  return Mesh::build({{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}, {x, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
                     name);
}

class Examples : public test::ScratchFolder {
 protected:
  Examples() {
    save_mesh(corner(0.0, "a"), folder() / "a.off");
    save_mesh(corner(3.0, "b"), folder() / "b.off");
  }
  std::string meshes() const { return path("a.off") + " " + path("b.off"); }
};

TEST_F(Examples, DistanceOfTwoFiles) {
  const auto result = test::run_program(std::string(EXAMPLE_DISTANCE) + " " + meshes());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NEAR(std::stod(result.out), 2.0, 1e-12) << "from x = 1 to x = 3";
  EXPECT_THAT(result.out, HasSubstr("closest to B at 1 "));
  const auto refused = test::run_program(std::string(EXAMPLE_DISTANCE) + " " + path("none.off") + " " + path("a.off"));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("none.off"));
}

TEST_F(Examples, ReadSet) {
  const Mesh a = corner(0.0, "a"), b = corner(3.0, "b");
  const Grid grid = make_grid("90");
  constexpr std::size_t k_reachable = 1;
  constexpr double k_translation = 2.5;
  std::vector<double> translations(grid.configurations(), std::numeric_limits<double>::quiet_NaN());
  translations[k_reachable] = k_translation;
  {
    SetDescription description{
        .generator_version = "test", .a = MeshIdentity::of(a), .b = MeshIdentity::of(b), .grid = grid};
    ConfigurationSetWriter writer(folder() / "set.h5", std::move(description));
    BucketSummary summary = distance_bucket(a, 5.0);
    summary.oracle = "none";
    summary.oracle_version = "1";
    writer.write(std::move(summary), translations);
    writer.commit();
  }
  const auto result = test::run_program(std::string(EXAMPLE_READ_SET) + " " + path("set.h5") + " " + meshes());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Pose X_AB = ConfigurationRay(a, b, grid.rotations[0], grid.directions[k_reachable]).pose(k_translation);
  char place[100];
  std::snprintf(place, sizeof(place), "%g %g %g", X_AB.t.x(), X_AB.t.y(), X_AB.t.z());
  EXPECT_EQ(result.out,
            "distance/05: 1 of " + std::to_string(grid.configurations()) + " reachable, the first at " + place + "\n");
  const auto refused = test::run_program(std::string(EXAMPLE_READ_SET) + " " + path("set.h5") + " " + path("b.off") +
                                         " " + path("a.off"));
  EXPECT_EQ(refused.exit_code, 1) << "for other meshes";
}

TEST_F(Examples, RegisterAlgorithm) {
  const std::string program = EXAMPLE_REGISTER;
  EXPECT_THAT(test::run_program(program + " algorithms").out, HasSubstr("balls around the bounding boxes"));
  const auto result = test::run_program(program + " query --a " + path("a.off") + " --b " + path("b.off") +
                                        " --pose '9 0 0 1 0 0 0' --algorithm balls");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("distance"));
}

}  // namespace
}  // namespace sixdof
