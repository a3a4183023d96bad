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
    (of_b ? has_b_ : has_a_) = true;
    if (!of_b) return;
    response_.force -= area;
    response_.torque -= ((p + q + r) / 3.0 - origin).cross(area);
  }

  /// Volume as penalty; force and torque are minus its gradients with respect to a translation and a rotation of B.
  /// Both are exactly zero where the boundary is all A's or all B's: one body is inside the other.
  Response response() const {
    Response response = response_;
    response.volume = response.penalty;
    if (!has_a_ || !has_b_) response.force = response.torque = Eigen::Vector3d::Zero();
    return response;
  }

 private:
  Response response_;
  bool has_a_ = false, has_b_ = false;
};

}  // namespace sixdof
