#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Separating axes of boxes that cross. Internal: for oracle/distance_bounds-inl.h and oracle/candidates_bounds-inl.h.
namespace sixdof::detail {

/// The nine cross products of an axis of A's frame and an axis of B's, of length 1; zero where the two are nearly
/// parallel. With the axes themselves they decide whether a box aligned with A's and one aligned with B's overlap
/// (Gottschalk, Lin and Manocha, "OBBTree", 1996). Boxes are aligned with their tree's frame, so the nine are the same
/// for all pairs of boxes of a query.
struct CrossAxes {
  static constexpr std::size_t k_count = 9;
  float in_a[k_count][3];
  float in_b[k_count][3];

  explicit CrossAxes(const Eigen::Matrix3d& R_AB) {
    constexpr double k_parallel = 1e-6;  // square of the sine of the angle between two axes
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double squared = 1.0 - R_AB(i, j) * R_AB(i, j);
        const double scale = squared > k_parallel ? 1.0 / std::sqrt(squared) : 0.0;
        const Eigen::Vector3d n_A = scale * Eigen::Vector3d::Unit(i).cross(R_AB.col(j));
        const Eigen::Vector3d n_B = scale * Eigen::Vector3d(R_AB.row(i)).cross(Eigen::Vector3d::Unit(j));
        for (int k = 0; k < 3; ++k) {
          in_a[3 * i + j][k] = static_cast<float>(n_A[k]);
          in_b[3 * i + j][k] = static_cast<float>(n_B[k]);
        }
      }
    }
  }
};

/// Decides for which pairs a search tests the cross axes, which takes about as long as all other axes. They pay where
/// long volumes cross, such as strips of long triangles, and seldom elsewhere. So they are tested for a few pairs, and
/// for all pairs as long as they separate enough volumes. The decision depends on counts alone: it is the same on every
/// machine.
class CrossAxesUse {
 public:
  /// @param worth to ask pays where more than this share of the volumes tested is found apart
  explicit constexpr CrossAxesUse(double worth) : worth_(worth) {}

  /// @return whether to ask them of the next pair
  bool is_due() {
    if (++pairs_ == next_) {
      next_ += pairs_ < k_early ? k_early_period : k_period;
      return true;
    }
    return pays_;
  }
  /// @param tested volumes that the other axes left, of which `left` are left
  void count(int tested, int left) {
    tested_ += tested;
    apart_ += tested - left;
    pays_ = apart_ > worth_ * tested_;
  }

 private:
  static constexpr std::uint32_t k_early = 64, k_early_period = 8, k_period = 64;
  double worth_;
  std::uint32_t pairs_ = 0, next_ = k_early_period;
  bool pays_ = false;
  double tested_ = 0.0, apart_ = 0.0;
};

}  // namespace sixdof::detail
