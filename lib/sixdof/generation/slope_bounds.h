#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/swept_candidates.h>

/// How fast an overlap volume can change while two bodies move into each other along a line.
namespace sixdof {

/// The overlap at translation s.
struct OverlapSample {
  double s = 0.0;
  double volume = 0.0;
  double slope = 0.0;  ///< Derivative of the volume by the way in, -dV/ds.
};

/// What the slope is known to lie between.
struct SlopeRange {
  double low = 0.0;
  double high = 0.0;
};

/// The largest volume that is possible in a gap between two samples, and a place where it would be.
struct VolumePeak {
  double volume = 0.0;
  double s = 0.0;
};

/// @param ranges those of the slope in parts of the gap of equal length, from the outer sample to the inner one
VolumePeak volume_peak(const OverlapSample& outer, const OverlapSample& inner, std::span<const SlopeRange> ranges);

/// Bounds the slope within a gap between two samples by what can change it.
///
/// The slope is the area (projected along the line) of B's leading faces inside A less that of B's trailing faces
/// inside A; or the same with A and B exchanged. A triangle that does not touch the other surface stays inside or
/// outside. One that does comes in through faces that look against its motion and goes out through faces that look
/// along it: whether a pair of triangles that meet can only raise the slope or only lower it is seen from their
/// normals. So from either end of the gap to any place in it the slope rises by at most the area of the triangles that
/// take part in a raising pair on the way, and falls likewise. Through triangles along the line nothing comes or goes.
///
/// Holds for meshes that do not overlap themselves.
class SlopeBounds {
 public:
  /// Parts of a gap.
  static constexpr std::size_t k_parts = 32;

  /// @param a_count, b_count numbers of triangles
  SlopeBounds(std::size_t a_count, std::size_t b_count) : a_(a_count), b_(b_count) {}

  /// @param swept from way in, which holds the gap
  /// @param areas_a, areas_b area vectors of all triangles in tree order, in each mesh's own frame
  /// @param outwards_A, outwards_B direction from which B comes (unit), in each mesh's frame
  /// @param first, last ends of the gap as shares of the way: outer, inner
  /// @param outer_slope, inner_slope slopes there
  std::array<SlopeRange, k_parts> bound(const SweptCandidates& swept, std::span<const Eigen::Vector3d> areas_a,
                                        std::span<const Eigen::Vector3d> areas_b, const Eigen::Vector3d& outwards_A,
                                        const Eigen::Vector3d& outwards_B, double first, double last,
                                        double outer_slope, double inner_slope);

 private:
  using Areas = std::array<double, k_parts>;

  /// By how much pairs change the slope, for each part of the gap: from the outer end to any place in that part, and
  /// from there to the inner end.
  struct Change {
    Areas raised_since_outer{}, raised_until_inner{};
    Areas lowered_since_outer{}, lowered_until_inner{};
    void accumulate();
  };

  /// A triangle's parts of the gap from its first to its last pair of a kind.
  struct Stay {
    std::uint8_t first, last;
    static constexpr Stay none() { return {k_parts, 0}; }
    bool any() const { return first <= last; }
  };

  struct Mark {
    float area;  ///< Projected.
    std::uint32_t round = 0;
    Stay raising, lowering;
    std::int8_t side;  ///< 1: it looks outwards, -1: inwards, 0: along the line.
  };

  /// The triangles of one body that meet some triangle of the other.
  class Body {
   public:
    explicit Body(std::size_t count) : marks_(count) {}
    void clear();
    Mark& mark(std::uint32_t triangle, std::span<const Eigen::Vector3d> areas, const Eigen::Vector3d& outwards);
    Change change() const;

   private:
    std::vector<Mark> marks_;
    std::vector<std::uint32_t> marked_;
    std::uint32_t round_ = 0;
  };

  Body a_;
  Body b_;
};

}  // namespace sixdof
