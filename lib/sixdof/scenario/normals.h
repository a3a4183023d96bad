#pragma once

#include <Eigen/Core>

namespace sixdof {

/// Integrals of normals over an intersection: the limit of inner spheres with normal cones (IdealLaw::normals).
///
/// Every part of the intersection of A and B pushes B with its volume along (n_A - n_B) / 2. n_A is the outward normal
/// of A where A's surface is nearest, n_B likewise. Internal: use scenario.h.

/// A force on B and its torque, in length^3 and length^4.
struct NormalsWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
};

/// Of one pin in its hole: torque about the middle of the pin, in the frame of the hole.
///
/// The nearest face of the block is the hole's wall, or within that distance of them its top and bottom, whose pushes
/// cancel. The pin has an end only at the bottom: there it pushes upwards. A vertical line at distances d_A from the
/// hole's wall and d_B from the pin's carries (length - 2 d_A) n_A - (length - d_B) n_B, halved, and d_B / 2 upwards.
/// @param side of pin and hole; @param angle rotation of the pin, radians; @param shift of the pin's axis from the
/// hole's
NormalsWrench square_pin_normals(double side, double length, double angle, const Eigen::Vector2d& shift);

/// The same for a round pin of radius r in a round hole of radius r.
NormalsWrench round_pin_normals(double r, double length, const Eigen::Vector2d& shift);

/// Moments of an intersection about a reference point.
struct OverlapMoments {
  double volume = 0.0;                              ///< length^3
  Eigen::Vector3d first = Eigen::Vector3d::Zero();  ///< Integral of the position (length^4).
  double second = 0.0;                              ///< Integral of the squared distance (length^5).

  /// The same of an intersection that is farther from the reference point by `arm`.
  OverlapMoments moved(const Eigen::Vector3d& arm) const;

  /// Size of a gradient of the volume: sqrt(|f|^2 + |m|^2 / l^2), m the torque about the centroid and l the radius of
  /// gyration about it (IdealLaw::descent). 0 without a volume.
  double gradient_norm(const Eigen::Vector3d& force, const Eigen::Vector3d& torque) const;
};

/// Of the intersection of a pin with the block, about the middle of the pin.
OverlapMoments square_pin_moments(double side, double length, double angle, const Eigen::Vector2d& shift);
OverlapMoments round_pin_moments(double r, double length, const Eigen::Vector2d& shift);

/// A cone, apex down, in a block whose faces are those that surround the apex.
struct ConeInBlock {
  double slope;           ///< Radius over height.
  double height;          ///< Of the cone.
  double bottom, top;     ///< Heights of the block's faces above the apex; bottom is 0 where the apex is above it.
  double before, beyond;  ///< Distances of the block's ends from the cone's axis along -x and +x, negative behind it.
};

/// The part of the integral that is of n_B, halved: torque about the middle of the cone's height. The axis y is up. By
/// the divergence theorem it is the integral, over the part of A's surface inside B, of the depth below B's surface
/// along A's outward normals.
NormalsWrench cone_normals(const ConeInBlock& shape);

/// The same part for a sphere of radius r whose centre is `distance` from the axis of a cylinder: the force away from
/// the axis. @pre the sphere meets the cylinder's wall only
double sphere_normals(double r, double cylinder, double distance);

}  // namespace sixdof
