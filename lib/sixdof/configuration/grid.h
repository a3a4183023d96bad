#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

/// The grid of a set: directions from A to B, times rotations of B.

namespace sixdof {

/// Number of buckets in the paper: distances of 0..30 % of the diagonal of A's box, volumes of 0..10 % of A's volume.
constexpr std::size_t k_paper_distance_buckets = 31;
constexpr std::size_t k_paper_volume_buckets = 11;  ///< The same for volumes.

/// A grid of directions and rotations, with its description.
struct Grid {
  std::string spec;     ///< The canonical spelling of make_grid()'s argument: "paper", "45", "15/30", "so3:1000:68".
  std::string sampler;  ///< "zyz-euler" or "super-fibonacci".
  double direction_step_degrees = 0.0;  ///< 0 for samplers without a step.
  double rotation_step_degrees = 0.0;   ///< 0 for samplers without a step.
  /// Unit vectors in A's frame, pointing from the centre of A's box to that of B's.
  std::vector<Eigen::Vector3d> directions;
  /// Unit quaternions (w, x, y, z) of R_AB. The first component that is not zero is positive, so that equal rotations
  /// have equal bits.
  std::vector<Eigen::Vector4d> rotations;

  /// Directions times rotations.
  std::size_t configurations() const { return directions.size() * rotations.size(); }
};

/// Makes a grid from its description:
/// - `paper`: the paper's grid for distances, directions and Euler angles every 15 degrees: 266 x 7,488 = 1,991,808;
/// - `paper-volume`: the paper's grid for volumes, rotations every 30 degrees: 266 x 1,008 = 268,128;
/// - `D` or `D/R`: directions every D and Euler angles every R degrees (R = D if absent), each dividing 180;
/// - `so3:N` or `so3:N:M`: N uniform rotations and M uniform directions. Without M, the number of directions with the
///   angular spacing of the rotations.
/// @throws BadArgument for anything else, and for more than k_max_grid_size directions or rotations.
Grid make_grid(std::string_view spec);

/// Greatest number of directions or rotations. A larger set would have terabytes per bucket.
constexpr std::size_t k_max_grid_size = 20'000'000;

/// Which rotations of a list have the same bits. Each distinct rotation is solved once and copied to its repeats.
struct DistinctRotations {
  std::vector<std::uint32_t> first;           ///< First index in the list of each distinct rotation, ascending.
  std::vector<std::uint32_t> representative;  ///< For each rotation of the list, the first index of an equal one.

  /// Of a list of unit quaternions; only equal bits count as equal.
  explicit DistinctRotations(std::span<const Eigen::Vector4d> rotations);

  /// Copies the row of every distinct rotation to its repeats.
  /// @param values [rotation of the list][row_size]
  void copy_to_repeats(std::span<double> values, std::size_t row_size) const;
};

/// The poses of the sphere method for one rotation. B is rotated by R, and the centre of B's box is at distance s from
/// the centre of A's box in direction u: t = (c_A + s u) - R c_B. All poses of configurations are computed here, so
/// that they have the same bits everywhere.
struct ConfigurationRay {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();             ///< R_AB
  Eigen::Vector3d center_a = Eigen::Vector3d::Zero();          ///< c_A in A's frame.
  Eigen::Vector3d rotated_center_b = Eigen::Vector3d::Zero();  ///< R c_B, in A's axes.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();         ///< u, unit vector in A's frame.

  /// The identity, without a direction.
  ConfigurationRay() = default;
  /// Of one rotation. @param rotation (w, x, y, z); @param along the direction
  ConfigurationRay(const Mesh& a, const Mesh& b, const Eigen::Vector4d& rotation,
                   const Eigen::Vector3d& along = Eigen::Vector3d::Zero());

  /// X_AB at a translation. @param s translation along u, in the meshes' length unit
  Pose pose(double s) const { return {R, (center_a + s * direction) - rotated_center_b}; }
};

}  // namespace sixdof
