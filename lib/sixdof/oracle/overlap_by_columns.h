#pragma once

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

namespace sixdof {

/// Volume of the intersection of two closed meshes at a pose, by a method that shares nothing with OverlapQuery: for
/// verification.
///
/// Method: a body is the signed sum of the columns between its faces and a plane below (its signed shadows): s = +1 for
/// a face that looks up, -1 for one that looks down. So the volume of the intersection is the sum over all pairs of
/// faces (f of A, g of B) of s_f s_g times the integral of min(z_f, z_g) over the intersection of their projections to
/// the xy plane. No face is classified as inside or outside; ties are harmless because the integrand is continuous.
///
/// Cost: grows with the number of pairs of triangles whose projections overlap, at whatever z they are.
///
/// @return volume (length^3), to about 1e-15 * (number of pairs whose projections overlap) * (size^3).
/// @throws BadMesh if a mesh is open or not consistently oriented.
double overlap_volume_by_columns(const Mesh& a, const Mesh& b, const Pose& X_AB);

}  // namespace sixdof
