#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <sixdof/base/parallel.h>
#include <sixdof/oracle/penetration_cell.h>

/// The branch and bound of a penetration depth. Internal: use penetration.h.
namespace sixdof::detail {

/// Triangles that cover the unit sphere: an icosahedron, turned so that its corners lie on no axis and no plane of
/// symmetry of usual bodies.
std::span<const std::array<Eigen::Vector3d, 3>> sphere_triangles();

/// 42 directions: corners of the icosahedron and middles of its edges.
std::span<const Eigen::Vector3d> sphere_directions();

/// Covers balls of translations by cells that are proven to collide, the innermost cells first.
///
/// A cell begins at the origin, or where a proven one with the same directions ends. What cannot be proven is replaced:
/// by halves of its directions, or by its inner part. A cell that is proven is followed by the next part of its cone,
/// which leaves k_step_left of what is left to hi. So cells get thin where hi is near, while their width across, which
/// costs, depends on how much further than hi B has to go in that direction.
///
/// Cells are taken in batches of k_batch, so the bits are those of one thread.
class PenetrationCover {
 public:
  /// @param first free translation; what is found is not longer
  PenetrationCover(const PenetrationOracle& oracle, const Pose& X_AB, const Eigen::Vector3d& first,
                   const PenetrationOptions& options);

  /// Works until the interval is closed or the budget is used up.
  PenetrationDepth run();

  static constexpr std::size_t k_batch = 32;
  static constexpr double k_step_left = 0.3;

 private:
  double target() const { return (1.0 - tolerance_) * translation_.norm(); }
  void put(const TranslationCell& cell);
  std::vector<TranslationCell> take_batch();
  void follow(const TranslationCell& cell, const CellProof& proof);
  void shorten_translation(const Eigen::Vector3d& free);
  void descend();
  double covered() const;

  const Pose X_AB_;
  const double tolerance_;
  const std::uint64_t budget_;
  parallel::PerThread<CellProver> provers_;
  CellProver own_;
  std::vector<PlacedPoint> pool_;
  Eigen::Vector3d translation_;
  bool is_descended_ = true;                                          ///< Contacts allow no shorter one.
  std::map<std::pair<double, std::uint64_t>, TranslationCell> open_;  ///< By r0, then in the order of their making.
  std::vector<double> given_up_;                                      ///< r0 of cells that are too narrow to be halved.
  std::uint64_t number_ = 0;
  PenetrationDepth result_;
};

}  // namespace sixdof::detail
