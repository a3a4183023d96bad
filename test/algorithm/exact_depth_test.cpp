// The oracle itself: test/oracle/depth_integral_test.cpp. Here what the algorithms make of it.

#include <memory>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>
#include <sixdof/models/recipe.h>
#include <sixdof/oracle/depth_integral.h>

#include "../oracle/bodies.h"

namespace sixdof {
namespace {

struct ExactDepth : ::testing::Test {
  const Mesh a = make_torus_knot({}, 600), b = make_bumpy_sphere({}, 400);
  const Pose X{[] {
                 std::mt19937_64 random(3);
                 return bodies::random_pose(random, 0.0).R;
               }(),
               {1.1, 0.7, 0.1}};

  std::unique_ptr<Query> prepare(const Algorithm& algorithm, const std::vector<std::string>& values = {}) const {
    Settings settings = algorithm.settings();
    settings.set_all(values);
    return algorithm.prepare(a, b, settings);
  }
};

TEST_F(ExactDepth, AnswersWithTheIntegral) {
  const auto algorithm = make_exact_depth_algorithm();
  EXPECT_EQ(algorithm->traits().law, ResponseLaw::depth);
  EXPECT_FALSE(algorithm->traits().in_default_runs());
  const Response answer = prepare(*algorithm, {"tolerance=0.002"})->respond(X).value;
  const DepthIntegral found = DepthOracle(a, b).evaluate(X, DepthDirection::normal_of_b, {.relative = 0.002});
  EXPECT_EQ(answer.force, found.force);
  EXPECT_EQ(answer.torque, found.torque);
  EXPECT_EQ(answer.reference, X * b.center());
  EXPECT_EQ(answer.penalty, found.depth);
  EXPECT_GT(answer.penalty, 0.0);
}

TEST_F(ExactDepth, HasTwoLaws) {
  const auto way_out = make_exact_way_out_algorithm();
  EXPECT_EQ(way_out->traits().law, ResponseLaw::way_out);
  const Response answer = prepare(*way_out, {"tolerance=0.01"})->respond(X).value;
  const DepthIntegral found = DepthOracle(a, b).evaluate(X, DepthDirection::way_out, {.relative = 0.01});
  EXPECT_EQ(answer.force, found.force);
  EXPECT_NE(answer.force, prepare(*make_exact_depth_algorithm(), {"tolerance=0.01"})->respond(X).value.force);
}

TEST_F(ExactDepth, FailsWithWordsWhereItDoesNotConverge) {
  const auto query = prepare(*make_exact_depth_algorithm(), {"tolerance=1e-7", "most_pieces=1000"});
  EXPECT_EQ(query->respond(X).status, Status::failed);
  EXPECT_NE(query->diagnosis().find("pieces"), std::string::npos) << query->diagnosis();
  Pose bad = X;
  bad.R *= 2.0;
  EXPECT_EQ(query->respond(bad).status, Status::failed);
}

TEST_F(ExactDepth, RefusesOpenMeshes) {
  std::vector<Triangle> t = a.triangles();
  t.pop_back();
  const Mesh open = Mesh::build(a.vertices(), std::move(t), "open");
  const auto algorithm = make_exact_depth_algorithm();
  EXPECT_THROW(algorithm->prepare(open, b, algorithm->settings()), BadMesh);
}

}  // namespace
}  // namespace sixdof
