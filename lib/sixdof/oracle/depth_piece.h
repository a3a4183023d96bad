#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/oracle/depth_integral.h>
#include <sixdof/oracle/signed_depth.h>

/// Integrals of the law of depth over one triangle. Internal: outside of the library use depth_integral.h.
namespace sixdof::detail {

/// Sums of an integral; torques about the origin of the nodes' relative positions.
struct DepthSums {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  double depth = 0.0;  ///< Integral of the depth.
  double area = 0.0;   ///< Inside A.

  DepthSums& operator+=(const DepthSums& x) {
    force += x.force;
    torque += x.torque;
    depth += x.depth;
    area += x.area;
    return *this;
  }
  /// this + factor * x
  DepthSums plus(const DepthSums& x, double factor) const {
    return {force + factor * x.force, torque + factor * x.torque, depth + factor * x.depth, area + factor * x.area};
  }
};

/// The integrand at a node.
struct DepthValue {
  Eigen::Vector3d r;  ///< Position relative to the torque's reference.
  Eigen::Vector3d f;  ///< Depth times direction; continued linearly to the outside of A.
  double s;           ///< Signed distance.
};

/// How a node's value follows from it.
struct DepthLaw {
  DepthDirection direction;
  Eigen::Vector3d reference;  ///< Of torques, in A's frame.

  /// @param normal outward unit normal of B's triangle
  DepthValue at(const DepthNode& node, const Eigen::Vector3d& normal) const {
    // Outside, the nearest point is on the other side and the force on the way to it is negative: linear throughout.
    const Eigen::Vector3d f =
        direction == DepthDirection::normal_of_b ? Eigen::Vector3d(node.s * normal) : node.to_surface;
    return {node.p - reference, f, node.s};
  }
};

/// The part of a triangle where the signed distance, taken as linear between the corners, is negative; the integrand is
/// linear, too.
DepthSums integrate_linear(const std::array<DepthValue, 3>& corners, double area);

/// A triangle with its nodes: corners 0, 1, 2, then the midpoints of the sides 01, 12, 20.
struct DepthPiece {
  std::array<std::uint32_t, 6> node{};
  std::uint32_t triangle = 0;  ///< Of B's mesh, on which the piece lies.
  double longest = 0.0;        ///< Side (length).
  DepthSums sums = {};
  double force_error = 0.0;
  double torque_error = 0.0;
  bool outside = false;  ///< No point of it is inside A.
};

/// Sums and estimates of a piece from its six nodes.
/// @param area of the piece, @param normal as in DepthLaw::at()
void integrate_piece(DepthPiece& piece, const std::array<const DepthNode*, 6>& nodes, const DepthLaw& law, double area,
                     const Eigen::Vector3d& normal);

/// No point of a triangle is farther than this times its longest side from all three corners.
inline constexpr double k_reach_of_corners = 0.57735026918962584;  // rounded up from 1 / sqrt(3)

}  // namespace sixdof::detail
