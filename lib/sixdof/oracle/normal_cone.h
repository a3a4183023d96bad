#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>

namespace sixdof {

/// Normals that differ by less (radians) count as one.
inline constexpr double k_same_normal = 1e-6;

/// Outward normals (unit) of the triangles that come as near to `p` as the nearest one, up to `slack` (length): one
/// where the nearest point lies on a face, those of the faces that meet in it where it lies on an edge or in a corner.
/// They generate the normal cone of the surface there: of a convex body the cone of convex analysis (Rockafellar and
/// Wets, Variational Analysis, 1998, chapter 6), else its convexified one (Clarke). Triangles without area have none.
/// @param p in the mesh's frame
/// @param normals what they are appended to
void normals_near(const Tree& tree, const Eigen::Vector3d& p, double slack, std::vector<Eigen::Vector3d>& normals);

/// Angle in degrees, 0 to 180, between a unit vector and the nearest direction of the convex cone of the generators;
/// 0 within it; 180 without a generator.
/// @param generators unit vectors
double angle_to_cone(const Eigen::Vector3d& n, std::span<const Eigen::Vector3d> generators);

}  // namespace sixdof
