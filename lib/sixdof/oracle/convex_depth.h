#pragma once

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

namespace sixdof {

/// The translational penetration depth of two convex bodies.
struct ConvexDepth {
  /// Length of the shortest translation of B after which the interiors are disjoint; 0 if they are (length).
  double depth = 0.0;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< Of that translation: a unit vector in A's frame.
};

/// By the faces of the Minkowski difference {p - q} of points p of A and q of B: its normals are A's face normals, B's
/// reversed, and cross products of an edge of A and one of B whose arcs on the Gauss map cross. The depth is the least
/// support value over them. Source: D. Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013.
///
/// It shares nothing with penetration.h, whose witness it is. Any normal gives an upper bound, and each that counts is
/// supported by all vertices, so rounding of the arcs only adds candidates. Error: some 1e-15 times the sizes.
///
/// Cost: the number of edges of A times that of B, a few nanoseconds each.
/// @param a, b convex solids, such as convex_hull() makes; not checked. For others it is the depth of their hulls,
/// provided that the edges of the hulls are edges of the meshes
ConvexDepth convex_depth(const Mesh& a, const Mesh& b, const Pose& X_AB);

}  // namespace sixdof
