#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/oracle/swept_candidates.h>

/// Bounds on how fast an overlap volume can change while B moves towards A along a ray. The slope is the derivative of
/// the volume by the displacement inwards, -dV/ds.
namespace sixdof {

/// The overlap at translation s.
struct OverlapMeasurement {
  double s = 0.0;
  double volume = 0.0;
  double slope = 0.0;
};

/// Bounds on the slope.
struct SlopeRange {
  double low = 0.0;
  double high = 0.0;
};

/// The largest volume possible between two measurements, and a translation at which it would be.
struct VolumePeak {
  double volume = 0.0;
  double s = 0.0;
};

/// @param ranges bounds on the slope in parts of equal length, from the outer measurement to the inner one
VolumePeak volume_peak(const OverlapMeasurement& outer, const OverlapMeasurement& inner,
                       std::span<const SlopeRange> ranges);

/// Bounds the slope in the interval between two measurements.
///
/// The slope is the area (projected along the ray) of B's leading faces inside A less that of B's trailing faces inside
/// A; the same holds with A and B exchanged. A triangle that does not touch the other surface stays inside or outside.
/// A triangle that touches it enters through faces whose normals point against its motion and leaves through faces
/// whose normals point along it: the normals of two triangles that meet tell whether the pair can only raise the slope
/// or only lower it. So from either end of the interval to a point inside the slope rises by at most the area of the
/// triangles that take part in a raising pair in between, and falls likewise. A face parallel to the ray is neither
/// entered nor left through.
///
/// Holds for meshes that do not intersect themselves.
class SlopeBounds {
 public:
  /// Parts of an interval, each with bounds of its own.
  static constexpr std::size_t k_parts = 32;

  /// @param a_count, b_count numbers of triangles
  SlopeBounds(std::size_t a_count, std::size_t b_count) : a_(a_count), b_(b_count) {}

  /// @param swept candidates of a displacement that contains the interval
  /// @param areas_a, areas_b area vectors of all triangles in tree order, in each mesh's own frame
  /// @param outwards_A, outwards_B direction from which B comes (unit), in each mesh's frame
  /// @param first, last outer and inner end of the interval as fractions of the displacement
  /// @param outer_slope, inner_slope slopes there
  std::array<SlopeRange, k_parts> bound(const SweptCandidates& swept, std::span<const Eigen::Vector3d> areas_a,
                                        std::span<const Eigen::Vector3d> areas_b, const Eigen::Vector3d& outwards_A,
                                        const Eigen::Vector3d& outwards_B, double first, double last,
                                        double outer_slope, double inner_slope);

 private:
  using Areas = std::array<double, k_parts>;

  /// Upper bounds on how much pairs change the slope, for each part: from the outer end of the interval to any point of
  /// the part, and from there to the inner end.
  struct SlopeChange {
    Areas raised_since_outer{}, raised_until_inner{};
    Areas lowered_since_outer{}, lowered_until_inner{};
    void accumulate();
  };

  /// The parts from the first to the last; empty if first > last.
  struct PartRange {
    std::uint8_t first, last;
    static constexpr PartRange none() { return {k_parts, 0}; }
    bool any() const { return first <= last; }
  };

  struct TriangleContacts {
    float area;  ///< Projected.
    std::uint32_t round = 0;
    PartRange raising, lowering;  ///< Where pairs of either kind may meet.
    std::int8_t side;             ///< 1: the normal points outwards, -1: inwards; 0: the face is parallel to the ray.
  };

  /// The triangles of one mesh that may meet a triangle of the other.
  class Contacts {
   public:
    explicit Contacts(std::size_t count) : contacts_(count) {}
    void clear();
    TriangleContacts& of(std::uint32_t triangle, std::span<const Eigen::Vector3d> areas,
                         const Eigen::Vector3d& outwards);
    SlopeChange change() const;

   private:
    std::vector<TriangleContacts> contacts_;  ///< Of all triangles; valid if their round is the current one.
    std::vector<std::uint32_t> touched_;      ///< Triangles whose round is the current one.
    std::uint32_t round_ = 0;
  };

  Contacts a_;
  Contacts b_;
};

}  // namespace sixdof
