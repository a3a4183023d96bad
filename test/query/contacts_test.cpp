#include <sixdof/query/contacts.h>

#include <gtest/gtest.h>

#include "../geometry/shapes.h"

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-14;  // of lengths of about 1

TEST(Contacts, InAnotherFrameAndBack) {
  shapes::Generator random(4);
  const Pose X = shapes::random_pose(random, 2.0);
  const Contacts contacts{{{{0.3, -1.1, 0.7}, {0.6, 0.0, -0.8}, 0.02}}};
  const Contact there = moved(contacts, X).list.at(0);
  EXPECT_EQ(there.point, X * contacts.list[0].point);
  EXPECT_EQ(there.depth, 0.02);
  const Contact back = moved(moved(contacts, X), X.inverse()).list.at(0);
  EXPECT_NEAR((back.point - contacts.list[0].point).norm(), 0.0, k_rounding);
  EXPECT_NEAR((back.normal - contacts.list[0].normal).norm(), 0.0, k_rounding);
}

TEST(Contacts, ExchangedNormalsLeadTheOtherWay) {
  shapes::Generator random(6);
  const Pose X_AB = shapes::random_pose(random, 2.0);
  const Eigen::Vector3d point(0.3, -1.1, 0.7), normal(0.6, 0.0, -0.8);  // in A's frame, from A to B
  const Pose X_BA = X_AB.inverse();
  const Contacts of_b_and_a{{{X_BA * point, -(X_BA.R * normal), 0.02}}};
  const Contact contact = exchanged(of_b_and_a, X_AB).list.at(0);
  EXPECT_NEAR((contact.point - point).norm(), 0.0, k_rounding);
  EXPECT_NEAR((contact.normal - normal).norm(), 0.0, k_rounding);
}

TEST(Contacts, MeanNormal) {
  const Eigen::Vector3d x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0);
  EXPECT_TRUE(mean_normal({}).isZero(0.0));
  EXPECT_NEAR((mean_normal({{{x, x, 0.0}, {y, y, 0.0}}}) - (x + y).normalized()).norm(), 0.0, k_rounding);
  EXPECT_TRUE(mean_normal({{{x, x, 0.0}, {y, -x, 0.0}}}).isZero(0.0)) << "they cancel";
}

}  // namespace
}  // namespace sixdof
