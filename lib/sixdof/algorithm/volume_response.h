#pragma once

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// The response of the volume law from the boundary of an intersection, for algorithms that get that boundary from a
/// library: what `exact` computes (oracle/overlap.h), by the divergence theorem.
class VolumeResponse {
 public:
  /// @param reference of the torque, in A's frame
  explicit VolumeResponse(const Eigen::Vector3d& reference) { response_.reference = reference; }

  /// Adds a triangle of the boundary, counter-clockwise seen from outside the intersection, in A's frame.
  /// @param of_b whether it lies on B's surface
  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r, bool of_b) {
    const Eigen::Vector3d origin = response_.reference;
    const Eigen::Vector3d area = 0.5 * (q - p).cross(r - p);
    response_.penalty += (p - origin).dot(area) / 3.0;
    if (!of_b) return;
    response_.force -= area;
    response_.torque -= ((p + q + r) / 3.0 - origin).cross(area);
  }

  /// Volume as penalty; force and torque are minus its gradients with respect to a translation and a rotation of B.
  Response response() const {
    Response response = response_;
    response.volume = response.penalty;
    return response;
  }

 private:
  Response response_;
};

}  // namespace sixdof
