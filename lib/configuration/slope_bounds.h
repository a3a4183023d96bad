#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// How fast an overlap volume can change while two bodies move into each other along a line.
///
/// The derivative of V by the way in is the area (projected along the line) of B's leading faces inside A less that of
/// B's trailing faces inside A; or the same with A and B exchanged. A face can be inside the other body only if it lies
/// in the slab that both bodies' extents along the line have in common. So both parts are bounded by the projected area
/// of all faces that reach as deep: a number per body and depth, tabulated here.
///
/// With these two bounds values at both ends of an interval bound V within it from above, which is what makes a
/// crossing certainly the first one. They hold for meshes that do not overlap themselves.
class ReachTable {
 public:
  ReachTable() = default;

  /// @param areas of all triangles: area times normal, in the mesh's frame
  /// @param forward the direction (unit, mesh's frame) in which the body meets the other one
  ReachTable(const Mesh& mesh, std::span<const Eigen::Vector3d> areas, const Eigen::Vector3d& forward);

  /// How far the body reaches forward from the centre of its box.
  double front() const { return front_; }

  /// Projected area of the faces that look forward (leading) or back (trailing) and reach into the foremost `depth` of
  /// the body; rounded up to the next of k_bins depths.
  double leading(double depth) const { return depth < 0.0 ? 0.0 : leading_[bin(depth)]; }
  double trailing(double depth) const { return depth < 0.0 ? 0.0 : trailing_[bin(depth)]; }

 private:
  static constexpr std::size_t k_bins = 128;
  std::size_t bin(double depth) const;

  double front_ = 0.0;
  double bins_per_length_ = 0.0;
  std::array<double, k_bins> leading_{};
  std::array<double, k_bins> trailing_{};
};

/// Area times normal of every triangle (length^2), in the mesh's frame.
std::vector<Eigen::Vector3d> area_vectors(const Mesh& mesh);

/// What the slopes of V are known to lie between while the bodies' slabs overlap by no more than some depth.
struct SlopeBounds {
  double rise = 0.0;  ///< V grows by at most this per length of way in.
  double fall = 0.0;  ///< V falls by at most this per length of way in.

  static SlopeBounds at(const ReachTable& a, const ReachTable& b, double depth);

  /// The largest V that is possible within a way of length `way` with V = `outer` at its begin and `inner` at its end.
  double peak(double outer, double inner, double way) const;
};

}  // namespace sixdof
