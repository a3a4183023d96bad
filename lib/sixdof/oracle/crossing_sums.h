#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/solid.h>

/// Sums over the pairs of triangles that intersect, from which Overlap follows. Internal: overlap.cpp.
namespace sixdof::detail {

/// Closed path along edges of a solid's mesh, to which the curve that borders the part of its surface inside the other
/// body is deformed (solid.h).
struct BorderPath {
  Solid::Potential potential;                             ///< Flux through the region within the path.
  Eigen::Vector3d area = Eigen::Vector3d::Zero();         ///< Integral of n over that region.
  Eigen::Matrix3d first_order = Eigen::Matrix3d::Zero();  ///< Integral of p n^T, but for a multiple of the
                                                          ///< identity.
};

struct CrossingSums {
  std::size_t crossings = 0;                         ///< Segments of the curves.
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< Start of the first segment (A's frame).
  Eigen::Vector3d area = Eigen::Vector3d::Zero();    ///< Sum of start x end, from the anchor.
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< Sum of (|start|^2 + start . end + |end|^2) (end - start).
  Solid::Moments beside_paths;                       ///< Fluxes between the curves and both paths, in A's frame.
  BorderPath path_a, path_b;                         ///< Each in its mesh's frame.
  double curvature = 0.0;                            ///< Overlap::curvature
};

/// Pairs of triangles, in the order of find_candidates().
struct PairPiece {
  std::span<const TrianglePair> pairs;
  bool intersect = false;  ///< Whether all of them are known to.
};

/// Gives pairs of triangles piece by piece; an empty piece ends them.
using PairSource = std::function<PairPiece()>;

/// Removes the pairs that do not intersect at X_AB.
void keep_crossings(const Solid& a, const Solid& b, const Pose& X_AB, std::vector<TrianglePair>& pairs);

/// The same bits on every instruction set, whatever pairs that do not intersect are among those given, and however they
/// are divided.
/// @param origin of all moments, in A's frame: near the crossings, so that little cancels
/// @param next gives all pairs that intersect at X_AB, and any others
/// @param along direction of the curvature, in A's frame; zero: none
CrossingSums sum_crossings(const Solid& a, const Solid& b, const Pose& X_AB, const Eigen::Vector3d& origin,
                           const PairSource& next, const Eigen::Vector3d& along = Eigen::Vector3d::Zero());

/// The same of these pairs.
CrossingSums sum_crossings(const Solid& a, const Solid& b, const Pose& X_AB, const Eigen::Vector3d& origin,
                           std::span<const TrianglePair> pairs, const Eigen::Vector3d& along = Eigen::Vector3d::Zero());

}  // namespace sixdof::detail
