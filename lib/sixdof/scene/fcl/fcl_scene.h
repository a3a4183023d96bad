#pragma once

#include <sixdof/scene/scene_algorithm.h>

namespace sixdof::scene {

/// FCL's broad-phase managers, each with FCL's narrow phase on trees of oriented boxes and rectangle-swept spheres
/// (OBBRSS): `fcl-naive`, `fcl-ssap`, `fcl-sap`, `fcl-hash`, `fcl-interval-tree`, `fcl-aabb-tree`,
/// `fcl-aabb-tree-array`. They answer touching, near and closest; surfaces only.
///
/// As a careful user writes it: meshes are shared by bodies; bodies that are fixed are in a manager of their own, which
/// is never updated; a frame updates the bodies that have moved. Near pairs are asked as FCL's distance query with a
/// callback that leaves the smallest distance at the margin, so that the manager leaves out what is further. The cells
/// of the hash are those of FCL's own tests: a twentieth of the bodies' bounds at the start.
///
/// `fcl-sap` is measured where it is named: an update of FCL 0.7's sweep and prune may never return. It does not in the
/// second frame of `sixdof scene make giant -n 120 --frames 2 --seed 3`.
///
/// `fcl-interval-tree` is updated whole when any body moved: FCL 0.7's update of single bodies frees the sentinel of
/// its interval tree and goes on using it.
void add_fcl_scenes(SceneAlgorithms& algorithms);

}  // namespace sixdof::scene
