// `sixdof scene make`, `info` and `play`.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "mesh_files.h"
#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class SceneCommand : public test::ScratchFolder {
 protected:
  test::ProgramResult run(const std::string& arguments) const {
    return test::run_program("cd " + folder().string() + " && " SIXDOF_PROGRAM " scene " + arguments);
  }
  json json_of(const std::string& arguments) const {
    const auto result = run(arguments + " --json");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out);
  }
};

TEST_F(SceneCommand, MakesAndDescribesAScene) {
  const auto made = run("make cube -n 30 --frames 4 --seed 2 --margin 0.5 -o s.h5");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("bodies      30, 0 of them fixed\n"));
  const json info = json_of("info s.h5");
  EXPECT_EQ(info.at("name"), "cube");
  EXPECT_EQ(info.at("recipe"), "family=cube bodies=30 frames=4 seed=2 margin=0.5");
  EXPECT_EQ(info.at("pairs"), 30 * 29 / 2);
  EXPECT_EQ(info.at("motions"), 30 * 3);
  EXPECT_THAT(run("info s.h5").out, HasSubstr("hash        " + info.at("hash").get<std::string>()));
}

TEST_F(SceneCommand, MakesAndPlaysASceneInWhichAMeshDeforms) {
  for (const char* family : {"wave", "twist", "cloth", "bump", "crumple"}) {
    const auto made = run(std::string("make ") + family + " --amplitude 0.1 --triangles 500 --frames 5 -o s.h5");
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.out, HasSubstr("deformed    4 meshes in all frames\n"));
    EXPECT_EQ(json_of("info s.h5").at("recipe"),
              std::string("family=") + family + " frames=5 seed=1 amplitude=0.1 triangles=500");
    const json played = json_of("play s.h5 --algorithms exact,exact-refit,exact-rebuild,all-pairs --question near");
    for (const json& each : played[0].at("algorithms")) {
      EXPECT_EQ(each.at("same_bits"), true);
      EXPECT_NEAR(each.at("update_us").get<double>() + each.at("answer_us").get<double>(),
                  each.at("processor_us").get<double>(), 1e-3 * each.at("processor_us").get<double>());
    }
  }
  const auto table = run("play s.h5");
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("exact-refit"));
  EXPECT_THAT(table.out, HasSubstr("built, %"));
  const auto rigid = run("play s.h5 --algorithms exact,bullet-dbvt");
  EXPECT_THAT(rigid.out, HasSubstr("bullet-dbvt: left out: does not take scenes in which a mesh deforms"));
}

TEST_F(SceneCommand, PlaysAScene) {
  ASSERT_EQ(run("make pile -n 60 --frames 4 -o s.h5").exit_code, 0);
  const json played = json_of("play s.h5 --algorithms exact,all-pairs --question touching,near,closest,wrenches");
  ASSERT_EQ(played.size(), 4u);
  for (const json& part : played) {
    ASSERT_EQ(part.at("algorithms").size(), 2u);
    for (const json& each : part.at("algorithms")) {
      EXPECT_EQ(each.at("hash"), part.at("truth"));
      EXPECT_EQ(each.at("missed"), 0);
      EXPECT_EQ(each.at("same_bits"), true);
    }
    EXPECT_LT(part.at("algorithms")[0].at("narrow"), part.at("algorithms")[1].at("narrow"));
  }
  EXPECT_GT(played[1].at("true_pairs"), played[0].at("true_pairs"));
  const auto table = run("play s.h5 --threads 1");
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("pile, touching: 60 bodies, 4 frames, "));
  EXPECT_THAT(table.out, HasSubstr("\n* "));
  EXPECT_THAT(table.out, ::testing::ContainsRegex("\n[* ] exact +[0-9.]+ (us|ms) "));
}

