#include <cmath>
#include <fstream>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/geometry/load.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/save.h>
#include "bench/common/run_guarded.h"

#include "../geometry/scene_files.h"
#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

constexpr double k_digits = 0.05;  // the expected distances have two digits

using ::testing::HasSubstr;

test::ProgramResult query(const std::string& arguments) {
  return test::run_program(std::string(SIXDOF_PROGRAM).append(" query ").append(arguments));
}

nlohmann::json answers(const std::string& arguments) {
  const auto result = query(arguments + " --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out);
}

Eigen::Vector3d vector(const nlohmann::json& json) {
  return Eigen::Vector3d(json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>());
}

constexpr double k_rounding = 1e-14;

// Two boxes 2 x 1.6 x 1.2, the second shifted: their intersection is a box with known edges.
const char* const k_boxes = "--a box-100 --b box-300 --pose '1.7 -0.3 0.4  1 0 0 0'";

TEST(Query, ExactAnswersForTwoBoxesAreThoseOfTheirIntersection) {
  const auto json = answers(k_boxes);
  const Eigen::Vector3d edges(2.0 - 1.7, 1.6 - 0.3, 1.2 - 0.4);
  EXPECT_EQ(json.at("algorithm"), "exact");
  EXPECT_EQ(json.at("status"), "ok");
  EXPECT_EQ(json.at("colliding"), true);
  EXPECT_EQ(json.at("distance"), 0.0);
  EXPECT_NEAR(json.at("volume"), edges.prod(), k_rounding);
  EXPECT_EQ(json.at("penalty"), json.at("volume"));
  // force = -grad V: the intersection shrinks as B moves along (1, -1, 1).
  const Eigen::Vector3d force(edges.y() * edges.z(), -edges.x() * edges.z(), edges.x() * edges.y());
  EXPECT_LE((vector(json.at("force")) - force).norm(), k_rounding);
  EXPECT_LE((vector(json.at("reference_point")) - Eigen::Vector3d(1.7, -0.3, 0.4)).norm(), k_rounding);
  EXPECT_GE(json.at("time_ns"), 0);
}

TEST(Query, DepthOfTwoBoxesIsTheLeastEdgeOfTheirIntersection) {
  const auto json = answers(std::string(k_boxes) + " --depth --along '0 0 2'");
  constexpr double k_of_casts = 1e-9;
  EXPECT_TRUE(json.at("closed"));
  EXPECT_NEAR(json.at("depth_hi"), 0.3, k_of_casts);
  EXPECT_LE(json.at("depth_lo"), 0.3 + k_of_casts);
  EXPECT_GE(json.at("depth_lo"), 0.3 * 0.999 - k_of_casts);
  EXPECT_NEAR(json.at("depth_along"), 0.8, 10.0 * k_of_casts);
  EXPECT_LE((vector(json.at("direction")) - Eigen::Vector3d::UnitX()).norm(), 1e-6);
  EXPECT_EQ(json.at("open_cells"), 0);
  const auto open = answers(std::string(k_boxes) + " --depth --budget 1");
  EXPECT_FALSE(open.at("closed"));
  EXPECT_GT(open.at("open_cells"), 0);
  EXPECT_EQ(answers("--a box-100 --b box-300 --pose '3 0 0 1 0 0 0' --depth").at("depth_hi"), 0.0);
}

TEST(Query, DepthRefusesWhatItCannotTake) {
  for (const char* wrong : {"--depth --tolerance 0", "--depth --budget 0", "--depth --along '0 0 0'",
                            "--depth --along '0 0'", "--depth --only distance", "--budget 5"}) {
    const auto result = query(std::string(k_boxes) + " " + wrong);
    EXPECT_NE(result.exit_code, 0) << wrong;
    EXPECT_EQ(result.out, "") << wrong;
  }
}

TEST(Query, TorqueMovesWithTheReferencePoint) {
  const auto standard = answers(k_boxes), moved = answers(std::string(k_boxes) + " --about '0.5, 2, -1'");
  const Eigen::Vector3d shift = vector(standard.at("reference_point")) - vector(moved.at("reference_point"));
  EXPECT_EQ(vector(moved.at("reference_point")), Eigen::Vector3d(0.5, 2.0, -1.0));
  EXPECT_EQ(vector(moved.at("force")), vector(standard.at("force")));
  const Eigen::Vector3d expected = vector(standard.at("torque")) + shift.cross(vector(standard.at("force")));
  EXPECT_LE((vector(moved.at("torque")) - expected).norm(), k_rounding);
}

TEST(Query, BodiesFarApartAreAnswered) {
  // At 1e9 radii all pairs of triangles, 9e8, have the same distance in floats.
  const auto json = answers("--a sphere-30k --b sphere-30k --pose '6e8 -6.4e8 4.8e8 1 0 0 0'");
  const double between_centers = Eigen::Vector3d(6e8, -6.4e8, 4.8e8).norm();
  constexpr double k_facets = 1e-3;  // of spheres of 30,000 triangles: they lie farther inside by no more
  EXPECT_EQ(json.at("colliding"), false);
  EXPECT_GE(json.at("distance"), between_centers - 2.0 - 1e-6);
  EXPECT_LE(json.at("distance"), between_centers - 2.0 + k_facets);
}

TEST(Query, PoseIsTranslationThenQuaternionWithTheScalarFirst) {
  // A rotation by 90 degrees about z puts B's edge of 2 along y; the gap along x is 2.5 - 1 - 0.8.
  const auto json = answers("--a box-100 --b box-100 --pose '2.5 0 0 0.7071067811865476 0 0 0.7071067811865476'");
  EXPECT_EQ(json.at("colliding"), false);
  EXPECT_NEAR(json.at("distance"), 0.7, k_rounding);
  EXPECT_NEAR((vector(json.at("witness_b")) - vector(json.at("witness_a"))).x(), 0.7, k_rounding);
  EXPECT_EQ(json.at("volume"), 0.0);
}

TEST(Query, AnswersThatAnAlgorithmDoesNotGiveAreNull) {
  const auto json = answers(std::string(k_boxes) + " --algorithm fcl-rss");
  EXPECT_EQ(json.at("status"), "ok");
  for (const char* key : {"colliding", "penalty", "volume", "force", "torque", "reference_point"}) {
    EXPECT_TRUE(json.at(key).is_null()) << key;
  }
  EXPECT_EQ(json.at("distance"), 0.0);
  EXPECT_THAT(query(std::string(k_boxes) + " --algorithm fcl-rss").out, ::testing::Not(HasSubstr("force")));
}

TEST(Query, ParametersReachTheAlgorithm) {
  const std::string ist = std::string(k_boxes) + " --algorithm ist -p spheres=50 --parameter force=gradient";
  EXPECT_THAT(answers(ist).at("settings").get<std::string>(), HasSubstr("spheres=50"));
}

TEST(Query, InnerSphereTreesHaveTheirForceLawsAndNumbersOfSpheres) {
  const std::string spheres = " -p spheres=60 -p spheres_b=40";
  const auto force = [&](const std::string& algorithm) {
    return answers(std::string(k_boxes) + " --algorithm " + algorithm + spheres).at("force");
  };
  const auto cones = force("ist");
  EXPECT_EQ(cones, force("ist -p force=cones"));
  EXPECT_NE(cones, force("ist -p force=volume"));
  EXPECT_NE(cones, force("ist-descent"));
  EXPECT_THAT(answers(std::string(k_boxes) + " --algorithm ist-descent" + spheres).at("settings").get<std::string>(),
              HasSubstr("spheres_b=40"));
}

TEST(Query, AMotionIsAskedForItsFirstContact) {
  // A gap of 3 - 2 between boxes that are 2 long; B moves by 4 in the time from 0 to 1.
  const auto json = answers("--a box-100 --b box-300 --pose '3 0.1 0.2 1 0 0 0' --motion '-4 0 0'");
  EXPECT_EQ(json.at("hit"), true);
  EXPECT_NEAR(json.at("t"), 0.25, 1e-9);
  EXPECT_EQ(json.at("contact_at_start"), false);
  EXPECT_NEAR(vector(json.at("normal")).x(), 1.0, 1e-6);
  EXPECT_NEAR(vector(json.at("witness_a")).x(), 1.0, 1e-8);
  for (const char* key : {"colliding", "distance", "force"}) EXPECT_TRUE(json.at(key).is_null()) << key;
  // B is 1.6 wide: turned by 90 degrees about z, it does not come near enough. Where it turns less, it is farther away.
  EXPECT_EQ(answers("--a box-100 --b box-300 --pose '3 0.1 0.2 1 0 0 0' --motion '-1.1 0 0'").at("hit"), true);
  const auto turned = answers("--a box-100 --b box-300 --pose '3 0.1 0.2 1 0 0 0' --motion '-1.1 0 0 0 0 1.5707963'");
  EXPECT_EQ(turned.at("hit"), false);
  EXPECT_EQ(answers("--a box-100 --b box-300 --pose '3 0.1 0.2 1 0 0 0' --motion '4 0 0'").at("hit"), false);
  EXPECT_EQ(answers(std::string(k_boxes) + " --motion '4 0 0'").at("contact_at_start"), true);
}

TEST(Query, RefusesWhatIsNoMotion) {
  EXPECT_THAT(query(std::string(k_boxes) + " --motion '1 2'").err, HasSubstr("2 numbers instead of 3, 6 or 9"));
  EXPECT_THAT(query(std::string(k_boxes) + " --motion '1 2 3' --algorithm ode").err,
              HasSubstr("gives no answer to a motion"));
  EXPECT_THAT(query(std::string(k_boxes) + " --algorithm sampled").err, HasSubstr("give it a --motion"));
}

TEST(Query, ContactsAreJudgedByExactGeometry) {
  // B stands 0.1 deep on A, turned about the vertical.
  const std::string pose = "--a box-12 --b box-12 --pose '0.1 -0.2 1.1  0.9393727128473789 0 0 0.3428978074554513' ";
  const auto json = answers(pose + "--algorithm exact-contacts --contacts 1000");
  EXPECT_EQ(json.at("depth_of"), "local");
  ASSERT_GT(json.at("contacts").size(), 4u);
  for (const auto& each : json.at("contacts")) {
    EXPECT_NEAR(each.at("off"), 0.0, 1e-9);
    EXPECT_LT(each.at("normal_degrees"), 0.01);
    EXPECT_NEAR(each.at("depth"), each.at("thickness"), 1e-9);
  }
  EXPECT_TRUE(json.at("colliding").is_null());
  EXPECT_GE(json.at("times_ns").at("contacts"), 0);
  const auto some = answers(pose + "--algorithm fcl-contacts --contacts 3");
  EXPECT_EQ(some.at("contacts").size(), 3u);
  EXPECT_EQ(some.at("depth_of"), "triangles");
  EXPECT_THAT(query(pose + "--algorithm ode --contacts 2").out, HasSubstr("contact          {\"point\":"));
  EXPECT_THAT(query(pose + "--contacts 3").err, HasSubstr("exact gives no contacts"));
  EXPECT_THAT(query(pose + "--algorithm exact-contacts").err, HasSubstr("ask for them by --contacts"));
}

TEST(Query, AsksOnlyWhatIsWanted) {
  const auto json = answers(std::string(k_boxes) + " --only distance");
  EXPECT_EQ(json.at("distance"), 0.0);
  for (const char* key : {"colliding", "force", "volume", "no_response"}) EXPECT_TRUE(json.at(key).is_null()) << key;
  EXPECT_TRUE(json.at("times_ns").at("respond").is_null());
  EXPECT_FALSE(json.at("times_ns").at("distance").is_null());
  const auto two = answers(std::string(k_boxes) + " --only collide,respond");
  EXPECT_EQ(two.at("colliding"), true);
  EXPECT_FALSE(two.at("force").is_null());
  EXPECT_TRUE(two.at("distance").is_null());
  EXPECT_EQ(answers(std::string(k_boxes) + " --only collide --only distance").at("distance"), 0.0);
  const auto unasked = query(std::string(k_boxes) + " --algorithm fcl-rss --only respond");
  EXPECT_EQ(unasked.exit_code, k_exit_error);
  EXPECT_THAT(unasked.err, HasSubstr("fcl-rss gives no answer to respond"));
  const auto unknown = query(std::string(k_boxes) + " --only force");
  EXPECT_EQ(unknown.exit_code, k_exit_usage);
  EXPECT_THAT(unknown.err, HasSubstr("force not in {collide,distance,respond}"));
}

TEST(Query, APoseNeedsNoQuotes) {
  const auto quoted = answers("--a box-100 --b box-100 --pose '2.5 0 -0.5 1 0 0 0'");
  const auto words = answers("--a box-100 --b box-100 --pose 2.5 0 -0.5 1 0 0 0");
  EXPECT_EQ(words.at("witness_a"), quoted.at("witness_a"));
  EXPECT_EQ(words.at("distance"), quoted.at("distance"));
  const auto few = query("--a box-100 --b box-100 --pose 2.5 0 0 1 0 0");
  EXPECT_EQ(few.exit_code, k_exit_error);
  EXPECT_THAT(few.err, HasSubstr("6 numbers instead of 7"));
}

/// Meshes with a border.
class QueryOfOpenMeshes : public test::ScratchFolder {
 protected:
  QueryOfOpenMeshes() {
    // A box without its lid, 1 x 1 x 1; a triangle; a cube of 0.2, closed.
    std::ofstream(path("tray.off")) << "OFF\n8 10 0\n"
                                       "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
                                       "3 0 2 1\n3 0 3 2\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n"
                                       "3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";
    std::ofstream(path("leaf.off")) << "OFF\n3 1 0\n0 0 0\n0.25 0 0\n0 0.25 0\n3 0 1 2\n";
    EXPECT_EQ(test::run_program(SIXDOF_PROGRAM " models make box-12 --diagonal 0.2 -o " + path("small.off")).exit_code,
              0);
  }
  std::string pair(const char* a, const char* b, const char* pose) const {
    return "--a " + (std::string(a).find('.') == std::string::npos ? a : path(a)) + " --b " + path(b) + " --pose '" +
           pose + " 1 0 0 0'";
  }
};

TEST_F(QueryOfOpenMeshes, HaveYesNoAndDistanceAndAReasonWhyThereIsNoResponse) {
  for (const auto& [a, b, pose, distance] :
       {std::tuple("tray.off", "small.off", "0.5 0.5 3", 2.004), std::tuple("tray.off", "tray.off", "1.5 0 0", 0.5),
        std::tuple("box-12", "leaf.off", "0 0 2", 1.4), std::tuple("tray.off", "leaf.off", "0.5 0.25 0.5", 0.25)}) {
    SCOPED_TRACE(pair(a, b, pose));
    const auto json = answers(pair(a, b, pose));
    EXPECT_EQ(json.at("status"), "ok");
    EXPECT_EQ(json.at("colliding"), false);
    EXPECT_NEAR(json.at("distance"), distance, k_digits);
    EXPECT_TRUE(json.at("force").is_null());
    EXPECT_TRUE(json.at("diagnosis").is_null());
    EXPECT_THAT(json.at("no_response").get<std::string>(), HasSubstr("not closed"));
    EXPECT_THAT(query(pair(a, b, pose)).out, HasSubstr("no_response "));
  }
  EXPECT_EQ(answers(pair("tray.off", "leaf.off", "0 0.5 0.5")).at("colliding"), true);
  EXPECT_TRUE(answers(pair("tray.off", "leaf.off", "0 0.5 0.5") + " --only collide").at("no_response").is_null());
  // Asked for nothing but the response, there is no answer.
  const auto alone = query(pair("tray.off", "leaf.off", "0 0.5 0.5") + " --only respond");
  EXPECT_EQ(alone.exit_code, k_exit_error);
  EXPECT_THAT(alone.err, HasSubstr("not closed"));
}

TEST_F(QueryOfOpenMeshes, ABodyInsideASolidCollidesWithItAndInsideATrayDoesNot) {
  const auto solid = answers("--a box-12 --b " + path("small.off") + " --pose '0 0 0 1 0 0 0'");
  EXPECT_EQ(solid.at("colliding"), true);
  EXPECT_EQ(solid.at("nested"), true);
  EXPECT_GT(solid.at("distance"), 0.4);
  EXPECT_TRUE(solid.at("no_response").is_null());
  const auto tray = answers(pair("tray.off", "small.off", "0.5 0.5 0.5"));
  EXPECT_EQ(tray.at("colliding"), false);
  EXPECT_TRUE(tray.at("nested").is_null());
}

TEST(Query, RefusesBadArgumentsAndNamesThem) {
  const auto refuses = [](const std::string& arguments, const std::string& words) {
    const auto result = query(arguments);
    EXPECT_EQ(result.exit_code, k_exit_error) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_THAT(result.err, HasSubstr(words)) << arguments;
  };
  const std::string boxes = "--a box-100 --b box-100 ";
  refuses(boxes + "--pose '0 0 0 0.707107 0 0 0'", "norm");
  refuses(boxes + "--pose '0 0 nan 1 0 0 0'", "finite");
  refuses(boxes + "--pose '0 0 0 1 0 0'", "6 numbers instead of 7");
  refuses(boxes + "--pose '0 0 0 1 0 0 x'", "number 7");
  refuses(boxes + "--pose '0 0 0 1 0 0 0' --about '1 2'", "--about");
  refuses(boxes + "--pose '0 0 0 1 0 0 0' --algorithm exactly", "no such algorithm");
  refuses(boxes + "--pose '0 0 0 1 0 0 0' --algorithm ist -p sphere=3", "no such parameter");
  refuses(boxes + "--pose '0 0 0 1 0 0 0' --algorithm ist -p force=steepest_descent", "force");
  refuses(boxes + "--pose '0 0 0 1 0 0 0' --algorithm ist-descent -p force=cones", "no such parameter");
  refuses("--a elefant --b box-100 --pose '0 0 0 1 0 0 0'", "elefant");
  refuses("--a box-100 --b no_such_file.ply --pose '0 0 0 1 0 0 0'", "no_such_file.ply");
  EXPECT_EQ(query("--a box-100 --b box-100").exit_code, k_exit_usage);
}

TEST(Query, PassesOnTwelveNumbersWhateverTheyAre) {
  const std::string pair = "--a cone-1k --b torus-1k --json --pose ";
  const auto typed = query(pair + "'2.5 0.2 0.1 0 1 0 0'"), matrix = query(pair + "'1 0 0 0 -1 0 0 0 -1 2.5 0.2 0.1'");
  ASSERT_EQ(matrix.exit_code, 0) << matrix.err;
  EXPECT_EQ(nlohmann::json::parse(matrix.out).at("distance"), nlohmann::json::parse(typed.out).at("distance"));
  const auto bad = query(pair + "'1 0 0 0 nan 0 0 0 1 2.5 0.2 0.1'");
  EXPECT_EQ(bad.exit_code, k_exit_error);
  EXPECT_EQ(nlohmann::json::parse(bad.out).at("status"), "non_finite");
}

class ColladaBesideOff : public test::ScratchFolder {};

TEST_F(ColladaBesideOff, WhatTheFileStatesIsSaidAndOneWordMakesThemMeet) {
  std::string pyramid = testing_support::collada_pyramid("2 2 0");
  const std::string axis = "<up_axis>Y_UP";
  pyramid.replace(pyramid.find(axis), axis.size(), R"(<unit name="centimeter" meter="0.01"/><up_axis>Z_UP)");
  std::ofstream(path("part.dae")) << pyramid;
  save_mesh(load_mesh(path("part.dae") + "#as-stored"), path("part.off"));
  const std::string pose = " --pose '0 0 0 1 0 0 0'";
  const auto pair = [&](const std::string& words) {
    return "--a '" + path("part.dae") + words + "' --b " + path("part.off") + pose;
  };
  EXPECT_EQ(answers(pair("#as-stored")).at("volume"), 4.0);
  EXPECT_EQ(answers(pair("")).at("colliding"), false) << "in metres it is a hundredth";
  EXPECT_THAT(query(pair("")).err,
              HasSubstr("part.dae: the file's unit is 0.01 m and z points up; scaled to metres; axes kept"));
  const auto info = test::run_program(std::string(SIXDOF_PROGRAM) + " info '" + path("part.dae") + "#as-stored'");
  EXPECT_THAT(info.out, HasSubstr("the file's unit is 0.01 m and z points up; read as stored"));
}

}  // namespace
}  // namespace sixdof
