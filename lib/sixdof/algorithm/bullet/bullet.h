#pragma once

#include <memory>

#include <sixdof/query/registry.h>

namespace sixdof {

/// `bullet-gimpact`: Bullet's GImpact, the shape that Bullet offers for moving triangle meshes. Answers collide,
/// respond and contacts.
///
/// **Precision.** Bullet is compiled for double precision (Debian's package `bullet-float64`). Boxes in GImpact's tree
/// are quantized to 16 bits and widened; triangles are not.
///
/// **Prepare** builds one btGImpactMeshShape per mesh, as in Bullet's GImpact example; it refers to the mesh's own
/// arrays.
/// **A query** moves B's collision object and runs GImpact's collision algorithm for the pair, without a broad phase.
/// It finds all pairs of triangles whose boxes overlap, and then all contacts: collide cannot stop at the first.
/// Contacts are collected as GImpact reports them, before Bullet's manifold keeps four of them. Nothing is kept from
/// query to query.
///
/// **Contacts** become a wrench by the rule of algorithm/contact_wrench.h. A contact is a point of a pair of triangles,
/// with the depth of that point below the plane of the other triangle.
///
/// **Why no btBvhTriangleMeshShape.** Bullet has no public query of two of these shapes. Its collision configuration
/// has an algorithm for a concave shape against a convex or a compound one; for two concave ones it returns
/// btEmptyAlgorithm, which finds nothing (tested). The tree of the shape, btOptimizedBvh, takes a box or a ray, never a
/// second tree. Its nodes are public, but a traversal of two trees would be this project's own, and so would its time.
/// What Bullet itself has of tree against tree is btGImpactQuantizedBvh::find_collision(), which `bullet-gimpact` runs.
///
/// **Margin.** GImpact thickens every triangle by parameter `margin`. Its own default is 0.1 length units whatever the
/// size of the mesh, which is a tenth of a body of size 1. The default here is 0, so that the question is the same as
/// that to the other algorithms.
///
/// **Known failures.** Surfaces only: a body wholly inside the other does not collide. GImpact clips one triangle
/// against the other instead of intersecting both: a triangle behind the plane of another one, and within that one's
/// outline, is a contact if their boxes overlap, although they may be apart. Where a body is thin and its triangles are
/// large and not along its axes, collide says yes for bodies that are far apart, and the force is that of a deep
/// contact.
std::unique_ptr<Algorithm> make_bullet_gimpact_algorithm();

/// Adds it, and `bullet-hull` (bullet_cast.h).
void register_bullet_algorithms(Registry& registry);

}  // namespace sixdof
