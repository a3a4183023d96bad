#include <sixdof/algorithm/core_algorithms.h>

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "../geometry/shapes.h"
#include "../oracle/bodies.h"

namespace sixdof {
namespace {

constexpr double k_far_rounding = 1e-13;     // relative: of a pose far away
constexpr double k_volume_rounding = 1e-15;  // of a volume of 0.016, a sum over some corners

using Eigen::Vector3d;

Pose rotated_about(const Pose& X, const Vector3d& point, const Vector3d& rotation) {
  const Eigen::Matrix3d R = rotation.norm() > 0.0
                                ? Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix()
                                : Eigen::Matrix3d::Identity();
  return {R * X.R, point + R * (X.t - point)};
}

TEST(ExactAlgorithm, ResponseIsMinusTheGradientOfTheVolume) {
  const Mesh a = bodies::bumpy_sphere(4), b = bodies::bumpy_torus(40, 16);
  const auto algorithm = make_exact_algorithm();
  EXPECT_EQ(algorithm->traits().law, ResponseLaw::volume);
  const auto query = algorithm->prepare(a, b, algorithm->settings());
  const auto response = [&](const Pose& X) { return query->respond(X).value; };
  std::mt19937_64 random(31);
  // Second order in the step; third derivatives of the volume are some tens.
  constexpr double k_step = 1e-4;
  constexpr double k_tolerance = 1e-5;
  for (int i = 0; i < 10; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.3);
    const Outcome<Response> r = query->respond(X_AB);
    ASSERT_TRUE(r.ok());
    EXPECT_EQ(r.value.penalty, r.value.volume);
    EXPECT_EQ(r.value.reference, X_AB * b.center());
    for (int k = 0; k < 3; ++k) {
      const Vector3d u = k_step * Vector3d::Unit(k);
      const double slope = (response({X_AB.R, X_AB.t + u}).penalty - response({X_AB.R, X_AB.t - u}).penalty);
      EXPECT_NEAR(r.value.force[k], -slope / (2.0 * k_step), k_tolerance);
      const Vector3d& about = r.value.reference;
      const double rotation_slope =
          response(rotated_about(X_AB, about, u)).penalty - response(rotated_about(X_AB, about, -u)).penalty;
      EXPECT_NEAR(r.value.torque[k], -rotation_slope / (2.0 * k_step), k_tolerance);
    }
  }
}

TEST(ExactAlgorithm, ForcePushesBOutOfA) {
  const Mesh a = bodies::box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}), b = bodies::box({-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2});
  const auto algorithm = make_exact_algorithm();
  const auto query = algorithm->prepare(a, b, algorithm->settings());
  const Outcome<Response> r = query->respond({Eigen::Matrix3d::Identity(), {0.1, 0.05, 0.4}});
  ASSERT_TRUE(r.ok());
  // B penetrates 0.1 into A's upper face with an area of 0.16.
  EXPECT_NEAR(r.value.volume, 0.016, k_volume_rounding);
  EXPECT_LT((r.value.force - Vector3d(0.0, 0.0, 0.16)).norm(), 1e-15);
  EXPECT_LT(r.value.torque.norm(), 1e-15);
}

TEST(ExactAlgorithm, TakesOneMeshAsBothBodies) {
  const Mesh a = bodies::bumpy_torus(24, 12);
  const Mesh copy = bodies::moved(a, Pose{});
  const auto algorithm = make_exact_algorithm();
  const auto shared = algorithm->prepare(a, a, algorithm->settings());
  const auto two = algorithm->prepare(a, copy, algorithm->settings());
  std::mt19937_64 random(32);
  for (int i = 0; i < 5; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.5);
    EXPECT_EQ(shared->respond(X_AB).value.penalty, two->respond(X_AB).value.penalty);
  }
  EXPECT_LT(shared->footprint().bytes, two->footprint().bytes);
}

TEST(ExactAlgorithm, GivesAReasonWhereAMeshIsNotSolid) {
  const Mesh solid = bodies::bumpy_sphere(2);
  std::vector<Triangle> t = solid.triangles();
  t.pop_back();
  const Mesh open = Mesh::build(solid.vertices(), t, "open");
  const auto algorithm = make_exact_algorithm();
  for (const auto& [a, b] : {std::pair(&solid, &open), std::pair(&open, &solid)}) {
    const auto query = algorithm->prepare(*a, *b, algorithm->settings());
    EXPECT_EQ(query->respond(Pose{}).status, Status::failed);
    EXPECT_EQ(query->diagnosis(), "open: " + open.why_not_solid() + k_repair_hint);
    EXPECT_TRUE(query->distance(Pose{}).ok());
  }
}

