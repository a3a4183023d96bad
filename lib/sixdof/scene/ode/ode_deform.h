#pragma once

#include <sixdof/scene/scene_algorithm.h>

namespace sixdof::scene {

/// What ODE has for meshes that deform; it answers touching, surfaces only: `ode-refit`: dGeomTriMeshDataUpdate(),
/// which has OPCODE fit the boxes of its tree anew; `ode-rebuild`: new data, set by dGeomTriMeshSetData(). There is no
/// space: every pair is asked.
void add_ode_deforms(SceneAlgorithms& algorithms);

}  // namespace sixdof::scene
