// What the page shows in three dimensions: meshes with few triangles, moments of a path, poses of hard cases.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <sixdof/geometry/load.h>
#include <sixdof/geometry/save.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/report/scene.h>
#include <sixdof/scenario/scenario.h>

#include "result_text.h"

namespace sixdof::report {
namespace {

constexpr double k_rounding = 1e-12;  // of one product

using test::Json;

TEST(DrawnMesh, LargeMeshHasFewTrianglesAndTheSameExtent) {
  const Mesh mesh = load_model("torus-knot-100k");
  const DrawnMesh small = drawn(mesh, 5000);
  EXPECT_EQ(small.triangles_before, mesh.triangles().size());
  EXPECT_LE(small.triangles.size(), 5000u);
  EXPECT_GE(small.triangles.size(), 2000u);
  Eigen::AlignedBox3d box;
  for (const auto& p : small.vertices) box.extend(Eigen::Vector3d(p[0], p[1], p[2]));
  // A vertex is the mean of its cell, which is a few hundredths of the size.
  EXPECT_LT((box.min() - mesh.box().min()).cwiseAbs().maxCoeff(), 0.03 * mesh.diagonal());
  EXPECT_LT((box.max() - mesh.box().max()).cwiseAbs().maxCoeff(), 0.03 * mesh.diagonal());
  for (const auto& t : small.triangles) {
    for (const auto vertex : t) ASSERT_LT(vertex, small.vertices.size());
  }
}

TEST(DrawnMesh, SmallMeshStaysAsItIs) {
  const Mesh mesh = load_model("torus-1k");
  EXPECT_EQ(drawn(mesh).triangles.size(), mesh.triangles().size());
}

TEST(Scenes, PathHasTheSeriesPosesAndArrows) {
  Series series;
  series.scenario = "II";
  series.algorithm = "vps";
  series.shape = scenario_settings("II").to_string();
  series.rate_hz = 1000.0;
  for (int k = 0; k < 500; ++k) {
    series.poses.push_back({1.0, 0.0, 0.0, 0.0, 0.5 * k, 0.0, 0.0});
    series.force.push_back({1.0, 2.0, 0.1 * k});
    series.ideal_force.push_back({1.0, 2.0, 0.0});
    series.torque.push_back({0.0, 0.0, 0.0});
    series.ideal_torque.push_back({0.0, 0.0, 0.0});
  }
  const Scenes scenes = make_scenes({}, {series});
  ASSERT_EQ(scenes.scenes.size(), 1u);
  const Scene& scene = scenes.scenes[0];
  EXPECT_EQ(scene.name, "II: vps");
  EXPECT_EQ(scene.stride, 3u);
  EXPECT_LE(scene.moments.size(), k_most_moments);
  EXPECT_EQ(scene.moments[10].pose[4], 15.0);
  EXPECT_EQ(scene.moments[10].force[2], 3.0);
  EXPECT_NE(scene.a, scene.b);
  EXPECT_FALSE(scenes.meshes[scene.a].triangles.empty());
}

TEST(Scenes, OutlierOfARowHasItsPoseMeshesAndResponse) {
  Json row = test::row("respond", "vps", "torus-1k", "volume", 5.0, 1000.0);
  row["outliers"] = test::outliers("max_ns", "1 2 3 0 1 0 0");
  row["outliers"]["poses"]["gamma_max_F_deg"] = "1 2 3 0 1 0 0";
  row["outliers"]["poses"]["misses"] = "4 5 6 1 0 0 0";
  row["outliers"]["responses"]["gamma_max_F_deg"] = {{"force", {1, 0, 0}},
                                                     {"torque", {0, 0, 0}},
                                                     {"exact_force", {0, 1, 0}},
                                                     {"exact_torque", {0, 0, 0}},
                                                     {"reference", {1, 2, 4}}};
  Json foreign = test::row("distance", "vps", "part", "distance", 5.0, 1000.0);
  foreign["outliers"] = test::outliers("max_ns");
  foreign["outliers"]["a"] = "absent.ply";
  const Scenes scenes = make_scenes(test::results_of({row, foreign}, {{"mesh:torus-1k", "0123"}}), {});
  ASSERT_EQ(scenes.scenes.size(), 3u) << "the object, and a pose for each command whose meshes are here";
  const Scene& scene = scenes.scenes[1];
  EXPECT_EQ(scene.kind, "pose");
  EXPECT_EQ(scene.name, "respond of vps: torus-1k volume 5 %, largest angle of the force");
  EXPECT_EQ(scene.command, "sixdof query --a torus-1k --b torus-1k --algorithm exact --pose \"1 2 3 0 1 0 0\"");
  EXPECT_EQ(scene.a, scenes.scenes[0].a);
  const std::array<double, 7> pose{0.0, 1.0, 0.0, 0.0, 1.0, 2.0, 3.0};
  EXPECT_EQ(scene.moments.at(0).pose, pose);
  EXPECT_EQ(scene.moments.at(0).ideal_force[1], 1.0);
  // Half a turn about x takes the point over B's origin below it.
  EXPECT_NEAR(scene.reference[2], -1.0, k_rounding);
  EXPECT_EQ(scenes.scenes[2].moments.at(0).pose[4], 4.0);
}

TEST(Scenes, MeshOfTheUsersIsTakenByItsHash) {
  const auto folder = std::filesystem::temp_directory_path() / "sixdof-outlier-test";
  std::filesystem::create_directories(folder);
  const auto file = folder / "part.off";
  save_mesh(load_model("torus-1k"), file);
  Json row = test::row("distance", "vps", "part", "distance", 5.0, 1000.0);
  row["outliers"] = test::outliers("max_ns");
  row["outliers"]["a"] = row["outliers"]["b"] = file.string();
  const std::string hash = load_mesh(file).hash();
  EXPECT_EQ(make_scenes(test::results_of({row}, {{"mesh:part@1", hash}}), {}).scenes.size(), 1u);
  EXPECT_TRUE(make_scenes(test::results_of({row}, {{"mesh:part@1", "another"}}), {}).scenes.empty());
  std::filesystem::remove_all(folder);
}

TEST(Scenes, HardCaseWithAFaultHasItsPose) {
  const auto folder = std::filesystem::temp_directory_path() / "sixdof-scene-test";
  std::filesystem::create_directories(folder);
  const auto file = folder / "a.off";
  save_mesh(load_model("torus-1k"), file);
  const std::string command =
      "sixdof query --a " + file.string() + " --b " + file.string() + " --pose \"1 2 3 0 1 0 0\" --algorithm ode";
  Results results;
  for (const char* const verdict : {"wrong", "exact"}) {
    results.hard_cases.push_back({.family = "scale", .algorithm = "ode", .verdict = verdict, .reproduction = command});
  }
  results.hard_cases.push_back({.family = "gone",
                                .algorithm = "ode",
                                .verdict = "wrong",
                                .reproduction = "sixdof query --a absent.off --b absent.off --pose \"0 0 0 1 0 0 0\""});
  const Scenes scenes = make_scenes(results, {});
  ASSERT_EQ(scenes.scenes.size(), 1u);
  EXPECT_EQ(scenes.scenes[0].name, "scale: ode");
  EXPECT_EQ(scenes.scenes[0].command, command);
  const std::array<double, 7> pose{0.0, 1.0, 0.0, 0.0, 1.0, 2.0, 3.0};
  EXPECT_EQ(scenes.scenes[0].moments.at(0).pose, pose);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sixdof::report