TEST_F(SceneCommand, TakesMeshesAndATableOfPoses) {
  ASSERT_EQ(test::run_program("cd " + folder().string() +
                              " && mkdir meshes && " SIXDOF_PROGRAM " models make sphere-320 -o meshes/ball.ply")
                .exit_code,
            0);
  // Two balls of radius 1 that come within 0.5, then meet.
  std::ofstream(path("poses.csv")) << "frame,body,mesh,tx,ty,tz,qw,qx,qy,qz\n0,1,ball.ply,0,0,0,1,0,0,0\n"
                                      "0,2,ball.ply,3,0,0,1,0,0,0\n1,2,,2.4,0,0,1,0,0,0\n2,2,,1.9,0,0,1,0,0,0\n";
  const auto made = run("make --bodies meshes --poses poses.csv --margin 0.5 -o s.h5");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("margin      0.5\n"));
  const json played = json_of("play s.h5 --algorithms exact --question touching,near");
  EXPECT_EQ(played[0].at("true_pairs"), 1);
  EXPECT_EQ(played[1].at("true_pairs"), 2);
  std::ofstream(path("poses.csv"), std::ios::app) << "3,2,,1.9,0,0,1,0,0\n";
  const auto wrong = run("make --bodies meshes --poses poses.csv -o t.h5");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_EQ(wrong.err, "sixdof: poses.csv: line 6: 9 cells, not 10\n");
  EXPECT_FALSE(std::filesystem::exists(path("t.h5")));
}

TEST_F(SceneCommand, PlaysSomeBodiesAndFrames) {
  ASSERT_EQ(run("make pile -n 60 --frames 4 -o s.h5").exit_code, 0);
  const auto true_pairs = [&](const std::string& part) {
    return json_of("play s.h5 --algorithms exact " + part)[0].at("true_pairs").get<int>();
  };
  int sum = 0;
  for (int frame = 0; frame < 4; ++frame) sum += true_pairs("--frames " + std::to_string(frame));
  EXPECT_EQ(sum, true_pairs(""));
  EXPECT_EQ(true_pairs("--frames 1:2"), true_pairs("--frames 1") + true_pairs("--frames 2"));
  EXPECT_EQ(json_of("play s.h5 --algorithms all-pairs --bodies 3,5,8")[0].at("algorithms")[0].at("pairs_in_all"), 12);
}

/// A big and a small cube, and one that touches the big one, in one frame: a table beside its meshes.
class PosesOfOneFrame : public SceneCommand {
 protected:
  void SetUp() override {
    const auto make = [&](const std::string& diagonal, const std::string& file) {
      const auto made =
          test::run_program(SIXDOF_PROGRAM " models make box-12 --diagonal " + diagonal + " -o " + path(file));
      ASSERT_EQ(made.exit_code, 0) << made.err;
    };
    make("4", "big.off");
    make("0.4", "small.off");
    std::ofstream(path("poses.csv")) << "\xEF\xBB\xBF\"frame\";body;mesh;tx;ty;tz;qw;qx;qy;qz;ignored\r\n"
                                        "0;1;big.off;+0.5;0;0;1;0;0;0;\r\n0;2;small.off;-0.4;0.1;0;1;0;0;0;\r\n"
                                        "0;3;cone-1k;1.2;0;0;1;0;0;0;4\r\n0;4;small.off;1.2;0;0.5;1;0;0;0;\r\n";
    const auto made = run("make --poses poses.csv --margin 0.2 -o s.h5");
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.out, HasSubstr("pairs       5 tested, 1 ignored\n"));
  }
};

TEST_F(PosesOfOneFrame, ListNamesPairsThatTouchNestedOnesToo) {
  const auto list = run("play s.h5 --list");
  ASSERT_EQ(list.exit_code, 0) << list.err;
  EXPECT_EQ(list.out,
            "question,algorithm,frame,body,other,distance,fx,fy,fz,tx,ty,tz\n"
            "touching,exact,0,1,2,0,,,,,,\ntouching,exact,0,1,3,0,,,,,,\ntouching,exact,0,1,4,0,,,,,,\n");
  EXPECT_THAT(run("play s.h5 --list --bodies 1,3").out, ::testing::EndsWith("tz\ntouching,exact,0,1,3,0,,,,,,\n"));
  // The same as of pairs.
  const auto pair =
      test::run_program("cd " + folder().string() +
                        " && " SIXDOF_PROGRAM " query --a big.off --b small.off --pose '-0.9 0.1 0 1 0 0 0' --json");
  EXPECT_EQ(json::parse(pair.out).at("colliding"), true);
  const json near = json_of("play s.h5 --list --question near");
  ASSERT_EQ(near.size(), 1u);
  for (const json& each : near[0].at("pairs")) {
    if (each.at("bodies") == json({1, 2})) ADD_FAILURE() << "their surfaces are further apart than the margin";
  }
}

