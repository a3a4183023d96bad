#pragma once

#include <Eigen/Core>

/// A pose as the searches of two trees take it, in floats. Internal.
namespace sixdof::detail {

/// The pose of one tree, whose frame is F, in the frame N of the other. Origins are the trees' centres.
struct Frame {
  float axis[3][3];      ///< F's axes in N: p_N = sum of axis[k] p_F[k] + translation
  float translation[3];  ///< From N's origin to F's.
  float direction[3];    ///< Frames::set_direction(): w or -w, in N, towards the body of F.
};

/// A pose between the frames of both trees.
struct Frames {
  Frame a, b;              ///< N = A, and N = B.
  Eigen::Matrix3d R;       ///< From B's axes to A's.
  Eigen::Vector3d shift;   ///< From A's centre to B's, in A's frame.
  double shift_along = 0;  ///< shift . w

  explicit Frames(const Eigen::Matrix3d& R_AB) : R(R_AB) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        a.axis[k][i] = static_cast<float>(R(i, k));
        b.axis[k][i] = static_cast<float>(R(k, i));
      }
    }
  }

  void set_shift(const Eigen::Vector3d& from_a_to_b) {
    shift = from_a_to_b;
    const Eigen::Vector3d back = -(R.transpose() * shift);
    for (int i = 0; i < 3; ++i) {
      a.translation[i] = static_cast<float>(shift[i]);
      b.translation[i] = static_cast<float>(back[i]);
    }
  }

  /// Sets w, after the shift.
  /// @param from_a_to_b in A's frame, of a length of at most 1
  void set_direction(const Eigen::Vector3d& from_a_to_b) {
    const Eigen::Vector3d from_b_to_a = -(R.transpose() * from_a_to_b);
    for (int i = 0; i < 3; ++i) {
      a.direction[i] = static_cast<float>(from_a_to_b[i]);
      b.direction[i] = static_cast<float>(from_b_to_a[i]);
    }
    shift_along = from_a_to_b.dot(shift);
  }
};

}  // namespace sixdof::detail
