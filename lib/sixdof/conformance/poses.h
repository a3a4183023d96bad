#pragma once

#include <cstdint>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/typed_pose.h>
#include <sixdof/query/algorithm.h>

/// The meshes and poses of the conformance kit, with the oracles' answers.

namespace sixdof::conformance {

enum class Place {
  apart,
  overlapping,  ///< The surfaces intersect.
  contained     ///< One body is inside the other, the surfaces have no point in common.
};

/// A pose with its truth.
struct Case {
  Place place = Place::apart;
  TypedPose pose;
  double distance = 0.0;                            ///< Of the surfaces.
  double volume = 0.0;                              ///< Of the intersection.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Minus the gradient of that volume by B's translation.
};

struct Pair {
  Mesh a, b;
  std::vector<Case> cases;
};

/// Pairs of solids of several kinds, each with as many poses apart as overlapping: curved ones, one with sharp edges
/// and a tip, one of thin beams, a thin plate of large triangles that is turned in its frame, surfaces of high genus;
/// then a small body inside a large one, and the large one as B. The same in every process.
/// @param body convex_hull: pairs of the hulls of these bodies, each of which is its own hull
const std::vector<Pair>& pairs(Body body = Body::mesh);

/// A solid, and a surface with a border, with poses apart and overlapping (of the surfaces; volume and force are 0).
Pair open_pair();

/// The mesh moved by X.
Mesh moved(const Mesh& mesh, const Pose& X);
/// The mesh with every coordinate multiplied by `factor`.
Mesh scaled(const Mesh& mesh, double factor);

/// Rotation by three angles that no symmetry has, and a translation of the size of the models.
Pose generic_motion(std::uint64_t seed);

}  // namespace sixdof::conformance
