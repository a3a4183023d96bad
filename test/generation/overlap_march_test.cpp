#include <sixdof/generation/overlap_march.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

constexpr double k_two_steps = 2e-5;         // two steps of the search for the expected crossing
constexpr double k_volume_tolerance = 1e-9;  // of a volume at the translation found

/// A function of the translation in place of an overlap. Slopes within -2 .. 4.
struct Wave {
  double amplitude = 1.0;
  int calls = 0;
  OverlapMeasurement operator()(double s, double front = 5.0) {
    EXPECT_LT(s, front);
    ++calls;
    const double x = 4.0 - s;
    return {.s = s,
            .volume = amplitude * (x - std::sin(3.0 * x)),
            .slope = amplitude * (1.0 - 3.0 * std::cos(3.0 * x)),
            .curvature = amplitude * 9.0 * std::sin(3.0 * x)};
  }
};

/// Bounds that are the same everywhere.
OverlapMarch::Peak within(double rise, double fall) {
  return [=](const OverlapMeasurement& outer, const OverlapMeasurement& inner, double) {
    return volume_peak(outer, inner, std::array{SlopeRange{.low = -fall, .high = rise}});
  };
}

TEST(OverlapMarch, TakesTheFirstOfSeveralCrossings) {
  constexpr double k_resolution = 1e-3, k_tolerance = 1e-9;
  for (int i = 1; i < 40; ++i) {
    const double target = 0.05 * i;
    Wave wave;
    OverlapMarch march(std::ref(wave), within(4.0, 2.0), 4.0,
                       {.resolution = k_resolution, .tolerance = k_tolerance, .first_step = 0.1});
    // The first upward crossing, by steps far below the resolution.
    double expected = 4.0;
    while (Wave{}(expected).volume < target) expected -= 1e-5;
    const std::optional<OverlapMeasurement> hit = march.advance(target);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->volume, target, k_tolerance);
    EXPECT_NEAR(hit->s, expected, k_two_steps) << target;
  }
}

TEST(OverlapMarch, TheCurvatureSparesMeasurements) {
  // A cubic is met where its curvature predicts it; without, the first prediction after contact is off.
  const auto measurements = [](double curvature) {
    int calls = 0;
    const auto cubic = [&](double s, double) {
      ++calls;
      const double x = 4.0 - s;
      return OverlapMeasurement{.s = s,
                                .volume = x * x * (1.0 + 0.3 * x),
                                .slope = x * (2.0 + 0.9 * x),
                                .curvature = curvature * (2.0 + 1.8 * x)};
    };
    OverlapMarch march(cubic, within(20.0, 0.0), 4.0, {.resolution = 1e-3, .tolerance = 1e-9, .first_step = 0.1});
    for (int i = 1; i <= 10; ++i) {
      const std::optional<OverlapMeasurement> hit = march.advance(0.5 * i);
      EXPECT_NEAR(hit.value().volume, 0.5 * i, k_volume_tolerance);
    }
    return calls;
  };
  const int with = measurements(1.0), without = measurements(0.0), wrong = measurements(-30.0);
  EXPECT_LE(with, 15);       // 13
  EXPECT_GT(without, with);  // 29
  EXPECT_LT(wrong, 60);      // 32: a wrong curvature costs measurements, no answer
}

TEST(OverlapMarch, FindsABumpThatItsStepsWouldPassOver) {
  // Linear growth with a bump of width 0.2: the target is met within the bump, and without it farther inwards.
  constexpr double k_width = 0.1, k_bump = 0.8, k_target = 1.5, k_tolerance = 1e-9;
  for (int i = 0; i < 12; ++i) {
    const double center = 0.85 + 0.04 * i;
    const auto bump = [&](double s, double) {
      const double x = 4.0 - s;
      const double y = std::clamp((x - center) / k_width, -1.0, 1.0);
      const double rest = 1.0 - y * y;
      return OverlapMeasurement{
          .s = s, .volume = x + k_bump * rest * rest, .slope = 1.0 - 4.0 * k_bump * y * rest / k_width};
    };
    // The steepest slope of the bump is at y = 1 / sqrt(3).
    const double steepest = k_bump * 8.0 / (3.0 * std::sqrt(3.0)) / k_width;
    OverlapMarch march(bump, within(steepest + 1.0, steepest - 1.0), 4.0,
                       {.resolution = 1e-3, .tolerance = k_tolerance, .first_step = 0.1});
    const std::optional<OverlapMeasurement> hit = march.advance(k_target);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->volume, k_target, k_tolerance);
    EXPECT_NEAR(4.0 - hit->s, center, k_width) << "the crossing behind the bump";
    EXPECT_LT(4.0 - hit->s, center) << "the falling side of the bump";
  }
}

TEST(OverlapMarch, EndsAtTheCentre) {
  Wave wave{.amplitude = 0.1};
  OverlapMarch march(std::ref(wave), within(0.4, 0.2), 4.0, {.resolution = 1e-3, .tolerance = 1e-9, .first_step = 0.1});
  EXPECT_TRUE(march.advance(0.3));
  EXPECT_FALSE(march.advance(0.9));
  EXPECT_FALSE(march.advance(1.1));
}

TEST(OverlapMarch, RefusesAFunctionThatJumps) {
  OverlapMarch march([](double s, double) { return OverlapMeasurement{.s = s, .volume = s < 1.0 / 3.0 ? 1.0 : 0.0}; },
                     within(1.0, 0.0), 4.0, {.resolution = 1e-3, .tolerance = 1e-9, .first_step = 0.1});
  EXPECT_THROW(march.advance(0.5), Error);
}

}  // namespace
}  // namespace sixdof
