#pragma once

#include "cgal_mesh.h"

/// Minkowski sums by CGAL's Nef polyhedra, in exact arithmetic. For tests only: these parts of CGAL are GPL, and the
/// library does not link them.
namespace sixdof::reference {

/// Distance of the origin from the surface of the Minkowski sum of two solids, which need not be convex. With -B for
/// the second it is the translational penetration depth of A and B, if they have a common interior point. Seconds for
/// solids of a dozen triangles; the points of the sum are rounded to doubles. Negative if CGAL fails.
double distance_to_minkowski_sum(const CgalMesh& a, const CgalMesh& b);

}  // namespace sixdof::reference
