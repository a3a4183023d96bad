#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Core>

#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Identifies a mesh in a set, so that the set is never used with another one.
struct MeshIdentity {
  std::string name;
  std::string hash;  ///< Mesh::hash()
  std::uint64_t triangles = 0;
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();
  double volume = 0.0;

  static MeshIdentity of(const Mesh& mesh);
  double diagonal() const { return (box_max - box_min).norm(); }
};

/// Everything that defines the configurations of a set but their translations.
struct SetDescription {
  std::string generator_version;  ///< Version of the program that made the set.
  MeshIdentity a, b;
  Grid grid;
  std::optional<Grid> volume_grid;  ///< Grid of the volume buckets, if it is not `grid`; the paper's is coarser.

  const Grid& grid_of(BucketKind kind) const { return kind == BucketKind::volume && volume_grid ? *volume_grid : grid; }
};

}  // namespace sixdof
