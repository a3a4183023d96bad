#include <sixdof/proximity/cross_axes.h>

#include <gtest/gtest.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "../geometry/shapes.h"

namespace sixdof::detail {
namespace {

constexpr double k_float_rounding = 1e-6;  // of unit vectors in floats

using Eigen::Vector3d;

Vector3d vector_of(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

TEST(CrossAxes, AreAcrossAnAxisOfEachFrame) {
  shapes::Generator generator(3);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Eigen::Matrix3d R = shapes::random_pose(generator, 0.0).R;
    const CrossAxes axes(R);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const Vector3d in_a = vector_of(axes.in_a[3 * i + j]);
        EXPECT_NEAR(in_a.norm(), 1.0, k_float_rounding);
        EXPECT_NEAR(in_a[i], 0.0, k_float_rounding);
        EXPECT_NEAR(in_a.dot(R.col(j)), 0.0, k_float_rounding);
        EXPECT_NEAR((R * vector_of(axes.in_b[3 * i + j]) - in_a).norm(), 0.0, k_float_rounding);
      }
    }
  }
}

TEST(CrossAxes, AreZeroWhereAxesAreParallel) {
  const CrossAxes axes(Eigen::AngleAxisd(1e-4, Vector3d::UnitZ()).toRotationMatrix());
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(vector_of(axes.in_a[3 * i + j]).norm(), i == j ? 0.0 : 1.0, k_float_rounding) << i << j;
      EXPECT_NEAR(vector_of(axes.in_b[3 * i + j]).norm(), i == j ? 0.0 : 1.0, k_float_rounding) << i << j;
    }
  }
}

TEST(CrossAxesUse, AsksFewOrAllAsLongAsTheyTellEnoughApart) {
  const auto asked = [](CrossAxesUse use, int left, int pairs) {
    int count = 0;
    for (int i = 0; i < pairs; ++i) {
      if (!use.is_due()) continue;
      ++count;
      use.count(8, left);
    }
    return count;
  };
  EXPECT_EQ(asked(CrossAxesUse(0.125), 8, 16), 2);
  EXPECT_LT(asked(CrossAxesUse(0.125), 8, 1600), 80) << "none is apart";
  EXPECT_EQ(asked(CrossAxesUse(0.125), 6, 1600), 1593) << "two of eight: all from the first on, the eighth";
  EXPECT_LT(asked(CrossAxesUse(0.5), 6, 1600), 80) << "two of eight, worth it above one of two";
}

}  // namespace
}  // namespace sixdof::detail
