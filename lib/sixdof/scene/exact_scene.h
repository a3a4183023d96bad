#pragma once

#include <memory>

#include <sixdof/scene/scene_algorithm.h>

namespace sixdof::scene {

/// `exact`: the answers of `all-pairs`, bit for bit, with the work that a scene needs.
///
/// - The broad phase is kept between frames (kept_pairs.h): boxes that are too large by a few frames' motion.
/// - A pair is put off (not searched) until its bodies may have moved by the last lower bound on their distance. That
///   bound is from boxes and spheres, or from a search that ended above its limit.
/// - A pair of bodies that stand still keeps its answer; a frame in which nothing moves keeps all answers.
/// - A search ends at the limit that matters, the margin, or for the closest pair the smallest distance so far. Where
///   bodies move slowly the limit is a few frames' motion larger, so that the pair can be put off.
/// - A mesh that deforms keeps its tree (oracle/deforming_mesh.h); its largest displacement counts as motion of its
///   bodies. For the question `wrenches` the tree is always built anew, and else where bodies are so far apart that the
///   last bits of a distance depend on it.
/// - Pairs are searched by all threads; each has its place in the answer, so that bits do not depend on the number of
///   threads, nor on the order in which bodies are inserted.
///
/// `exact-refit` and `exact-rebuild` differ in how they update meshes that deform, and are compared where some do.
std::unique_ptr<SceneAlgorithm> make_exact_scene(MeshUpdate update = MeshUpdate::rule);

}  // namespace sixdof::scene
