#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>

/// The law of depth on any pair of bodies: what the sum of a pointshell's forces tends to as its points get denser.
///
///     F = integral of d(x) m(x) dA,   T = integral of (x - c) x d(x) m(x) dA
///
/// over the part of B's surface inside A. d(x) is the distance of x to A's surface, m(x) a unit direction and c the
/// centre of B's box. A point is inside A where the winding number of A's surface around it is positive.
///
/// Quadrature: B's triangles are split where it matters. A piece has six nodes (corners and midpoints of sides). On
/// each of its four quarters the signed depth is taken as linear, so the part inside A is cut off exactly where A's
/// surface is plane there. The error of a piece is estimated from the difference of its integral by quarters and as a
/// whole, and, where A's surface may pass through it, from the fact that depths change by no more than the way: a spike
/// of A between the nodes is not overlooked. Pieces are split in rounds, those with the largest estimates first, until
/// the SUM of all estimates is within the tolerance. That sum ignores that errors cancel: true errors are smaller.
///
/// Bits do not depend on the number of threads.
namespace sixdof {

/// m(x) of the law.
enum class DepthDirection {
  normal_of_b,  ///< The inward normal of B's triangle at x, as in voxmap-pointshell. Source: W. A. McNeely et al.,
                ///< 1999.
  way_out       ///< From x to the nearest point of A's surface.
};

/// When a quadrature ends.
struct DepthTolerance {
  /// Largest error of the force over |force|, and of the torque over the larger of |torque| and k_lever |force| r, with
  /// r half the diagonal of B's box. Where forces cancel, |force| is taken for no less than k_cancelled times the
  /// integral of the depth.
  double relative = 1e-3;
  static constexpr double k_lever = 0.1;
  static constexpr double k_cancelled = 0.01;
  /// Where bodies touch without depth, |force| is taken for no less than this times the cube of B's diagonal.
  static constexpr double k_least = 1e-8;
  std::size_t most_pieces = 400'000;  ///< Bound of memory (some 300 bytes a piece) and time.
};

/// The wrench of the law of depth at a pose. Vectors are in A's frame.
struct DepthIntegral {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();      ///< On B (length^3).
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();     ///< On B about `reference` (length^4).
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();  ///< Centre of B's box.
  double area = 0.0;            ///< Of B's surface inside A (length^2); an estimate without a bound.
  double depth = 0.0;           ///< Largest depth of a node (length): of all corners of B, among others.
  double depth_integral = 0.0;  ///< Of d(x) dA (length^3).
  double force_error = 0.0;     ///< Estimate of |error of force|.
  double torque_error = 0.0;    ///< Estimate of |error of torque|.
  std::size_t pieces = 0;       ///< That carry the integral.
  std::size_t searches = 0;     ///< Points whose depth was measured.
  bool converged = false;       ///< Both errors are within the tolerance.
};

/// Two meshes prepared for integrals of depth: immutable, shared by all threads.
class DepthOracle {
 public:
  /// Both meshes outlive it.
  /// @throws BadMesh with Mesh::why_not_solid() if a mesh is no solid, and as Tree does.
  DepthOracle(const Mesh& a, const Mesh& b);

  /// Uses the threads that parallel::with_threads() allows.
  DepthIntegral evaluate(const Pose& X_AB, DepthDirection direction = DepthDirection::normal_of_b,
                         const DepthTolerance& tolerance = {}) const;

  const Mesh& a() const { return *a_; }
  const Mesh& b() const { return *b_; }
  const Tree& tree_a() const { return tree_a_; }
  const Tree& tree_b() const { return tree_b_; }
  /// Number of the edge from corner k to the next of a triangle of B's mesh.
  std::uint32_t edge_of_b(std::uint32_t triangle, std::size_t k) const { return edges_b_[3 * triangle + k]; }
  std::size_t edge_count() const { return edge_count_; }
  /// Memory, without the meshes.
  std::size_t bytes() const;

 private:
  const Mesh* a_;
  const Mesh* b_;
  Tree tree_a_;
  Tree tree_b_;
  std::vector<std::uint32_t> edges_b_;  ///< [3 triangle + k]
  std::size_t edge_count_ = 0;
};

}  // namespace sixdof
