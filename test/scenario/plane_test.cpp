#include <sixdof/scenario/plane.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

constexpr double k_quadrature = 1e-7;   // of an area from many strips
constexpr double k_slope_error = 1e-8;  // of a slope from a central difference

constexpr double k_pi = std::numbers::pi;
constexpr double k_rounding = 1e-13;

TEST(Lens, AgreesWithKnownAreas) {
  // Two unit discs at distance 1: 2 pi / 3 - sqrt(3) / 2.
  EXPECT_NEAR(lens_area(1.0, 1.0, 1.0), 2.0 * k_pi / 3.0 - std::sqrt(3.0) / 2.0, k_rounding);
  EXPECT_EQ(lens_area(1.0, 0.5, 1.6), 0.0);
  EXPECT_NEAR(lens_area(1.0, 0.5, 0.3), 0.25 * k_pi, k_rounding);
  EXPECT_NEAR(lens_area(0.5, 1.0, 0.3), 0.25 * k_pi, k_rounding);
  EXPECT_EQ(lens_area(0.7, 1.1, 1.3), lens_area(0.7, 1.1, 1.3));
  EXPECT_NEAR(lens_area(0.7, 1.1, 1.3), lens_area(1.1, 0.7, 1.3), k_rounding);
}

TEST(Lens, AgreesWithStrips) {
  // Width of the common part of discs at 0 and at (d, 0) along each line y = const.
  const double r1 = 0.7;
  const double r2 = 1.1;
  for (const double d : {0.45, 0.9, 1.3, 1.75}) {
    const int strips = 200000;
    double area = 0.0;
    for (int i = 0; i < strips; ++i) {
      const double y = r1 * (2.0 * (i + 0.5) / strips - 1.0);
      const double half1 = std::sqrt(r1 * r1 - y * y);
      const double half2 = std::sqrt(r2 * r2 - y * y);
      area += std::max(0.0, std::min(half1, d + half2) - std::max(-half1, d - half2)) * 2.0 * r1 / strips;
    }
    EXPECT_NEAR(lens_area(r1, r2, d), area, k_quadrature) << d;  // midpoint rule with square roots at both ends
  }
}

TEST(Lens, ChordIsTheSlopeOfTheArea) {
  const double step = 1e-5;
  for (const double d : {0.45, 0.9, 1.3, 1.75}) {
    const double slope = (lens_area(0.7, 1.1, d + step) - lens_area(0.7, 1.1, d - step)) / (2.0 * step);
    EXPECT_NEAR(lens_chord(0.7, 1.1, d), -slope, k_slope_error) << d;
  }
  EXPECT_EQ(lens_chord(0.7, 1.1, 0.3), 0.0);
  EXPECT_EQ(lens_chord(0.7, 1.1, 1.9), 0.0);
}

TEST(DiscPart, CutsAreasAndMoments) {
  EXPECT_NEAR(disc_part(2.0, -3.0).area, 4.0 * k_pi, k_rounding);
  EXPECT_NEAR(disc_part(2.0, 0.0).area, 2.0 * k_pi, k_rounding);
  EXPECT_EQ(disc_part(2.0, 2.5).area, 0.0);
  EXPECT_EQ(disc_part(2.0, 2.5).moment_x, 0.0);
  EXPECT_EQ(disc_part(2.0, -2.5).moment_x, 0.0);
  // Half disc: centroid at 4 r / (3 pi).
  EXPECT_NEAR(disc_part(2.0, 0.0).moment_x, 2.0 * k_pi * 8.0 / (3.0 * k_pi), k_rounding);
  EXPECT_NEAR(disc_part(2.0, 0.6).area + disc_part(2.0, -0.6).area, 4.0 * k_pi, k_rounding);
}

TEST(Quadrature, IsExactForChords) {
  const auto chord = [](double x) { return std::sqrt((x - 1.0) * (3.0 - x)); };
  EXPECT_NEAR(integrate_chords(chord, 1.0, 3.0), 0.5 * k_pi, k_rounding);
  EXPECT_EQ(integrate_chords(chord, 3.0, 1.0), 0.0);
  EXPECT_NEAR(integrate([](double x) { return std::pow(x, 7); }, -1.0, 2.0), 255.0 / 8.0, k_rounding * 10);
}

}  // namespace
}  // namespace sixdof
