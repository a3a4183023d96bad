#include <sixdof/algorithm/fcl/fcl.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/scenario/solids.h>

namespace sixdof {
namespace {

constexpr double k_depth_tolerance = 1e-9;  // of a depth of 4 that FCL computes from planes of triangles

/// The tip of a cone at a depth of 4 in a block.
struct ConeInBlock {
  Mesh block = box_solid({-50.0, -30.0, -40.0}, {45.0, 0.0, 43.0}, "block");
  Mesh cone = cone_solid(10.0, 20.0, 24, RoundParts::inscribed, "cone");
  Pose X_AB{Eigen::Matrix3d::Identity(), {3.1, -4.0, 2.2}};
};

Response respond(const Mesh& a, const Mesh& b, const Pose& X_AB, const char* combine) {
  const auto algorithm = make_fcl_contacts_algorithm();
  Settings settings = algorithm->settings();
  settings.set("combine", combine);
  const auto outcome = algorithm->prepare(a, b, settings)->respond(X_AB);
  EXPECT_TRUE(outcome.ok());
  return outcome.value;
}

TEST(FclContacts, PushesTheTipOut) {
  const ConeInBlock t;
  for (const char* combine : {"mean", "sum", "deepest"}) {
    const Response r = respond(t.block, t.cone, t.X_AB, combine);
    EXPECT_GT(r.force.normalized().y(), 0.99) << combine;
    EXPECT_NEAR(r.penalty, 4.0, k_depth_tolerance) << combine;
    EXPECT_EQ(r.reference, t.X_AB * t.cone.center());
  }
  const Response mean = respond(t.block, t.cone, t.X_AB, "mean");
  EXPECT_LE(mean.force.norm(), 4.0 + 1e-9);
  EXPECT_GT(respond(t.block, t.cone, t.X_AB, "sum").force.norm(), 10.0 * mean.force.norm());
}

TEST(FclContacts, GivesNoForceInside) {
  const ConeInBlock t;
  // Known limit: FCL has surfaces only.
  const Mesh small = cone_solid(3.0, 5.0, 12, RoundParts::inscribed, "small");
  EXPECT_EQ(respond(t.block, small, {Eigen::Matrix3d::Identity(), {3.1, -20.0, 2.2}}, "mean").force.norm(), 0.0);
}

TEST(FclContacts, FailsWhenFclDropsContacts) {
  const ConeInBlock t;
  const auto algorithm = make_fcl_contacts_algorithm();
  Settings settings = algorithm->settings();
  settings.set("max_contacts", "3");
  const auto query = algorithm->prepare(t.block, t.cone, settings);
  EXPECT_EQ(query->respond(t.X_AB).status, Status::failed);
  EXPECT_THAT(query->diagnosis(), ::testing::HasSubstr("more contacts than 3"));
}

}  // namespace
}  // namespace sixdof
