#pragma once

#include <Eigen/Core>

namespace sixdof {

/// An upper bound on the overlap volume of two bodies over all translations, from their boxes alone (length^3).
///
/// The overlap lies between two opposite faces of one body's box. Its volume is at most the distance of these faces
/// times the area of the largest section of the other body's box by a plane with their normal n. Projected onto the
/// face of that box normal to its axis i, a section's area is multiplied by |n_i|, so the section is at most
/// e_j e_k / |n_i| for each i, with the edges e. Nor is the overlap larger than either box. The bound is attained by
/// crossing plates, whose overlap is far smaller than either volume.
///
/// @param size_a, size_b edges of the bodies' boxes, each in its own frame
/// @param R_AB rotates directions from B's frame to A's
double overlap_upper_bound(const Eigen::Vector3d& size_a, const Eigen::Vector3d& size_b, const Eigen::Matrix3d& R_AB);

}  // namespace sixdof
