#pragma once

#include <memory>

#include <sixdof/query/registry.h>

namespace sixdof {

/// `exact`: the oracles that define truth in this suite, behind the interface of an algorithm. Distances are those of
/// DistanceQuery. Where the meshes are solid, collide tests the bodies and not only their surfaces.
///
/// The response follows the volume law with stiffness 1: penalty = volume of the intersection, force = -(gradient of
/// the volume with respect to translating B), torque = -(gradient with respect to rotating B about the centre of its
/// box), so it derives from a potential. It needs solids: respond() fails with the reason for other meshes.
std::unique_ptr<Algorithm> make_exact_algorithm();

/// `exact-depth`: the law of depth by quadrature (oracle/depth_integral.h), which `vps` tends to; the penalty is the
/// largest depth. The force is within the parameter `tolerance`; a query that does not get there within `most_pieces`
/// fails. It needs solids.
std::unique_ptr<Algorithm> make_exact_depth_algorithm();
/// `exact-way-out`: the same along the shortest way out of A, which `vps-field` tends to.
std::unique_ptr<Algorithm> make_exact_way_out_algorithm();

/// `brute-force`: the smallest distance over all pairs of triangles; collide where it is 0. It has no tree and shares
/// no code with the other algorithms, so it checks them where meshes are small. Surfaces only.
std::unique_ptr<Algorithm> make_brute_force_algorithm();

/// `sampled`: casts by yes/no at equal steps of the motion, and bisection between the first yes and the no before it.
/// What most programs do. It misses contacts that begin and end between two steps, and its answer is late where the
/// first contact was missed. Yes/no and trees are those of `exact`.
std::unique_ptr<Algorithm> make_sampled_algorithm();

/// `exact-contacts`: contacts by the exact geometry that judges them (oracle/contact_truth.h): vertices of each body
/// inside the other, with the shortest way out as the normal (the face's, of a vertex within a flat face), and the
/// middles of the segments in which triangles cross, with the normal of that triangle along which less is to be moved.
/// A depth is the thickness of the intersection there. It shows what the scores of contacts are for contacts that are
/// right, and is not made to be fast. It needs solids.
std::unique_ptr<Algorithm> make_exact_contacts_algorithm();

/// `exact-penetration`: one contact, whose depth and normal are the shortest free translation of B that was found
/// (oracle/penetration.h), if its length is proven to `tolerance`; else the query fails. It times the truth of the rows
/// `depth/...`. It needs solids.
std::unique_ptr<Algorithm> make_exact_penetration_algorithm();

/// Adds the algorithms that need no third-party collision library: these seven, `null`, which answers with constants,
/// `ist`, `ist-descent`, `vps` and `vps-field`.
void register_core_algorithms(Registry& registry);

}  // namespace sixdof
