#pragma once

#include <vector>

#include <sixdof/geometry/tree.h>

namespace sixdof::vps {

/// Approximate winding number of a mesh's surface around a point: 1 inside a body, 0 outside, 2 where two bodies of one
/// mesh overlap.
///
/// The sum of the triangles' solid angles. Nodes of the tree farther away than k_far_ratio of their radii are
/// approximated by one dipole (Barill et al., Fast winding numbers for soups and clouds, 2018), with a total error of a
/// few hundredths. Any number of threads may use it at once. The tree outlives it. 56 bytes per node of the tree.
class WindingNumber {
 public:
  explicit WindingNumber(const Tree& tree);

  /// @param p in the mesh's frame
  double at(const Eigen::Vector3d& p) const;

 private:
  static constexpr double k_far_ratio = 3.0;

  /// Far-field approximation of a node's triangles.
  struct Dipole {
    Eigen::Vector3d area_vector = Eigen::Vector3d::Zero();  ///< Sum of the triangles' area vectors.
    Eigen::Vector3d center = Eigen::Vector3d::Zero();       ///< Area-weighted.
    double radius = 0.0;                                    ///< Farthest corner from `center`.
  };

  const Tree* tree_;
  std::vector<Dipole> dipoles_;  ///< Per node of the tree.
};

}  // namespace sixdof::vps
