#pragma once

#include <memory>
#include <string>

#include <sixdof/query/registry.h>

namespace sixdof {

/// `fcl-obbrss`: FCL's bounding-volume trees with an oriented box and a rectangle-swept sphere in every node. Answers
/// collide (FCL tests boxes and stops at the first pair of triangles that intersect) and distance (swept spheres).
///
/// Surfaces only: a body wholly inside the other does not collide, and its distance is that of the surfaces.
std::unique_ptr<Algorithm> make_fcl_obbrss_algorithm();

/// `fcl-rss`: rectangle-swept spheres only, the bounding volume of PQP. Answers distance. It does not answer collide:
/// FCL 0.7 copies and refits the whole model in every collide() on this volume, which would be all that is measured.
std::unique_ptr<Algorithm> make_fcl_rss_algorithm();

/// `fcl-kios`: intersections of up to five spheres, with an oriented box, in every node. Answers collide (boxes first)
/// and distance (spheres). Surfaces only.
std::unique_ptr<Algorithm> make_fcl_kios_algorithm();

/// `fcl-obb`: oriented boxes only. Answers collide; FCL has no distance for this volume. Surfaces only.
std::unique_ptr<Algorithm> make_fcl_obb_algorithm();

/// `fcl-aabb`: boxes along the axes of each mesh. Answers collide. FCL copies both models in every query, transforms
/// the vertices of B and refits B's boxes, so that the time of a query grows with the number of triangles and hardly
/// depends on the pose. Surfaces only.
std::unique_ptr<Algorithm> make_fcl_aabb_algorithm();

/// `fcl-contacts`: FCL's contacts as they are, and turned into a wrench of the depth law. Answers respond and contacts.
///
/// For every pair of intersecting triangles FCL reports a point, a unit normal from A to B and the penetration depth of
/// these two triangles, not of the bodies. They become a wrench by the rule of algorithm/contact_wrench.h.
///
/// Limits: surfaces only, so a body wholly inside the other has no contact; coplanar triangles give contacts with
/// normals of either sign, or none; depths are not continuous, as pairs appear and disappear.
std::unique_ptr<Algorithm> make_fcl_contacts_algorithm();

/// `fcl-cast`: FCL's continuous collision. Answers cast only, without points and normals. The motion is
/// TranslationMotion or InterpMotion. A rotation by more than pi, which they cannot have, is asked in parts.
///
/// `solver=naive` is the default of FCL's request, with its ten steps: contacts between them are missed.
///
/// `solver=advancement` misses contacts into which B moves straight. continuousCollide() takes the traversal of volumes
/// without frames also for trees that have one: BVHConservativeAdvancement() calls the general overload
/// (conservative_advancement_func_matrix-inl.h). That traversal bounds the motion of both bodies along the same normal,
/// where the second one needs the opposite (leafTesting() in mesh_conservative_advancement_traversal_node-inl.h): a
/// body that approaches seems to part. It also takes vertices that are moved to the world's frame for those of the
/// mesh.
///
/// `solver=oriented` calls conservativeAdvancementMeshOriented(), FCL's own function for these trees, which has the
/// signs right.
std::unique_ptr<Algorithm> make_fcl_cast_algorithm();

/// Which FCL this is: Debian's package and its version (FCL's own version elsewhere), FCL's option for SIMD and the
/// alignment of Eigen's types, e.g. "libfcl-dev 0.7.0-3+b1, FCL_HAVE_SSE 0, EIGEN_MAX_ALIGN_BYTES 16". The package is
/// that of the headers when sixdof was configured.
std::string fcl_build();

/// Adds all seven.
void register_fcl_algorithms(Registry& registry);

}  // namespace sixdof
