#include <sixdof/geometry/motion.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "shapes.h"

namespace sixdof {
namespace {

using Eigen::Vector3d;
using shapes::Generator;
using shapes::uniform;
using shapes::uniform_vector;

/// Some tens of roundings of coordinates of size 10 and angles up to 40.
constexpr double k_rounding = 2e-13;

Motion random_motion(Generator& generator) {
  return {shapes::random_pose(generator, 3.0), uniform_vector(generator, 5.0),
          uniform(generator, 0.0, 40.0) * shapes::unit_vector(generator), uniform_vector(generator, 2.0)};
}

/// By the definition, with Eigen's rotation.
Vector3d moved(const Motion& motion, const Vector3d& p, double t) {
  const double angle = motion.rotation.norm();
  const Eigen::Matrix3d turn = angle > 0.0 ? Eigen::AngleAxisd(t * angle, motion.rotation / angle).toRotationMatrix()
                                           : Eigen::Matrix3d::Identity();
  return turn * (motion.start.R * (p - motion.reference)) + motion.start * motion.reference + t * motion.translation;
}

TEST(Motion, MovesPointsAsDefined) {
  Generator generator(1);
  for (int i = 0; i < 200; ++i) {
    Motion motion = random_motion(generator);
    if (i % 4 == 0) motion.start.R *= 1.0 + 1e-7;  // not quite a rotation
    for (const double t : {0.0, 0.123, 0.77, 1.0}) {
      const Vector3d p = uniform_vector(generator, 2.0);
      EXPECT_LT((motion.pose_at(t) * p - moved(motion, p, t)).norm(), k_rounding);
    }
  }
}

TEST(Motion, BeginsExactlyAtItsStart) {
  Generator generator(2);
  const Motion motion = random_motion(generator);
  EXPECT_EQ(motion.pose_at(0.0).R, motion.start.R);
  EXPECT_EQ(motion.pose_at(0.0).t, motion.start.t);
}

TEST(Motion, KeepsTheMatrixOfATranslation) {
  Generator generator(3);
  Motion motion = random_motion(generator);
  motion.rotation.setZero();
  EXPECT_TRUE(motion.is_translation());
  EXPECT_EQ(motion.pose_at(0.31).R, motion.start.R);
  EXPECT_EQ(motion.pose_at(0.31).t, Vector3d(motion.start.t + 0.31 * motion.translation));
}

TEST(Motion, TurnsByAnglesFarAbovePi) {
  for (const double angle : {1e-9, 1.0, 7.0, 1000.25, 999'999.5}) {
    const Motion motion{.rotation = {0.0, 0.0, angle}};
    const Pose end = motion.pose_at(1.0);
    EXPECT_NEAR(end.R(0, 0), std::cos(angle), 4e-16) << angle;
    EXPECT_NEAR(end.R(1, 0), std::sin(angle), 4e-16) << angle;
    EXPECT_EQ(end.R(2, 2), 1.0);
  }
}

TEST(Motion, AScrewKeepsItsAxis) {
  Generator generator(4);
  const Pose start = shapes::random_pose(generator, 2.0);
  const Vector3d point(0.3, -1.2, 0.7), axis = shapes::unit_vector(generator);
  const Motion motion = Motion::screw(start, point, 2.5 * axis, 0.9);
  const Vector3d on_axis = start.inverse() * (point + 0.4 * axis);
  for (const double t : {0.25, 1.0}) {
    EXPECT_LT((motion.pose_at(t) * on_axis - (point + (0.4 + 0.9 * t) * axis)).norm(), k_rounding);
  }
}

TEST(Motion, InverseOfTranslationRotationAndScrew) {
  Generator generator(5);
  for (int kind = 0; kind < 3; ++kind) {
    Motion motion = random_motion(generator);
    if (kind == 0) motion.rotation.setZero();
    if (kind == 1) motion.translation.setZero();
    if (kind == 2) motion.translation = 0.2 * motion.rotation;
    const auto inverse = motion.inverse();
    ASSERT_TRUE(inverse) << kind;
    for (const double t : {0.0, 0.4, 1.0}) {
      const Pose both = motion.pose_at(t) * inverse->pose_at(t);
      EXPECT_LT((both.R - Eigen::Matrix3d::Identity()).norm(), k_rounding) << kind;
      EXPECT_LT(both.t.norm(), k_rounding) << kind;
    }
  }
  EXPECT_FALSE(random_motion(generator).inverse()) << "a tumbling flight has no inverse of this form";
}

TEST(Motion, SaysWhatItCannotCompute) {
  EXPECT_EQ(Motion{}.why_invalid(), nullptr);
  EXPECT_STREQ((Motion{.rotation = {0.0, 2e6, 0.0}}.why_invalid()),
               "the motion rotates by more than a million radians");
  for (Vector3d Motion::*member : {&Motion::translation, &Motion::rotation, &Motion::reference}) {
    Motion motion;
    (motion.*member).x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_STREQ(motion.why_invalid(), "the motion is not finite");
  }
}

}  // namespace
}  // namespace sixdof