TEST_F(PosesOfOneFrame, ListHasDistancesAndWrenches) {
  const json list = json_of("play s.h5 --list --question closest,wrenches --algorithms exact,all-pairs");
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(list[0].at("question"), "closest");
  EXPECT_EQ(list[0].at("pairs").size(), 1u);
  EXPECT_EQ(list[0].at("pairs"), list[1].at("pairs"));
  EXPECT_EQ(list[3].at("algorithm"), "all-pairs");
  ASSERT_EQ(list[2].at("wrenches").size(), 4u);
  EXPECT_EQ(list[2].at("wrenches"), list[3].at("wrenches"));
  double sum = 0.0, largest = 0.0;
  for (const json& wrench : list[2].at("wrenches")) {
    sum += wrench.at("force")[0].get<double>();
    largest = std::max(largest, std::abs(wrench.at("force")[0].get<double>()));
  }
  EXPECT_GT(largest, 0.01);
  EXPECT_LE(std::abs(sum), 1e-12 * largest) << "forces between bodies";
  const std::string csv = run("play s.h5 --list --question wrenches").out;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 + 4) << csv;
  EXPECT_THAT(csv, ::testing::ContainsRegex("\nwrenches,exact,0,3,,,[-0-9.e]+,[-0-9.e]+,[-0-9.e]+,"));
}

TEST_F(PosesOfOneFrame, HasATime) {
  const json played = json_of("play s.h5 --algorithms exact,all-pairs")[0];
  int fastest = 0;
  for (const json& each : played.at("algorithms")) {
    EXPECT_GT(each.at("processor_us"), 0.0);
    EXPECT_EQ(each.at("mean_us"), each.at("first_us"));
    fastest += each.at("fastest").get<bool>() ? 1 : 0;
  }
  EXPECT_EQ(fastest, 1);
  EXPECT_THAT(run("play s.h5").out, HasSubstr(": 4 bodies, 1 frame, 3 true pairs"));
}

#ifdef SIXDOF_TEST_FCL  // where FCL is left out, so is its algorithm
TEST_F(PosesOfOneFrame, WhatDoesNotAnswerIsLeftOutWithALine) {
  const auto some = run("play s.h5 --algorithms exact,fcl-hash --question wrenches,touching");
  EXPECT_EQ(some.exit_code, 0) << some.err;
  EXPECT_THAT(some.out, HasSubstr("\n- fcl-hash: left out: does not answer this question\n"));
  EXPECT_THAT(some.out, ::testing::ContainsRegex("\n[* ] fcl-hash "));
  const json played = json_of("play s.h5 --algorithms exact,fcl-hash --question wrenches,touching");
  EXPECT_EQ(played[0].at("left_out")[0].at("algorithm"), "fcl-hash");
  EXPECT_EQ(played[0].at("algorithms").size(), 1u);
  EXPECT_TRUE(played[1].at("left_out").empty());
  // FCL looks at surfaces; the ball in the ball is no miss of it.
  EXPECT_EQ(played[1].at("algorithms")[1].at("missed"), 0);
  EXPECT_GE(played[1].at("algorithms")[1].at("nested"), 1);
  EXPECT_EQ(played[1].at("algorithms")[0].at("nested"), 0);
  const auto list = run("play s.h5 --list --algorithms exact,fcl-hash --question wrenches,touching");
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_EQ(list.err, "sixdof: warning: wrenches: fcl-hash is left out: does not answer this question\n");
  const auto none = run("play s.h5 --algorithms fcl-hash --question wrenches");
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("no question has an answer; wrenches: fcl-hash: does not answer this question"));
}
#endif

TEST_F(PosesOfOneFrame, AnOpenMeshEndsOneQuestionOnly) {
  std::ofstream(path("leaf.off")) << "OFF\n3 1 0\n0 0 0\n3 0 0\n0 3 0\n3 0 1 2\n";
  std::ofstream(path("poses.csv")) << "frame,body,mesh,tx,ty,tz,qw,qx,qy,qz\n0,1,big.off,0,0,0,1,0,0,0\n"
                                      "0,2,leaf.off,0,0,0,1,0,0,0\n";
  ASSERT_EQ(run("make --poses poses.csv -o open.h5").exit_code, 0);
  const auto both = run("play open.h5 --algorithms exact --question wrenches,touching");
  EXPECT_EQ(both.exit_code, 0) << both.err;
  EXPECT_THAT(both.out, HasSubstr("- exact: left out: leaf"));
  EXPECT_THAT(both.out, HasSubstr("poses, touching: 2 bodies, 1 frame, 1 true pairs"));
  EXPECT_EQ(run("play open.h5 --list --question wrenches,touching").exit_code, 0);
  EXPECT_EQ(run("play open.h5 --list --question wrenches").exit_code, 1);
}

