#pragma once

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

namespace sixdof {

/// Volume of the intersection of two closed meshes at a pose by a method that shares nothing with OverlapQuery: an
/// independent check. Its time grows with the number of pairs of triangles that meet in projection to a plane, whatever
/// is above or below: a fraction of a second for scanned bodies of 100,000 triangles.
///
/// A body is the signed sum of the columns below its faces, so the intersection's volume is the sum over all pairs of
/// faces (f of A, g of B) of s_f s_g times the integral of min(z_f, z_g) over the overlap of their projections to the
/// xy plane, s = +1 for faces that look up, -1 for those that look down. No face is classified as inside or outside;
/// ties are harmless because the integrand is continuous.
///
/// @return volume (length^3), to about 1e-15 * (number of pairs that meet in projection) * (size^3).
/// @throws BadMesh if a mesh is open or not consistently oriented.
double overlap_volume_by_columns(const Mesh& a, const Mesh& b, const Pose& X_AB);

}  // namespace sixdof
