#pragma once

#include <sixdof/scene/scene_algorithm.h>

namespace sixdof::scene {

/// ODE's spaces, each with ODE's narrow phase on triangle meshes (OPCODE, the first contact only): `ode-simple`,
/// `ode-hash`, `ode-quadtree`, `ode-sap`. They answer touching; ODE has no distances.
///
/// Bodies that are fixed are in a space of their own. ODE keeps state per process: no other query of ODE may run at the
/// same time.
void add_ode_scenes(SceneAlgorithms& algorithms);

}  // namespace sixdof::scene
