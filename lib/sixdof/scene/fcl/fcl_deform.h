#pragma once

#include <sixdof/scene/scene_algorithm.h>

namespace sixdof::scene {

/// What FCL has for meshes that deform, each on trees of oriented boxes and rectangle-swept spheres (OBBRSS), which
/// answer touching, near and closest; surfaces only. They differ in the update alone:
/// - `fcl-rebuild`: beginReplaceModel() .. endReplaceModel(false): new vertices, the tree is built anew;
/// - `fcl-refit`: endReplaceModel(true, true): the tree stays, a node's volume is that around its children's;
/// - `fcl-refit-top-down`: endReplaceModel(true, false): the tree stays, each volume is fitted to the triangles below
/// it;
/// - `fcl-update`: beginUpdateModel() .. endUpdateModel(true, true): as fcl-refit, but volumes contain the triangles of
/// the
///   frame before as well, for continuous collision.
///
/// There is no broad phase: scenes in which a mesh deforms have few bodies, and every pair is asked.
void add_fcl_deforms(SceneAlgorithms& algorithms);

}  // namespace sixdof::scene
