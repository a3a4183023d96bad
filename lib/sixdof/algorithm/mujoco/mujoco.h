#pragma once

#include <memory>

#include <sixdof/query/registry.h>

namespace sixdof {

/// `mujoco-hull`: MuJoCo's collision of two meshes, which it takes for their convex hulls. Answers collide.
///
/// **Another question**, as that of `ccd-hull` (ccd/ccd.h): Traits::body says so.
///
/// **Prepare** compiles a model of both meshes, A fixed and B with a free joint; MuJoCo makes the hulls with Qhull. **A
/// query** sets B's coordinates and runs mj_kinematics(), mj_comPos() and mj_collision(): MuJoCo's broad phase, then
/// Minkowski portal refinement (libccd's). It answers whether there is a contact, whose margin is 0. Hulls are solids:
/// one inside the other is a contact. Nothing is kept from query to query.
///
/// **Precision.** MuJoCo stores vertices in single precision and refines to 1e-6 of the length unit, at most 50 times:
/// the answer to hulls closer than that is by chance, and meshes far smaller than 1 are not answered well.
///
/// **Profiles.** MuJoCo's documentation gives no advice for yes/no beyond its defaults.
///
/// **Process.** The first preparation turns MuJoCo's errors, which would end the process, into exceptions, and silences
/// its warnings, for the rest of the process.
std::unique_ptr<Algorithm> make_mujoco_hull_algorithm();

/// Adds it.
void register_mujoco_algorithms(Registry& registry);

}  // namespace sixdof
