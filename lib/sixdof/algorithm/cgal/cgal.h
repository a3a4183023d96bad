#pragma once

#include <memory>

#include <sixdof/query/registry.h>

namespace sixdof {

/// `cgal`: CGAL's polygon mesh processing. Answers collide and respond.
///
/// **Licence.** The packages of CGAL that this file uses are under the GPL version 3 or later. A program that links
/// sixdof::cgal may be distributed under that licence only. It is built with -DSIXDOF_WITH_CGAL=ON, off by default.
///
/// **Collide** is Rigid_triangle_mesh_collision_detection, CGAL's class for rigid bodies that move: `prepare` builds a
/// tree of each mesh, a query sets B's transformation and calls get_all_intersections(). It stops at the first pair of
/// triangles that intersect. Surfaces only: a body wholly inside the other does not collide.
///
/// **Respond** is corefine_and_compute_intersection(): a query copies both meshes, since corefinement changes them,
/// moves B's vertices and builds the boundary of the intersection. Volume and force are sums over this boundary's
/// triangles (volume_response.h). CGAL's trees of that call are built in every query. Both meshes must be closed and
/// must not intersect themselves; corefinement that CGAL refuses is a failed query.
///
/// **Precision.** Kernel Exact_predicates_inexact_constructions: all decisions are exact for the rounded corners, new
/// vertices are rounded to double precision. A transformation's coefficients are doubles; collide transforms with
/// interval arithmetic where that matters to CGAL.
///
/// **Profiles.** None: CGAL's manual gives no other advice for these queries.
///
/// Not in suites and studies of all algorithms (Traits::by_default): a response of two meshes of 100,000 triangles
/// takes some 0.4 s.
std::unique_ptr<Algorithm> make_cgal_algorithm();

/// Adds it.
void register_cgal_algorithms(Registry& registry);

}  // namespace sixdof
