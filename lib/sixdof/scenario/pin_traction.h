#pragma once

#include <Eigen/Core>

namespace sixdof {

/// Traction on one pin in its hole, summed over the pin's wall. In the plane across the pin; frame of the hole.
struct PinTraction {
  Eigen::Vector2d force = Eigen::Vector2d::Zero();  ///< Length^3.
  double torque = 0.0;                              ///< About the pin's axis, length^4, positive counter-clockwise.
};

/// Integral over the pin's wall outside the hole of the distance to the block's nearest face, along the pin's inward
/// normals or (along_wall) along the outward normals of that face. Top and bottom of the block are faces too: within
/// the depth d of them they are nearer than the hole's wall, so a vertical line at depth d carries d (length - d) along
/// the pin's normals and d (length - 2 d) along the wall's (what is nearest to top and bottom pushes along z and
/// cancels).
/// @param side of pin and hole; @param turn of the pin, radians; @param shift of the pin's axis from the hole's.
PinTraction square_pin_traction(double side, double length, double turn, const Eigen::Vector2d& shift, bool along_wall);

/// The same for a round pin of radius r in a round hole of radius r.
PinTraction round_pin_traction(double r, double length, const Eigen::Vector2d& shift, bool along_wall);

}  // namespace sixdof
