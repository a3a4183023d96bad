#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/common_point.h>
#include <sixdof/oracle/free_translation.h>
#include <sixdof/oracle/inner_balls.h>
#include <sixdof/oracle/penetration.h>

/// Cells of translations, and the proof that all of a cell collide. Internal: use penetration.h.
namespace sixdof::detail {

/// A common point of both bodies after a translation of B.
struct PlacedPoint {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< In A's frame.
  CommonPoint point;
};

/// The translations of a cone over a spherical triangle, of length r0 to r1. Its hull has the corners r0 u_k and r1 / h
/// u_k, where h is the distance of the triangle's plane from the origin: so it contains the whole cell.
struct TranslationCell {
  static constexpr std::size_t k_most_seeds = 3;

  std::array<Eigen::Vector3d, 3> u;             ///< Unit vectors.
  double r0 = 0.0, r1 = 0.0;                    ///< Lengths.
  std::array<PlacedPoint, k_most_seeds> seeds;  ///< Where a search of common points starts.
  std::size_t seed_count = 0;
  /// Size (length) of the cell around it for which the crossings of the surfaces were searched last.
  double searched = std::numeric_limits<double>::infinity();

  /// h
  double plane_distance() const;
  /// Length of the longest side of the triangle on the unit sphere, and its first corner.
  std::pair<double, std::size_t> longest_side() const;
  /// One of two halves: the longest side is divided at its middle. @param half 0 or 1
  TranslationCell halved(std::size_t half) const;
  /// Puts a seed first, and drops the last one if there are too many.
  void add_seed(const PlacedPoint& seed);
  /// Drops the first ones.
  void drop_seeds(std::size_t count);
};

/// How the attempt to prove a cell ended.
struct CellProof {
  /// What to do with the cell.
  enum class Next {
    proven,
    halve,    ///< Its directions.
    shorten,  ///< r1: what is beyond it follows when the rest is proven.
  };
  Next next = Next::halve;
  std::optional<Eigen::Vector3d> free;  ///< A free translation that is shorter than the limit.
  std::vector<PlacedPoint> seeds;       ///< For the cells that follow, the best first.
  std::optional<PlacedPoint> found;     ///< Where the surfaces cross, deeper than all seeds: for the pool.
  std::size_t used = 0;                 ///< Of the cell's seeds: `seeds` replace them.
  double searched = 0.0;                ///< As in the cell.
  std::uint64_t measurements = 0;
};

/// Proves cells of one pose; one object per thread. Results depend on the arguments alone.
class CellProver {
 public:
  /// @param oracle outlives it
  CellProver(const PenetrationOracle& oracle, const Pose& X_AB);

  /// @param pool common points of the pose itself and of other cells, for cells whose seeds fail
  /// @param limit length of the shortest free translation that is known
  CellProof prove(const TranslationCell& cell, std::span<const PlacedPoint> pool, double limit);

  /// Local maxima of the depth in both bodies at the pose, the deepest first: searched from the curves in which the
  /// surfaces intersect, and from corners.
  std::vector<PlacedPoint> find_pool();

  FreeTranslations& translations() { return free_; }
  std::uint64_t measurements() const { return points_.measurements(); }
  /// Least depth of a common point, and clearance of hulls (length).
  double clearance() const { return clearance_; }

 private:
  struct Corners;
  struct Attempt;
  /// Whether the common points of one seed prove a cell.
  enum class Cover {
    whole,
    gap,     ///< No common point at a corner.
    blocked  ///< A surface may be in between.
  };

  PlacedPoint move(const PlacedPoint& from, const Eigen::Vector3d& translation,
                   const CommonPointSearch::Effort& effort);
  Cover covers(const PlacedPoint& seed, const Corners& corners, std::optional<Eigen::Vector3d>& lost);
  std::optional<PlacedPoint> from_balls(const Eigen::Vector3d& translation, double least);
  std::optional<PlacedPoint> from_crossings(const Eigen::Vector3d& translation);
  std::optional<PlacedPoint> best_of(std::span<const PlacedPoint> pool, const Eigen::Vector3d& translation);
  bool proves(const PlacedPoint& middle, Attempt& attempt);
  bool finds_proof(std::span<const PlacedPoint> pool, Attempt& attempt);
  void examine(const Eigen::Vector3d& lost, double limit, CellProof& proof);

  const PenetrationOracle& oracle_;
  const Pose X_AB_;
  double clearance_;
  InnerBalls balls_b_;  ///< In A's frame at the pose.
  CommonPointSearch points_;
  FreeTranslations free_;
  CandidateScratch scratch_;
  std::vector<TrianglePair> pairs_;
  std::vector<std::pair<double, std::size_t>> nearest_;  ///< Of a pool: squares of distances, and places.
};

}  // namespace sixdof::detail
