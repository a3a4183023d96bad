#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/geometry/pose.h>
#include "bench/common/run_guarded.h"

#include "run_program.h"

namespace sixdof {
namespace {

using ::testing::HasSubstr;

test::ProgramResult query(const std::string& arguments) {
  return test::run_program(std::string(SIXDOF_PROGRAM) + " query " + arguments);
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

}  // namespace
}  // namespace sixdof
