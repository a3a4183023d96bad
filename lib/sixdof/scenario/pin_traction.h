#pragma once

#include <Eigen/Core>

#include <sixdof/scenario/plane_wrench.h>

namespace sixdof {

/// Traction on one pin in its hole, summed over the pin's wall: force in length^3, torque about the pin's axis in
/// length^4, in the frame of the hole.
///
/// It is the integral over the pin's wall outside the hole of the distance to the block's nearest face, along the pin's
/// inward normals or (along_wall) along the outward normals of that face. The block's top and bottom are faces too and
/// are nearer than the hole's wall within the depth d of them. So a vertical line at depth d carries d (length - d)
/// along the pin's normals and d (length - 2 d) along the wall's; what top and bottom push along z cancels.
/// @param side of pin and hole; @param angle rotation of the pin, radians; @param shift of the pin's axis from the
/// hole's
PlaneWrench square_pin_traction(double side, double length, double angle, const Eigen::Vector2d& shift,
                                bool along_wall);

/// The same for a round pin of radius r in a round hole of radius r.
PlaneWrench round_pin_traction(double r, double length, const Eigen::Vector2d& shift, bool along_wall);

}  // namespace sixdof
