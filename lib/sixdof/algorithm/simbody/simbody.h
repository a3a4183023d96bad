#pragma once

#include <memory>

#include <sixdof/query/registry.h>

namespace sixdof {

/// `simbody`: Simbody's elastic foundation of two triangle meshes. Answers collide and respond.
///
/// **What Simbody does.** A spring stands on each triangle of both meshes. One whose base, the triangle's centroid, is
/// inside the other mesh pushes with stiffness * area * displacement towards the nearest point of the other mesh's
/// surface (ElasticFoundationForce). Here the stiffness is 1 on both meshes, without dissipation and friction, and the
/// bodies are at rest. The springs of both meshes act, each with half of its triangle's area.
///
/// **Prepare** builds a ContactGeometry::TriangleMesh of each mesh in a MultibodySystem: A on the ground, B free. **A
/// query** sets B's coordinates and realizes the system to Stage::Dynamics: contacts, then all forces, also for
/// collide, since Simbody computes both there. collide asks whether Simbody reports a contact. Nothing is kept from
/// query to query.
///
/// **Response.** Force and torque are Simbody's on B. The penalty is the root mean square of the displacements over the
/// area of both surfaces (length): sqrt(4 energy / (stiffness * area)).
///
/// **Precision.** Double precision. **Profiles.** None: Simbody's documentation gives no other advice for meshes.
///
/// **Known failures.** Surfaces only: contacts start from triangles that intersect, so a body wholly inside the other
/// has none. Meshes must be closed and manifold. A force can be zero although the bodies overlap, where no centroid of
/// a triangle is inside the other body: a finer mesh answers better. The force is not the gradient of an energy where
/// the nearest point jumps, and on a thin body that point may be on the far side: 55 degrees from the exact force on
/// average over the conformance kit's pairs. Forces of meshes 1000 times larger differ by up to 0.3 %.
///
/// Not in suites and studies of all algorithms (Traits::by_default): a query of two meshes of 10,000 triangles takes
/// tens of milliseconds.
std::unique_ptr<Algorithm> make_simbody_algorithm();

/// Adds it.
void register_simbody_algorithms(Registry& registry);

}  // namespace sixdof
