#pragma once

#include <Eigen/Core>

#include <sixdof/algorithm/ist/traversal.h>

namespace sixdof::ist {

/// Force and moment on B, in the frame and about the point of the sum they come from.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};

/// A wrench with the overlap volume V as magnitude and the direction in which V decreases fastest: V g / |g| for the
/// wrench g of `sum`, a sum of PairForce::gradient.
///
/// Comparing forces with moments needs a length l: |g|^2 = |f|^2 + |m|^2 / l^2, with m the moment about the overlap's
/// centroid and l the overlap's radius of gyration about it. So the result does not depend on the reference point, on
/// which body is called A, or on the unit of length. If m = 0, |force| = V; if f = 0, |moment| = V l. Zero where the
/// gradient vanishes, since there is no direction then.
///
/// Unlike V and its gradient, this wrench derives from no potential.
Wrench steepest_descent(const PenetrationSum& sum);

}  // namespace sixdof::ist
