#pragma once

#include <cmath>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>

namespace sixdof::detail {

/// Rounding of a fraction of a displacement, a quotient of differences.
inline constexpr float k_fraction_rounding = 2e-6f;
/// Intervals of fractions are not longer than from here to there.
inline constexpr float k_first_fraction = -1.0f, k_last_fraction = 2.0f;

/// The motion of B in the frames of the trees: p_A - center_A = rotation (p_B - center_B) + shift + x displacement.
struct TreeMotion {
  /// Of a coordinate, per fraction of the displacement. Where it is below the slack it is taken to be the slack, and
  /// the coordinate to be known up to `pad`.
  struct Speed {
    float inverse;
    float pad;

    Speed() = default;
    Speed(float speed, float slack)
        : inverse(1.0f / (std::abs(speed) > slack ? speed : slack)), pad(std::abs(speed) > slack ? 0.0f : slack) {}
  };

  float rotation[3][3];
  float shift[3];
  float displacement[3];
  float slack;                 ///< Largest error of a transformed coordinate.
  float middle[3];             ///< shift + displacement / 2
  float half_displacement[3];  ///< displacement / 2
  Speed along_a[3];            ///< Of B along A's axes,
  Speed along_b[3];            ///< and of A along B's: the negative displacement in B's frame.

  TreeMotion(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement_A) {
    const Eigen::Vector3d d = X_AB.R * b.center() + X_AB.t - a.center();
    // A coordinate is the sum of seven products and sums of lengths of this size, each rounded by 6e-8.
    constexpr double k_float_rounding = 6e-7;
    // Rounding of the doubles, which matters where the bodies are far from their origins.
    constexpr double k_double_rounding = 1e-14;
    const double size =
        a.radius() + b.radius() + d.lpNorm<Eigen::Infinity>() + displacement_A.lpNorm<Eigen::Infinity>();
    slack =
        static_cast<float>(k_float_rounding * size +
                           k_double_rounding * (X_AB.t.lpNorm<1>() + b.center().lpNorm<1>() + a.center().lpNorm<1>()));
    const Eigen::Vector3d displacement_B = X_AB.R.transpose() * displacement_A;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) rotation[i][k] = static_cast<float>(X_AB.R(i, k));
      shift[i] = static_cast<float>(d[i]);
      displacement[i] = static_cast<float>(displacement_A[i]);
      half_displacement[i] = 0.5f * displacement[i];
      middle[i] = static_cast<float>(d[i] + 0.5 * displacement_A[i]);
      along_a[i] = Speed(displacement[i], slack);
      along_b[i] = Speed(static_cast<float>(-displacement_B[i]), slack);
    }
  }
};

}  // namespace sixdof::detail
