// Short free translations against closed forms.

#include <sixdof/oracle/free_translation.h>

#include <algorithm>
#include <array>
#include <numbers>

#include <gtest/gtest.h>

#include "bodies.h"

namespace sixdof::detail {
namespace {

using bodies::box;
using bodies::moved;
using Eigen::Vector3d;

TEST(ShortestBeyond, OnePlaneTwoPlanesAndThree) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  EXPECT_TRUE(shortest_beyond({})->isZero(0.0));
  EXPECT_TRUE(shortest_beyond(std::array{ContactPlane{x, 0.3}})->isApprox(0.3 * x, 1e-14));
  EXPECT_TRUE(
      shortest_beyond(std::array{ContactPlane{x, 0.3}, ContactPlane{y, -0.1}})->isApprox(Vector3d(0.3, 0, 0), 1e-14));
  EXPECT_TRUE(
      shortest_beyond(std::array{ContactPlane{x, 0.3}, ContactPlane{y, 0.1}})->isApprox(Vector3d(0.3, 0.1, 0), 1e-14));
  EXPECT_TRUE(shortest_beyond(std::array{ContactPlane{x, 0.3}, ContactPlane{y, 0.1}, ContactPlane{z, 0.2}})
                  ->isApprox(Vector3d(0.3, 0.1, 0.2), 1e-14));
  EXPECT_FALSE(shortest_beyond(std::array{ContactPlane{x, 0.3}, ContactPlane{-x, 0.1}}));
}

TEST(ShortestBeyond, IsNearestAmongRandomPlanes) {
  std::mt19937_64 random(41);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    std::vector<ContactPlane> planes;
    for (int k = 0; k < 6; ++k) {
      const Vector3d n = Vector3d(uniform(random), uniform(random), uniform(random) + 1.2).normalized();
      planes.push_back({n, uniform(random)});
    }
    const std::optional<Vector3d> x = shortest_beyond(planes);
    ASSERT_TRUE(x);
    const auto is_beyond = [&](const Vector3d& p, double slack) {
      return std::ranges::all_of(planes, [&](const ContactPlane& q) { return q.normal.dot(p) >= q.offset - slack; });
    };
    EXPECT_TRUE(is_beyond(*x, 1e-11));
    // The set is convex, so a shorter point would be found near by.
    for (int k = 0; k < 200; ++k) {
      const Vector3d near = *x + 1e-3 * Vector3d(uniform(random), uniform(random), uniform(random));
      EXPECT_TRUE(!is_beyond(near, 0.0) || near.norm() >= x->norm() * (1.0 - 1e-9));
    }
  }
}

class Boxes : public ::testing::Test {
 protected:
  std::mt19937_64 random{42};
  Pose X_WA = bodies::random_pose(random, 0.7);
  Mesh a = moved(box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}), X_WA);
  Mesh b = box({-0.2, -0.3, -0.4}, {0.2, 0.3, 0.4});
  Pose X_AB = X_WA * Pose{Eigen::Matrix3d::Identity(), {0.6, 0.21, -0.1}};  // depth 0.1 along x
  DistanceOracle oracle{a, b};
  FreeTranslations translations{oracle};
};

TEST_F(Boxes, ApproachEndsAtTheContact) {
  const FreeTranslations::Stop stop = translations.approach(X_AB, X_WA.R.col(0));
  EXPECT_TRUE(stop.blocked);
  EXPECT_NEAR(stop.d.norm(), 0.1, 1e-8);  // some 1e-10 of a way of 2
  EXPECT_TRUE(translations.is_free(X_AB, stop.d));
  EXPECT_NEAR(stop.normal.dot(X_WA.R.col(0)), 1.0, 1e-6);
}

TEST_F(Boxes, DescentsEndAtTheDepth) {
  for (const Vector3d& u : {Vector3d(1.0, 0.4, -0.3), Vector3d(1.0, -0.5, 0.2), Vector3d(1.0, 0.1, 0.6)}) {
    const Vector3d start = translations.approach(X_AB, X_WA.R * u.normalized()).d;
    const Vector3d end = translations.descend(X_AB, start);
    EXPECT_GT(start.norm(), 0.105);
    EXPECT_NEAR(end.norm(), 0.1, 1e-9) << u.transpose();
    EXPECT_TRUE(translations.is_free(X_AB, end));
  }
}

TEST_F(Boxes, CrossingIsOnBothSurfaces) {
  const std::optional<Vector3d> p = translations.crossing(X_AB, Vector3d::Zero());
  ASSERT_TRUE(p);
  const Vector3d q = X_WA.inverse() * *p;
  EXPECT_TRUE(Eigen::AlignedBox3d(Vector3d(-0.5, -0.4, -0.3), Vector3d(0.5, 0.4, 0.3)).exteriorDistance(q) < 1e-12);
  EXPECT_FALSE(translations.crossing(X_AB, 0.2 * X_WA.R.col(0)));
}

}  // namespace
}  // namespace sixdof::detail
