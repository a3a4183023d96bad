#pragma once

#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/algorithm/ist/sphere.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::ist {

/// Directions around an axis: those of the surface next to a sphere. The axis leads the sphere out of its body.
struct NormalCone {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< Unit vector, outwards; zero if the cone is too wide for one.
  double half_angle = std::numbers::pi;            ///< Radians; pi without an axis.
};

/// Half angle (radians) beyond which a cone has no axis. The opening is then 160 degrees: a few normals more, and it
/// has no narrowest side.
constexpr double k_widest_half_angle = 80.0 * std::numbers::pi / 180.0;

/// Surface within this fraction of a sphere's radius beyond the closest point counts as touched. Packed spheres are
/// local maxima of the clearance to some percent (packing.cpp), so those in a corner touch one face and nearly touch
/// the others.
constexpr double k_touch_radii = 0.05;

/// The narrowest cone that contains some unit vectors, to 1e-12 in the cosine; without an axis if there are none, or
/// the cone is wider than k_widest_half_angle. It is defined by two or three of the vectors (Welzl, "Smallest Enclosing
/// Disks", 1991, on the sphere).
NormalCone narrowest_cone(std::span<const Eigen::Vector3d> directions);

/// Normal cone of each sphere of a packing: the narrowest cone around the outward normals of
///  - the triangles to which it is the nearest sphere: whose centroid is closer to its surface than to any other's, and
///  - the triangles that it touches: as far from its centre as the closest one, up to k_touch_radii of its radius.
/// By the second rule every sphere has a cone, however coarse the mesh is and however deep the sphere lies.
///
/// Weller and Zachmann (2009) have such cones of the surface next to each sphere; the two rules are this project's.
/// The same bits for every number of threads.
/// @param spheres inside the mesh, as pack_spheres() returns them
std::vector<NormalCone> normal_cones(const Mesh& mesh, std::span<const Sphere> spheres);

/// The same, kept in the cache on disk.
std::vector<NormalCone> cached_normal_cones(const Mesh& mesh, std::span<const Sphere> spheres);

}  // namespace sixdof::ist
