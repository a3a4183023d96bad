#pragma once

#include <Eigen/Core>

#include <sixdof/algorithm/ist/traversal.h>

namespace sixdof::ist {

/// Force and moment on B, in the frame and about the point of the sum they come from.
struct PushSum {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};

/// The whole overlap volume V as magnitude, the steepest descent of V as direction: V g / |g| for the gradient wrench g
/// of `sum`, a sum of PairForce::gradient.
///
/// Forces and moments need a length to be compared: |g|^2 = |f|^2 + |m|^2 / l^2, with m the moment about the overlap's
/// centroid and l the overlap's radius of gyration about it. So the wrench does not depend on where it is referred to,
/// on which body is called A, or on the unit of length; a push without a moment about the overlap has |force| = V, a
/// pure torque |moment| = V l. Where the gradient vanishes there is no direction, and the push is zero.
///
/// Unlike V and its gradient this derives from no energy.
PushSum steepest_descent(const PenetrationSum& sum);

}  // namespace sixdof::ist
