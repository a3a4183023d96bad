// `sixdof scene make`, `info` and `play`.

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

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
  EXPECT_THAT(table.out, HasSubstr("\nexact "));
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

TEST_F(SceneCommand, RefusesInOneLine) {
  ASSERT_EQ(run("make still -n 5 --frames 2 -o s.h5").exit_code, 0);
  const auto refuses = [&](const std::string& arguments, const std::string& message) {
    const auto result = run(arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  refuses("make heap -o t.h5", "no family of scenes heap; there are cube, ");
  refuses("make -o t.h5", "name a family, or give --bodies and --poses");
  refuses("make --poses p.csv -o t.h5", "--bodies and --poses belong together");
  refuses("make cube -n 1 -o t.h5", "1 bodies: it must be in 2 .. 1000000");
  refuses("make cube --density -1 -o t.h5", "density -1");
  refuses("make cube", "--output is required");
  refuses("info none.h5", "none.h5: no such file");
  refuses("play s.h5 --algorithms none", "no algorithm for scenes none; there are exact, all-pairs");
  refuses("play s.h5 --question where", "no question where; there are touching, near, closest, wrenches");
  EXPECT_FALSE(std::filesystem::exists(path("t.h5")));
}

}  // namespace
}  // namespace sixdof
