#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/common/run_guarded.h"

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-15;      // relative: of one product
constexpr double k_sum_rounding = 1e-12;  // relative: of sums over all triangles

namespace fs = std::filesystem;
using ::testing::HasSubstr;

test::ProgramResult run(const std::string& arguments) {
  return test::run_program(std::string(SIXDOF_PROGRAM) + " " + arguments);
}

nlohmann::json json_of(const std::string& arguments) {
  const auto result = run(arguments + " --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out);
}

/// In a folder of its own, removed at the end.
class Models : public test::ScratchFolder {};
class Info : public test::ScratchFolder {};

TEST_F(Models, ListsRecipesAndRealObjects) {
  const auto json = json_of("models list");
  std::vector<std::string> recipes;
  for (const auto& recipe : json.at("recipes")) recipes.push_back(recipe.at("name"));
  EXPECT_THAT(recipes, ::testing::IsSupersetOf({"sphere", "box", "cone", "cylinder", "torus", "bumpy-sphere",
                                                "torus-knot", "gyroid-ball", "circular-box"}));
  const std::string text = run("models list").out;
  for (const auto& model : json.at("fetched")) {
    EXPECT_THAT(text, HasSubstr(model.at("name").get<std::string>()));
    EXPECT_FALSE(model.at("licence").get<std::string>().empty());
    EXPECT_EQ(model.at("hash").get<std::string>().size(), 32u);
  }
}

TEST_F(Models, MakesWhatInfoReadsInEveryFormat) {
  for (const char* extension : {"ply", "off", "obj", "stl"}) {
    const std::string file = path(std::string("t.") + extension);
    ASSERT_EQ(run("models make torus --triangles 1200 -o " + file).exit_code, 0);
    const auto json = json_of("info " + file);
    EXPECT_EQ(json.at("kind"), "mesh");
    EXPECT_EQ(json.at("triangles"), 1200);
    EXPECT_EQ(json.at("solid"), true);
    EXPECT_EQ(json.at("euler_characteristic"), 0);
  }
}

TEST_F(Models, ListsTheCollectionAndWhatWasLeftOut) {
  const auto json = json_of("models list --collection paper-like");
  std::size_t closed = 0;
  for (const auto& object : json.at("objects")) closed += object.at("closed").get<bool>() ? 1 : 0;
  EXPECT_GE(closed, 100u);
  const std::string text = run("models list --collection").out;
  EXPECT_THAT(text, HasSubstr(std::to_string(closed) + " closed objects: "));
  for (const auto& object : json.at("objects")) {
    EXPECT_THAT(text, HasSubstr(std::string("\n").append(object.at("name").get<std::string>()).append(" ")));
    EXPECT_TRUE(object.at("source") != "recipe" || object.at("here").get<bool>());
  }
  EXPECT_THAT(text, HasSubstr("Left out: " + std::to_string(json.at("left_out").size()) + " meshes"));
  EXPECT_THAT(text, HasSubstr("camel.off: meets itself: 20 pairs of triangles"));
  const auto unknown = run("models list --collection paper");
  EXPECT_EQ(unknown.exit_code, k_exit_error);
  EXPECT_THAT(unknown.err, HasSubstr("no collection is called paper; there is paper-like"));
}

TEST_F(Models, ScalesToADiagonal) {
  ASSERT_EQ(run("models make torus-1k --diagonal 0.25 -o " + path("t.ply")).exit_code, 0);
  const auto whole = json_of("info torus-1k"), part = json_of("info " + path("t.ply"));
  EXPECT_NEAR(part.at("diagonal").get<double>(), 0.25, k_rounding);
  const double factor = 0.25 / whole.at("diagonal").get<double>();
  EXPECT_NEAR(part.at("area").get<double>() / whole.at("area").get<double>(), factor * factor, k_sum_rounding);
  EXPECT_NEAR(part.at("shape").at("thickness").get<double>(), whole.at("shape").at("thickness").get<double>(),
              k_sum_rounding);
}

TEST_F(Models, RefusesInWordsAndWritesNothing) {
  const auto refuses = [&](const std::string& arguments, int exit_code, const std::string& words) {
    const auto result = run("models make " + arguments);
    EXPECT_EQ(result.exit_code, exit_code) << arguments;
    EXPECT_THAT(result.err, HasSubstr(words)) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_TRUE(fs::is_empty(folder())) << arguments;
  };
  const std::string output = " -o " + path("m.ply");
  refuses("sfere -n 500" + output, k_exit_error, "sfere");
  refuses("sphere" + output, k_exit_error, "sphere-10k");
  refuses("sphere-500 -n 500" + output, k_exit_error, "already");
  refuses("sphere -n 3" + output, k_exit_error, "3 were asked for");
  refuses("sphere -n -3" + output, k_exit_usage, "--triangles");
  refuses("sphere-500 --diagonal 0" + output, k_exit_usage, "--diagonal");
  refuses("sphere -n many" + output, k_exit_usage, "--triangles");
  refuses("sphere -n 500 -o " + path("m.xyz"), k_exit_error, "m.xyz");
  refuses("sphere -n 500 -o " + path("no/such/m.ply"), k_exit_error, "no/such");
  refuses("sphere -n 500", k_exit_usage, "--output");
}

TEST_F(Info, TellsAnOpenMeshFromASolid) {
  std::ofstream(path("open.off")) << "OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n";
  const auto json = json_of("info " + path("open.off"));
  EXPECT_EQ(json.at("solid"), false);
  EXPECT_EQ(json.at("closed"), false);
  EXPECT_EQ(json.at("border_edges"), 3);
}

TEST_F(Info, ShowsWhatLoadingRepaired) {
  // Quadrilaterals that are not flat, a statement of no OBJ file, two equal vertices, one that no face uses, and a face
  // that collapses since its corners are equal.
  std::ofstream(path("odd.obj")) << "v 0 0 0\nv 1 0 0\nv 1 1 0.25\nv 0 1 0\nv 0 0 1\nv 0 0 1\nv 5 5 5\n"
                                    "strange words\n"
                                    "f 1 2 3 4\n"
                                    "f 1 3 2 4\n"
                                    "f 1 2 5\nf 2 3 6\n"
                                    "f 5 6 1\n";
  const auto json = json_of("info " + path("odd.obj")).at("repairs");
  EXPECT_EQ(json.at("nonplanar_polygons").at("count"), 2);
  EXPECT_EQ(json.at("nonplanar_polygons").at("first_place"), "line 9");
  EXPECT_EQ(json.at("crossing_polygons").at("count"), 0);
  EXPECT_EQ(json.at("skipped_statements").at("count"), 1);
  EXPECT_EQ(json.at("skipped_statements").at("first_place"), "line 8");
  EXPECT_EQ(json.at("welded_vertices"), 1);
  EXPECT_EQ(json.at("unreferenced_vertices"), 1);
  EXPECT_EQ(json.at("collapsed_triangles"), 1);
  EXPECT_EQ(json.at("zero_area_triangles"), 0);
  const std::string text = run("info " + path("odd.obj")).out;
  EXPECT_THAT(text,
              HasSubstr("1 vertices welded, 1 unused dropped; 1 collapsed triangles dropped, 0 of zero area kept"));
  const std::string forgiven =
      "2 polygons that are not flat, triangulated (first: line 9); 1 unknown statement, skipped (line 8)";
  EXPECT_THAT(text, HasSubstr("\nforgiven     " + forgiven + "\n"));
  EXPECT_EQ(json_of("info " + path("odd.obj")).at("forgiven"), forgiven);

  // A bow tie: its sides 2-3 and 4-1 cross.
  std::ofstream(path("bow.obj")) << "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 2 1 0\nf 1 2 3 4\n";
  const auto bow = json_of("info " + path("bow.obj")).at("repairs");
  EXPECT_EQ(bow.at("crossing_polygons").at("count"), 1);
  EXPECT_EQ(bow.at("crossing_polygons").at("first_place"), "line 5");
  EXPECT_THAT(run("info " + path("bow.obj")).out,
              HasSubstr("\nforgiven     1 polygon that crosses itself, triangulated (line 5)\n"));
  EXPECT_THAT(run("info cone-100").out, HasSubstr("\nforgiven     nothing\n"));
  EXPECT_EQ(json_of("info cone-100").at("forgiven"), "");
}

TEST_F(Info, ShowsAConfigurationSet) {
  ASSERT_EQ(run("generate --a box-12 --grid 90 --distances 0,5 -o " + path("set.h5")).exit_code, 0);
  const auto json = json_of("info " + path("set.h5"));
  EXPECT_EQ(json.at("grid"), "90");
  EXPECT_EQ(json.at("configurations_per_bucket"), 288);
  EXPECT_EQ(json.at("buckets").size(), 2u);
  EXPECT_THAT(run("info " + path("set.h5")).out, HasSubstr("distance/05"));
}

TEST_F(Info, ReadsAByteOrderMarkAndALastLineWithoutABreak) {
  const std::string text = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3";
  std::ofstream(path("plain.off")) << text << "\n";
  std::ofstream(path("marked.off")) << "\xEF\xBB\xBF" << text;
  EXPECT_EQ(json_of("info " + path("marked.off")).at("hash"), json_of("info " + path("plain.off")).at("hash"));
}

TEST_F(Info, ShowsInvisibleBytes) {
  std::ofstream(path("space.obj")) << "v 0 0 0\xC2\xA0"
                                      "0\n";
  EXPECT_THAT(run("info " + path("space.obj")).err, HasSubstr("space.obj: line 1: '0\\xC2\\xA00' is not a number"));
}

TEST_F(Info, SaysWhyAFileIsNoMesh) {
  std::ofstream(path("noext")) << "x";
  EXPECT_THAT(run("info " + path("noext")).err, HasSubstr("noext: has no extension"));
  EXPECT_THAT(run("info " + path("fandisk.obj")).err,
              HasSubstr("fandisk.obj: no such file; for the model fandisk run"));
}

TEST_F(Info, NamesFilesThatItCannotRead) {
  std::ofstream(path("cut.ply")) << "ply\nformat ascii 1.0\nelement vertex 3\n";
  for (const char* name : {"cut.ply", "missing.ply", "missing.h5"}) {
    const auto result = run("info " + path(name));
    EXPECT_EQ(result.exit_code, k_exit_error);
    EXPECT_THAT(result.err, HasSubstr(name));
    EXPECT_EQ(result.out, "");
  }
}

}  // namespace
}  // namespace sixdof
