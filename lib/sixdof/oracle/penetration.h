#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/oracle/distance.h>
#include <sixdof/oracle/inner_balls.h>

/// Translational penetration depth of two solids, with a certificate.
///
/// The depth is the least |d| such that A and B translated by d have no common interior point. An evaluation gives an
/// interval [lo, hi] that contains it:
///   - hi is the length of a translation after which the bodies have no point in common, by exact yes/no.
///   - lo: every translation shorter than lo leaves a common interior point. Proof: the ball of radius lo is covered by
///     cells (penetration_cell.h), each the hull of a few translations t_j. For each t_j a point p_j is known that lies
///     in A and in B translated by t_j. If the hull of the p_j lies in A, and the hull of the p_j - t_j in B at its
///     pose, then all translations of the cell collide: t = sum w_j t_j brings the point sum w_j (p_j - t_j) of B to
///     sum w_j p_j in A.
/// So a cell need not be small where both bodies are locally convex, whatever their faces, edges and corners are: a
/// face, edge or corner that slides along another one has such points. Balls in both bodies are the special case of
/// p_j on a line between two fixed points.
///
/// Rounding: hulls keep a clearance of k_clearance times the sizes from the surfaces, far above the rounding of the
/// poses and of the points; lo is lowered and hi raised by it.
///
/// Where a mesh overlaps itself, a surface inside of the body is an obstacle for hulls: lo may be too low to close.
namespace sixdof {

/// When an evaluation ends.
struct PenetrationOptions {
  double tolerance = 1e-3;  ///< (hi - lo) / hi at which it is closed.
  /// Points whose distances to both surfaces are measured, and cells, at most. What is open then stays open. A limit of
  /// work, not of time: the interval is the same on every machine.
  std::uint64_t budget = 400'000;
};

/// The interval of a penetration depth.
struct PenetrationDepth {
  double lo = 0.0;  ///< All shorter translations collide (length).
  double hi = 0.0;  ///< Length of `translation`, rounded up; 0 if the bodies have no point in common.
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< Of B in A's frame, after which the bodies are disjoint.
  bool closed = false;             ///< (hi - lo) / hi is within the tolerance, or the bodies only touch.
  std::uint64_t measurements = 0;  ///< Points whose distances were measured.
  std::uint64_t casts = 0;         ///< First contacts that were searched.
  std::uint64_t cells = 0;         ///< Cells that were tried.
  std::uint64_t open_cells = 0;    ///< Cells inside of hi that are neither proven nor replaced.
};

/// Two solids prepared for penetration depths: immutable, shared by all threads.
class PenetrationOracle {
 public:
  /// Both meshes outlive it.
  /// @throws BadMesh with Mesh::why_not_solid() if a mesh is no solid, and as Tree does.
  PenetrationOracle(const Mesh& a, const Mesh& b);

  /// Uses the threads that parallel::with_threads() allows. The same bits for every number of threads.
  /// @throws BadArgument if the pose is not finite or no rotation, the tolerance is not in (0, 1) or the budget is 0
  PenetrationDepth evaluate(const Pose& X_AB, const PenetrationOptions& options = {}) const;

  /// The directional depth: how far B has to be translated along a direction until it is free there and everywhere
  /// beyond. It is an upper bound on the depth. The bodies are apart after the translation, and touch at most 1e-9 of
  /// the sizes before.
  /// @param direction unit vector in A's frame
  /// @return 0 if the bodies do not meet at any translation of 0 or more along it; none if the search gave up
  std::optional<double> directional_depth(const Pose& X_AB, const Eigen::Vector3d& direction) const;

  const Mesh& a() const { return *a_; }
  const Mesh& b() const { return *b_; }
  const DistanceOracle& distance_oracle() const { return distance_; }
  const detail::InnerBalls& balls_a() const { return balls_a_; }  ///< In A's frame.
  const detail::InnerBalls& balls_b() const { return balls_b_; }  ///< In B's frame.

  /// Clearance of hulls, over the sum of the trees' radii and the distances of both from the origin. Of a matrix that
  /// is not quite a rotation, its error is added.
  static constexpr double k_clearance = 1e-13;

 private:
  const Mesh* a_;
  const Mesh* b_;
  DistanceOracle distance_;
  detail::InnerBalls balls_a_, balls_b_;
};

}  // namespace sixdof