TEST(ExactAlgorithm, RefusesPosesThatAreNotRigid) {
  const Mesh mesh = shapes::box({0.3, 0.4, 0.5});
  const auto exact = make_exact_algorithm();
  const auto query = exact->prepare(mesh, mesh, exact->settings());
  Pose pose;
  pose.t.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(query->distance(pose).status, Status::non_finite);
  EXPECT_EQ(query->collide(pose).status, Status::non_finite);
  EXPECT_FALSE(query->diagnosis().empty());
  pose = Pose();
  pose.R *= 1.001;
  EXPECT_EQ(query->distance(pose).status, Status::failed);
  pose.R = -Eigen::Matrix3d::Identity();
  EXPECT_EQ(query->distance(pose).status, Status::failed);
}

TEST(ExactAlgorithm, AnswersAtAnySeparationThatADoubleHolds) {
  const Mesh mesh = shapes::bumpy_sphere(3, 0.2);
  const auto exact = make_exact_algorithm();
  Settings threads = exact->settings();
  threads.set("threads", "2");
  for (const Settings& settings : {exact->settings(), threads}) {
    const auto query = exact->prepare(mesh, mesh, settings);
    for (const double far : {1e14, 1e155, 1e308}) {
      const Pose pose{Eigen::Matrix3d::Identity(), Vector3d(far, 0.3 * far, -0.2 * far)};
      const Outcome<Separation> separation = query->distance(pose);
      ASSERT_TRUE(separation.ok());
      EXPECT_NEAR(separation.value.distance / far, std::sqrt(1.13), k_far_rounding);
      EXPECT_FALSE(query->collide(pose).value);
      ASSERT_TRUE(query->respond(pose).ok());
      EXPECT_EQ(query->respond(pose).value.volume, 0.0);
      EXPECT_EQ(query->respond(pose).value.force, Vector3d::Zero());
    }
    const Pose beyond{Eigen::Matrix3d::Identity(), Vector3d(1.7e308, 1.7e308, 0.0)};
    EXPECT_EQ(query->distance(beyond).status, Status::non_finite);
    EXPECT_NE(query->diagnosis(), "");
    const Outcome<bool> meets = query->collide(beyond);
    EXPECT_TRUE(meets.ok() && !meets.value);
  }
}

TEST(ExactAlgorithm, ThreadsChangeNoResponse) {
  const Mesh mesh = shapes::bumpy_sphere(4, 0.25), other = shapes::bumpy_sphere(3, 0.1);
  const auto exact = make_exact_algorithm();
  Settings wide = exact->settings();
  wide.set("threads", "3");
  EXPECT_THROW(wide.set("threads", "0"), BadArgument);
  const auto query = exact->prepare(mesh, other, exact->settings()), wide_query = exact->prepare(mesh, other, wide);
  shapes::Generator generator(4);
  std::size_t touching = 0;
  for (int i = 0; i < 60; ++i) {
    const Pose pose = shapes::random_pose(generator, 1.0);
    const Response expected = query->respond(pose).value, response = wide_query->respond(pose).value;
    EXPECT_EQ(response.volume, expected.volume);
    EXPECT_EQ(response.force, expected.force);
    EXPECT_EQ(response.torque, expected.torque);
    EXPECT_EQ(wide_query->distance(pose).value.distance, query->distance(pose).value.distance);
    if (expected.volume > 0.0 && !expected.force.isZero()) ++touching;
  }
  EXPECT_GT(touching, 20u);
}

TEST(ExactAlgorithm, WarmStartChangesNoDistanceAndNoResponse) {
  const Mesh mesh = shapes::bumpy_sphere(4, 0.25);
  const auto exact = make_exact_algorithm();
  Settings warm = exact->settings();
  warm.set("warm_start", "on");
  const auto cold_query = exact->prepare(mesh, mesh, exact->settings());
  const auto warm_query = exact->prepare(mesh, mesh, warm);
  shapes::Generator generator(2);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = shapes::random_pose(generator, 2.0);
    EXPECT_EQ(warm_query->distance(pose).value.distance, cold_query->distance(pose).value.distance);
    EXPECT_EQ(warm_query->collide(pose).value, cold_query->collide(pose).value);
  }
  std::size_t touching = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose pose{Eigen::Matrix3d::Identity(), {1.9 - 1e-3 * i, 0.3, 0.2}};
    const Response warm_response = warm_query->respond(pose).value, response = cold_query->respond(pose).value;
    EXPECT_EQ(warm_response.volume, response.volume);
    EXPECT_EQ(warm_response.force, response.force);
    EXPECT_EQ(warm_response.torque, response.torque);
    if (response.volume > 0.0) ++touching;
  }
  EXPECT_GT(touching, 100u);
}

}  // namespace
}  // namespace sixdof
