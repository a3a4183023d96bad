#pragma once

#include <Eigen/Core>

namespace sixdof {

/// An upper bound on the overlap volume of two bodies under any translation, from their boxes alone (length^3).
///
/// The overlap lies between two parallel faces of either body's box, h apart, so it has at most h times the area of the
/// largest section of the other body across that direction n. A section projects into the face jk of the body's box at
/// |n_i| times its area, hence area <= e_j e_k / |n_i|, for each i. Nor is it larger than either box. Tight for plates
/// that cross, whose overlap is far below the volume of either.
///
/// @param size_a, size_b edges of the bodies' boxes, each in its own frame
/// @param R_AB turns directions from B's frame to A's
double overlap_ceiling(const Eigen::Vector3d& size_a, const Eigen::Vector3d& size_b, const Eigen::Matrix3d& R_AB);

}  // namespace sixdof
