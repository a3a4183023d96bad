#pragma once

#include <vector>

#include <sixdof/geometry/tree.h>

namespace sixdof::vps {

/// How often a mesh's surface winds around a point: 1 inside a body, 0 outside, 2 where two bodies of one mesh overlap.
///
/// The solid angles of near triangles are exact; nodes of the tree further away than k_far_ratio of their radii count
/// as one dipole (Barill et al., Fast winding numbers for soups and clouds, 2018), which leaves an error of a few
/// hundredths. Immutable: any number of threads may ask. The tree outlives it. 56 bytes per node of the tree.
class WindingNumber {
 public:
  explicit WindingNumber(const Tree& tree);

  /// @param p in the mesh's frame
  double at(const Eigen::Vector3d& p) const;

 private:
  static constexpr double k_far_ratio = 3.0;

  /// A node's triangles as seen from far away.
  struct Dipole {
    Eigen::Vector3d area_vector = Eigen::Vector3d::Zero();  ///< Sum of the triangles' area vectors.
    Eigen::Vector3d center = Eigen::Vector3d::Zero();       ///< Area-weighted.
    double radius = 0.0;                                    ///< Farthest corner from `center`.
  };

  const Tree* tree_;
  std::vector<Dipole> dipoles_;  ///< Per node of the tree.
};

}  // namespace sixdof::vps
