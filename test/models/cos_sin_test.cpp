#include <sixdof/models/cos_sin.h>

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

constexpr double k_underflow = 1e-19;  // of 2 pi times 1e-20

// One unit in the last place of a number below 1, doubled for the rounding of the angle itself.
constexpr double k_two_ulp = 2.3e-16;

TEST(CosSin, AgreesWithLongDoubleToTheLastPlace) {
  std::mt19937_64 random(20100731);
  std::uniform_real_distribution<double> revolutions(-3.0, 3.0);
  for (int i = 0; i < 20000; ++i) {
    const double t = revolutions(random);
    const long double angle = 2.0L * std::numbers::pi_v<long double> * t;
    const Eigen::Vector2d u = cos_sin(t);
    EXPECT_NEAR(u.x(), static_cast<double>(std::cos(angle)), k_two_ulp) << t;
    EXPECT_NEAR(u.y(), static_cast<double>(std::sin(angle)), k_two_ulp) << t;
  }
}

TEST(CosSin, IsExactAtQuartersAndSymmetricOnPolygons) {
  EXPECT_EQ(cos_sin(0.25), Eigen::Vector2d(0.0, 1.0));
  EXPECT_EQ(cos_sin(-0.5), Eigen::Vector2d(-1.0, 0.0));
  EXPECT_EQ(cos_sin(7, 4), Eigen::Vector2d(0.0, -1.0));
  for (std::uint64_t n : {5U, 12U, 97U, 1000U}) {
    for (std::uint64_t i = 0; i < n; ++i) {
      const Eigen::Vector2d u = cos_sin(i, n);
      const Eigen::Vector2d mirrored = cos_sin(n - i, n);
      EXPECT_EQ(u.x(), mirrored.x()) << i << "/" << n;
      EXPECT_EQ(u.y(), -mirrored.y()) << i << "/" << n;
      const long double angle = 2.0L * std::numbers::pi_v<long double> * i / n;
      EXPECT_NEAR(u.x(), static_cast<double>(std::cos(angle)), k_two_ulp);
      EXPECT_NEAR(u.y(), static_cast<double>(std::sin(angle)), k_two_ulp);
    }
  }
}

TEST(CosSin, IsContinuousAtWholeRevolutions) {
  EXPECT_NEAR(cos_sin(-1e-20).y(), 0.0, k_underflow);
  EXPECT_EQ(cos_sin(-1e-20).x(), 1.0);
  EXPECT_EQ(cos_sin(std::nextafter(1.0, 0.0)).x(), 1.0);
}

}  // namespace
}  // namespace sixdof
