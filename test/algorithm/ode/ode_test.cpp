#include <sixdof/algorithm/ode/ode.h>

#include <stdexcept>

#include <ode/ode.h>

#include <sixdof/conformance/conformance.h>

#include "../contact_checks.h"

namespace sixdof {
namespace {

SIXDOF_CONFORMANCE(make_ode_algorithm);

TEST(Ode, PushesABallOutOfAFace) {
  // Only facets that cross the face are contacts; the lowest lies wholly below it. FCL gives the same depth.
  test::expect_ball_pushed_out(*make_ode_algorithm(), 0.75);
}

TEST(Ode, GivesNoForceInside) { test::expect_no_contact_inside(*make_ode_algorithm()); }

TEST(Ode, FailsWhenOdeDropsContacts) {
  const test::BallOnFace t;
  const auto algorithm = make_ode_algorithm();
  const auto query = test::prepare(*algorithm, t.block, t.ball, {"max_contacts=2"});
  EXPECT_EQ(query->respond(t.X_AB).status, Status::failed);
  EXPECT_THAT(query->diagnosis(), ::testing::HasSubstr("more contacts than 2"));
  EXPECT_TRUE(query->collide(t.X_AB).value);
}

TEST(Ode, NeitherPrintsNorEndsTheProcess) {
  const test::BallOnFace t;
  const auto algorithm = make_ode_algorithm();
  const auto query = test::prepare(*algorithm, t.block, t.ball);
  ::testing::internal::CaptureStderr();
  dMessage(1, "a message");
  EXPECT_THROW(dError(1, "error %d", 7), std::runtime_error);
  EXPECT_THROW(dDebug(1, "failed assertion"), std::runtime_error);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

/// A pose at which GImpact, by the same author, finds a contact.
TEST(Ode, TellsABallAboveATiltedPlateApart) {
  const Mesh plate = box_solid({-5.0, -0.1, -5.0}, {5.0, 0.0, 5.0}, "plate");
  const Mesh ball = sphere_solid(1.0, 24, RoundParts::inscribed, "ball");
  const Pose tilt{(Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()))
                      .toRotationMatrix(),
                  Eigen::Vector3d::Zero()};
  const Pose above{Eigen::Matrix3d::Identity(), {0.31, 3.0, 0.27}};
  const auto algorithm = make_ode_algorithm();
  EXPECT_FALSE(test::prepare(*algorithm, plate, ball)->collide(above).value);
  const Mesh tilted = test::moved(plate, tilt);
  EXPECT_FALSE(test::prepare(*algorithm, tilted, ball)->collide(tilt * above).value);
}

TEST(Ode, SharesTheStructureOfEqualMeshes) {
  const Mesh a = load_model("cone-1k"), b = load_model("torus-1k");
  const auto algorithm = make_ode_algorithm();
  const auto triangles = [](const Query& query) { return query.footprint().counts.back().second; };
  EXPECT_EQ(triangles(*test::prepare(*algorithm, a, a)), static_cast<double>(a.triangles().size()));
  EXPECT_EQ(triangles(*test::prepare(*algorithm, a, b)),
            static_cast<double>(a.triangles().size() + b.triangles().size()));
}

TEST(Ode, RegistersWithVersionAndPrecision) {
  Registry registry;
  register_ode_algorithms(registry);
  EXPECT_THAT(registry.find("ode").traits().version, ::testing::MatchesRegex("[0-9.]+ double"));
}

}  // namespace
}  // namespace sixdof
