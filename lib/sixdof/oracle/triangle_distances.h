#pragma once

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <sixdof/geometry/triangle_distance.h>

namespace sixdof {

/// triangle_triangle_distance() of up to eight pairs of triangles at once. On every instruction set its distances have
/// the bits of that function. A few pairs are left to it: triangles that meet or nearly do, nearly parallel edges,
/// triangles that are nearly a segment.
class alignas(64) TriangleDistances {
 public:
  static constexpr std::size_t k_most = 8;  ///< Pairs.

  /// Adds a pair, both triangles in one frame. At most k_most since clear().
  void add(const TriangleCorners& a, const TriangleCorners& b);
  void clear() { count_ = 0; }
  std::size_t count() const { return count_; }

  /// Measures all pairs. Call once after the last add().
  void measure();

  /// Whether pair i was measured. The other results of a pair hold only then.
  bool is_measured(std::size_t i) const { return (measured_ >> i & 1u) != 0; }
  double distance(std::size_t i) const { return distance_[i]; }
  /// From the closest point of a to that of b.
  Eigen::Vector3d direction(std::size_t i) const { return {direction_[0][i], direction_[1][i], direction_[2][i]}; }

  /// [body][corner][axis][pair]
  using Corners = double[2][3][3][k_most];

 private:
  Corners corner_;
  double distance_[k_most];
  double direction_[3][k_most];
  std::size_t count_ = 0;
  std::uint32_t measured_ = 0;
};

}  // namespace sixdof