#ifdef SIXDOF_TEST_BULLET
/// Two cubes of 2 mm, which cross: Bullet's GImpact finds nothing, since its tolerances are lengths.
TEST_F(SceneCommand, AWrongPairHasItsReproduction) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  test::add_box(Eigen::Vector3d::Constant(-0.001), Eigen::Vector3d::Constant(0.001), vertices, triangles);
  save_mesh(Mesh::build(vertices, triangles, "cube"), path("cube.ply"));
  std::ofstream(path("poses.csv"))
      << "frame,body,mesh,tx,ty,tz,qw,qx,qy,qz\n0,1,cube.ply,1,1,1,1,0,0,0\n"
         "0,21,cube.ply,-0.003912383075545867,0.003998185003560202,0.00010115980928676382,"
         "0.8281198308059594,0.1238881696316525,-0.480579787888994,0.2605999515038282\n"
         "0,25,cube.ply,-0.0019361337966675408,0.0035851440635655935,-0.0018963637264686596,"
         "0.3556680040769872,0.13768780164334826,0.9056799852741918,-0.18516507345677732\n"
         "1,1,,1,1,2,1,0,0,0\n";
  ASSERT_EQ(run("make --poses poses.csv -o 'my scene.h5'").exit_code, 0);
  const auto played = run("play 'my scene.h5' --algorithms bullet-dbvt --frames 1:1 --json");
  ASSERT_EQ(played.exit_code, 0) << played.err;
  const json first = json::parse(played.out)[0].at("algorithms")[0].value("first_wrong", json());
  ASSERT_FALSE(first.is_null()) << "this build of Bullet misses nothing: the test needs another wrong pair";
  EXPECT_EQ(first.at("bodies"), json({21, 25}));
  const std::string command = first.at("reproduction");
  EXPECT_EQ(command,
            "sixdof scene play 'my scene.h5' --question touching --algorithms bullet-dbvt --bodies 21,25 --frames 1");
  const json again =
      json_of(command.substr(std::string("sixdof scene ").size()))[0].at("algorithms")[0].at("first_wrong");
  for (const char* const key : {"bodies", "frame", "distance", "missed"})
    EXPECT_EQ(again.at(key), first.at(key)) << key;
}
#endif

TEST_F(SceneCommand, RefusesInOneLine) {
  ASSERT_EQ(run("make still -n 5 --frames 2 -o s.h5").exit_code, 0);
  const auto refuses = [&](const std::string& arguments, const std::string& message) {
    const auto result = run(arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  refuses("make heap -o t.h5", "no family of scenes heap; there are cube, ");
  refuses("make -o t.h5", "name a family, or give a table of --poses");
  refuses("make --bodies . -o t.h5", "name a family, or give a table of --poses");
  refuses("make cube --bodies . -o t.h5", "--bodies needs a table of --poses");
  refuses("make --poses none.csv -o t.h5", "none.csv: cannot be read");
  refuses("make cube -n 1 -o t.h5", "1 bodies: it must be in 2 .. 1000000");
  refuses("make cube --density -1 -o t.h5", "density -1");
  refuses("make cube", "--output is required");
  refuses("info none.h5", "none.h5: no such file");
  refuses("play s.h5 --algorithms none",
          "no algorithm for scenes none; there are exact, exact-refit, exact-rebuild, all-pairs");
  refuses("play s.h5 --question where", "no question where; there are touching, near, closest, wrenches");
  refuses("play s.h5 --frames 2", "frames 2 to 2: the scene has 0 to 1");
  refuses("play s.h5 --frames 1:", "--frames 1:: give a frame, or FIRST:LAST");
  refuses("play s.h5 --bodies 1,77", "the scene has no body 77");
  EXPECT_FALSE(std::filesystem::exists(path("t.h5")));
}

}  // namespace
}  // namespace sixdof
