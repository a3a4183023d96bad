#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

namespace sixdof::bench {

/// Successive poses of a moving body, as in a haptic loop or a simulation.
struct Motion {
  /// Poses of one motion of a row. B jumps from the end of a motion to the start of the next, so that fewer than one
  /// query in 100 follows a jump.
  static constexpr std::size_t k_poses = 128;
  /// How far B moves from one pose to the next, in diagonals of A's box. At 1 kHz and a diagonal of 0.3 m that is 30
  /// mm/s.
  static constexpr double k_step = 1e-4;

  Eigen::Vector3d axis, direction;  ///< Unit vectors, in A's frame.
  double angle;                     ///< Per step, in radians.
  double length;                    ///< Per step, of the centre of B's box.

  /// About a random axis and in a random direction: the centre of B's box moves by half of k_step, and the rotation
  /// moves no corner of the box by more than the other half.
  Motion(const Mesh& a, const Mesh& b, std::uint64_t seed);

  /// @param center of B's box, in B's frame
  Pose pose(const Pose& start, const Eigen::Vector3d& center, std::size_t step) const;
};

/// A motion of `length` poses from every start, one after the other.
std::vector<Pose> poses_of_motions(std::span<const Pose> starts, std::size_t length, const Mesh& a, const Mesh& b,
                                   std::uint64_t seed);

}  // namespace sixdof::bench
