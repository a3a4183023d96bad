#pragma once

#include <cmath>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/proximity/frames.h>

namespace sixdof::detail {

/// Rounding of a fraction of a displacement, a quotient of differences.
inline constexpr float k_fraction_rounding = 2e-6f;
/// Intervals of fractions are not longer than from here to there.
inline constexpr float k_first_fraction = -1.0f, k_last_fraction = 2.0f;

/// Speed of a coordinate, per fraction of a displacement. Where it is below the slack it is taken to be the slack, and
/// the coordinate to be known up to `pad`.
struct Speed {
  float inverse;
  float pad;

  Speed() = default;
  Speed(float speed, float slack)
      : inverse(1.0f / (std::abs(speed) > slack ? speed : slack)), pad(std::abs(speed) > slack ? 0.0f : slack) {}
};

/// How one tree passes the other: a displacement of y in the frames of x and of y.
struct Passage {
  float in_x[3], in_y[3];
  float half_in_x[3];
  Speed along_x[3], along_y[3];

  Passage(const Eigen::Vector3d& displacement_x, const Eigen::Vector3d& displacement_y, float slack) {
    for (int k = 0; k < 3; ++k) {
      in_x[k] = static_cast<float>(displacement_x[k]);
      in_y[k] = static_cast<float>(displacement_y[k]);
      half_in_x[k] = 0.5f * in_x[k];
      along_x[k] = Speed(in_x[k], slack);
      along_y[k] = Speed(in_y[k], slack);
    }
  }
};

/// A pose and a displacement of B between the frames of both trees.
struct TreeMotion {
  float rounding;  ///< Largest error of a transformed coordinate.
  float margin;    ///< How far points of B may be from where the pose takes them, in any direction.
  Frames frames;   ///< B at the displacement's middle.
  float start[3];  ///< From A's centre to B's, before the displacement.
  Passage of_b;    ///< Of B, x = A,
  Passage of_a;    ///< and of A past B, x = B.

  /// @param distance_of_points the margin (length)
  TreeMotion(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
             double distance_of_points = 0.0)
      : rounding(rounding_of(a, b, X_AB, displacement)),
        margin(static_cast<float>((1.0 + 1e-6) * distance_of_points)),
        frames(X_AB.R),
        of_b(displacement, X_AB.R.transpose() * displacement, rounding),
        of_a(-(X_AB.R.transpose() * displacement), -displacement, rounding) {
    const Eigen::Vector3d shift = shift_of(a, b, X_AB);
    frames.set_shift(shift + 0.5 * displacement);
    for (int k = 0; k < 3; ++k) start[k] = static_cast<float>(shift[k]);
  }

  /// By how much a coordinate along any axis may be off, if it is rounded like `times` transformed ones.
  float slack(float times = 1.0f) const { return times * rounding + margin; }

 private:
  static Eigen::Vector3d shift_of(const Tree& a, const Tree& b, const Pose& X_AB) {
    return X_AB.R * b.center() + X_AB.t - a.center();
  }
  static float rounding_of(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement) {
    // A coordinate is the sum of seven products and sums of lengths of this size, each rounded by 6e-8.
    constexpr double k_float_rounding = 6e-7;
    // Rounding of the doubles, which matters where the bodies are far from their origins.
    constexpr double k_double_rounding = 1e-14;
    const double size = a.radius() + b.radius() + shift_of(a, b, X_AB).lpNorm<Eigen::Infinity>() +
                        displacement.lpNorm<Eigen::Infinity>();
    return static_cast<float>(k_float_rounding * size +
                              k_double_rounding *
                                  (X_AB.t.lpNorm<1>() + b.center().lpNorm<1>() + a.center().lpNorm<1>()));
  }
};

}  // namespace sixdof::detail
