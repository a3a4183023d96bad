#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/stability/case.h>

/// Shots with a known truth, and the changes of a shot under which answers stay what they are.
namespace sixdof::stability {

/// B over the face z = `height` of A, its lowest vertex above (x, y), about `gap` away. The truth is the gap of the
/// rounded vertices in long double.
/// @pre A lies below the face; where B's vertices come within reach, the face extends farther than the gap is deep
Shot above_face(const MeshPointer& a, double height, const MeshPointer& b, const Eigen::Quaterniond& q, double x,
                double y, double gap);

/// Two boxes along the axes, with centres `offset` apart: gap, distance, volume and direction in closed form.
Shot aligned_boxes(const Eigen::Vector3d& size_a, const Eigen::Vector3d& size_b, const Eigen::Vector3d& offset);

/// Distance by brute force in long double (reference.h): for bodies that are apart or only touch.
Shot apart(const MeshPointer& a, const MeshPointer& b, const Placement& X_AB);

/// B deep in A by `depth`, known to `error`.
Shot overlapping(const MeshPointer& a, const MeshPointer& b, const Placement& X_AB, double depth, double error);

/// Both meshes in frames of their own: A's vertices moved by `of_a`, B's by `of_b`, the pose changed accordingly. The
/// rounding of the moved vertices is part of Shot::rounding().
Shot moved(const Shot& shot, const Placement& of_a, const Placement& of_b);

/// A becomes B.
Shot swapped(const Shot& shot);

/// Every length times `factor`.
Shot scaled(const Shot& shot, double factor);

}  // namespace sixdof::stability
