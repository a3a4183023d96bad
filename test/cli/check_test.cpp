// `sixdof info --check`, and the warning of `sixdof generate`.

#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/common/run_guarded.h"

#include "mesh_files.h"
#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

using ::testing::HasSubstr;

class Check : public test::ScratchFolder {
 protected:
  /// In the folder of the test, with an empty cache of its own.
  test::ProgramResult run(const std::string& arguments) const {
    return test::run_program("cd " + folder().string() + " && SIXDOF_CACHE=" + path("cache") + " " + SIXDOF_PROGRAM +
                             " " + arguments);
  }
};

TEST_F(Check, PassesASoundMesh) {
  const auto text = run("info torus-1k --check");
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_EQ(text.err, "");
  EXPECT_THAT(text.out, HasSubstr("contacts     0 pairs"));
  const auto json = nlohmann::json::parse(run("info torus-1k --check --json").out);
  EXPECT_EQ(json.at("check").at("clean"), true);
  EXPECT_EQ(json.at("check").at("shells").at("count"), 1);
  EXPECT_FALSE(nlohmann::json::parse(run("info torus-1k --json").out).contains("check"));
}

TEST_F(Check, NamesCrossingTrianglesWithPlaces) {
  test::save_crossing_boxes(path("crossing.ply"));
  const auto text = run("info crossing.ply --check");
  EXPECT_EQ(text.exit_code, k_exit_defects);
  EXPECT_THAT(text.out, HasSubstr("solid        yes"));
  EXPECT_THAT(text.out, HasSubstr("crossing: triangles "));
  EXPECT_THAT(text.err, ::testing::MatchesRegex("sixdof: crossing: [0-9]+ pairs of triangles meet\n"));

  const auto found = run("info crossing.ply --check --json");
  EXPECT_EQ(found.exit_code, k_exit_defects);
  const auto json = nlohmann::json::parse(found.out);
  EXPECT_EQ(json.at("volume"), 16.0);
  const auto& contacts = json.at("check").at("self_contacts");
  EXPECT_EQ(json.at("check").at("clean"), false);
  EXPECT_GE(contacts.at("crossing"), 12);
  const auto& first = contacts.at("first").at(0);
  EXPECT_LT(first.at("triangles").at(0), 12);
  EXPECT_GE(first.at("triangles").at(1), 12);
  for (const double x : first.at("point")) {
    EXPECT_GE(x, 1.0);
    EXPECT_LE(x, 2.0);
  }
}

TEST_F(Check, NamesDoubledAndNestedShells) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  test::add_box({0, 0, 0}, {4, 4, 4}, vertices, triangles);
  test::add_box({1, 1, 1}, {2, 2, 2}, vertices, triangles);
  test::add_box({9, 0, 0}, {10, 1, 1}, vertices, triangles);
  test::add_box({9, 0, 0}, {10, 1, 1}, vertices, triangles);
  save_mesh(Mesh::build(std::move(vertices), std::move(triangles), "shells"), path("shells.ply"));
  const auto text = run("info shells.ply --check");
  EXPECT_EQ(text.exit_code, k_exit_defects);
  EXPECT_THAT(text.out, HasSubstr("nested: shell of 12 triangles"));
  EXPECT_THAT(text.out, HasSubstr("counts 2 times"));
  EXPECT_THAT(text.out, HasSubstr("doubled: shell of 12 triangles, at triangle 36"));
  EXPECT_EQ(
      text.err,
      "sixdof: shells: 12 pairs of triangles meet, 1 shell is doubled, 1 shell lies inside another solid shell\n");
}

TEST_F(Check, IsForMeshesOnly) {
  ASSERT_EQ(run("generate --a box-12 --grid 90 --distances 5 -o set.h5").exit_code, 0);
  const auto refused = run("info set.h5 --check");
  EXPECT_EQ(refused.exit_code, k_exit_error);
  EXPECT_THAT(refused.err, HasSubstr("--check is for meshes"));
  EXPECT_EQ(refused.out, "");
}

std::ptrdiff_t lines_with(const std::string& text, const std::string& words) {
  std::istringstream lines(text);
  std::ptrdiff_t count = 0;
  for (std::string line; std::getline(lines, line);) count += line.find(words) != std::string::npos ? 1 : 0;
  return count;
}

/// The second run takes the verdict from the cache.
TEST_F(Check, GenerateWarnsOnceOfAMeshThatCrossesItself) {
  test::save_crossing_boxes(path("crossing.ply"));
  for (int i = 0; i < 2; ++i) {
    const auto made = run("generate --a crossing.ply --b crossing.ply --grid 90 --distances 5 -o set.h5");
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(lines_with(made.err, "warning: crossing: "), 1) << made.err;
    EXPECT_THAT(made.err, HasSubstr("(sixdof info --check crossing.ply)"));
  }
  const auto clean = run("generate --a box-12 --grid 90 --distances 5 -o set.h5");
  EXPECT_EQ(lines_with(clean.err, "warning"), 0) << clean.err;
}

}  // namespace
}  // namespace sixdof
