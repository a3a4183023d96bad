#include <sixdof/geometry/typed_pose.h>

#include <random>
#include <sstream>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

TEST(TypedPose, ItsTextGivesTheSameBits) {
  std::mt19937_64 random(20261126);
  std::normal_distribution<double> normal;
  constexpr double k_rounding = 1e-15;  // of a rotation's entries
  for (int i = 0; i < 100; ++i) {
    const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
    const Pose X{q.normalized().toRotationMatrix(), {normal(random), 1e-9 * normal(random), 1e6 * normal(random)}};
    const TypedPose typed = TypedPose::of(X);
    std::istringstream text(typed.text());
    double tx, ty, tz, w, x, y, z;
    ASSERT_TRUE(text >> tx >> ty >> tz >> w >> x >> y >> z);
    const Pose again = Pose::from_quaternion(w, x, y, z, {tx, ty, tz});
    EXPECT_EQ(again.R, typed.X_AB.R);
    EXPECT_EQ(again.t, X.t);
    EXPECT_LE((typed.X_AB.R - X.R).norm(), 8.0 * k_rounding);
  }
}

}  // namespace
}  // namespace sixdof
