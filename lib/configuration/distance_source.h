#pragma once

#include <memory>
#include <string>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

namespace sixdof {

/// The smallest distance of two surfaces, in the meshes' length unit; 0 where they touch or intersect.
struct ProbedDistance {
  double distance = 0.0;
  bool has_witnesses = false;  ///< Whether on_a and on_b are set; never needed, but it saves measurements.
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero();  ///< Closest point on A, in A's frame.
  Eigen::Vector3d on_b = Eigen::Vector3d::Zero();  ///< Closest point on B, in A's frame.
};

/// An exact measurement of distances, prepared for one pair. One thread at a time. What it answers depends on the pose
/// alone, to the last bit, not on the poses before.
class DistanceProbe {
 public:
  virtual ~DistanceProbe() = default;
  /// @throws Error if the distance cannot be measured
  virtual ProbedDistance measure(const Pose& X_AB) = 0;
};

/// What defines the distances of a configuration set.
class DistanceSource {
 public:
  virtual ~DistanceSource() = default;
  virtual const std::string& name() const = 0;
  virtual const std::string& version() const = 0;
  /// May be called from several threads. Both meshes outlive the probe. @throws BadMesh
  virtual std::unique_ptr<DistanceProbe> prepare(const Mesh& a, const Mesh& b) const = 0;
};

}  // namespace sixdof
