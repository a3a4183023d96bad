#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/crossing_parts.h>
#include <sixdof/oracle/crossing_sums.h>
#include <sixdof/oracle/kept_candidates.h>
#include <sixdof/oracle/solid.h>

/// Exact overlap of two solids: volume of the intersection, its centroid, and the volume's gradient.
///
/// Body A is fixed, body B is moved by X_AB; vectors are in A's frame. The overlap is that for B's vertices rounded to
/// doubles in A's frame (transform_point()). The surfaces intersect in closed curves, which consist of one segment per
/// pair of triangles that intersect (crossing.h).
///
/// Idea: every integral over the intersection is a sum over the parts of A's and of B's surface that bound it.
///   - By the divergence theorem, volume and first moment are fluxes through these parts: sums of potentials along the
///     curves that border them (solid.h), not over the triangles inside. Which side of a curve belongs to the
///     intersection follows from the normals of the two triangles. The total flux of each connected piece of a surface
///     is added as often as the other body winds around one vertex of it (winding.h).
///   - By Stokes' theorem, area and moment (integrals of n and p x n) are integrals along the curves.
/// Each crossing adds its terms by itself: the intersection is never built. On each of its two triangles a segment adds
/// the fluxes through the triangle (lowest corner, start, end); an end on the side opposite the lowest corner adds a
/// potential and the flux through the triangle (lowest corner, middle corner, end).
///
/// Robustness: every decision is exact. Ties (equal faces, shared vertices, touching) are decided as if B were
/// translated by an infinitesimal vector (predicates.h): Edelsbrunner and Muecke, "Simulation of simplicity", 1990,
/// with a perturbation that is a motion, so all decisions agree with one position of B.
namespace sixdof {

/// What two solid bodies have in common at a pose. All vectors are in A's frame.
///
/// Where a mesh overlaps itself, winding numbers count: volume is the integral of the product of both meshes' winding
/// numbers. A part of A that is covered twice counts twice.
struct Overlap {
  /// Volume of the intersection (length^3). Rounding may leave a small value of either sign where bodies only touch.
  double volume = 0.0;
  /// Integral of B's outward normal over the part of B's surface inside A (length^2): the gradient of volume with
  /// respect to translating B. The force of the volume law is its negative.
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  /// Integral of (p - reference) x (B's outward normal) over the same part (length^3): the gradient of volume with
  /// respect to rotating B about `reference`. The torque of the volume law is its negative.
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  /// The point of `moment`, in A's frame.
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();
  /// Centre of mass of the intersection (length); NaN where volume is not positive.
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  /// Second derivative of volume by a translation of B along a direction that was asked for (length); else 0. A
  /// triangle whose lowest corner lies on the line of its segment adds a wrong term: good for predictions only.
  double curvature = 0.0;
  std::size_t crossings = 0;  ///< Pairs of triangles that intersect: segments of the curves.
};

/// Overlap queries of two solids.
///
/// Error of volume: a small multiple of 1e-16 * (size + distance of the bodies from the origin of A's frame) * (area of
/// the triangles that are crossed), however small the volume is. Error of area: the ends of the curves' segments are
/// off by about 1e-16 * (size + distance of the bodies from the origin of A's frame), so the direction of a force is
/// right as soon as the curves are much longer than that.
///
/// Cost: finding the crossings in the trees, then a constant per crossing.
///
/// One object per calling thread; any number may share the solids. No allocation once the scratch has grown, but by
/// oneTBB where a query uses several threads.
class OverlapQuery {
 public:
  /// Both solids outlive this object.
  /// @param threads that a query without a warm start may use, this one included. The bits are the same
  OverlapQuery(const Solid& a, const Solid& b, unsigned threads = 1) : a_(&a), b_(&b), threads_(threads) {}

  /// @param reference the point (A's frame) about which the moment is taken.
  /// @param warm_start for poses that follow each other closely: candidates are kept for the poses near by. The bits
  /// are the same
  /// @throws BadArgument if the pose or the reference is not finite.
  Overlap evaluate(const Pose& X_AB, const Eigen::Vector3d& reference, bool warm_start = false);

  /// The same bits from known candidates: in the order of find_candidates(), all pairs of triangles that intersect, and
  /// any others.
  /// @param along direction of the curvature (unit, A's frame); zero: none
  Overlap evaluate(const Pose& X_AB, const Eigen::Vector3d& reference, std::span<const TrianglePair> pairs,
                   const Eigen::Vector3d& along = Eigen::Vector3d::Zero());

  /// About the centre of B's bounding box.
  Overlap evaluate(const Pose& X_AB, bool warm_start = false) {
    return evaluate(X_AB, X_AB * b_->mesh().center(), warm_start);
  }

  /// Pairs of volumes that queries with a warm start have expanded so far.
  std::size_t warm_expansions() const { return kept_.expansions(); }
  /// Memory of the scratch and of what a warm start keeps, without the solids.
  std::size_t bytes() const;

 private:
  /// @param next as that of detail::sum_crossings()
  Overlap sum_up(const Pose& X_AB, const Eigen::Vector3d& reference, const detail::PairSource& next,
                 const Eigen::Vector3d& along);
  Overlap evaluate_by_threads(const Pose& X_AB, const Eigen::Vector3d& reference);

  const Solid* a_;
  const Solid* b_;
  unsigned threads_;
  CandidateScratch scratch_;
  std::vector<TrianglePair> pairs_;  // scratch
  detail::CrossingParts parts_;      // if it uses several threads
  detail::KeptCandidates kept_;
  std::vector<std::uint32_t> triangles_;  // scratch
};

/// Volume of the intersection of two closed meshes at a pose, by a method that shares nothing with OverlapQuery: for
/// verification.
///
/// Method: a body is the signed sum of the columns between its faces and a plane below (its signed shadows): s = +1 for
/// a face that looks up, -1 for one that looks down. So the volume of the intersection is the sum over all pairs of
/// faces (f of A, g of B) of s_f s_g times the integral of min(z_f, z_g) over the intersection of their projections to
/// the xy plane. No face is classified as inside or outside; ties are harmless because the integrand is continuous.
///
/// Cost: grows with the number of pairs of triangles whose projections overlap, at whatever z they are.
///
/// @return volume (length^3), to about 1e-15 * (number of pairs whose projections overlap) * (size^3).
/// @throws BadMesh if a mesh is open or not consistently oriented.
double overlap_volume_by_columns(const Mesh& a, const Mesh& b, const Pose& X_AB);

}  // namespace sixdof
