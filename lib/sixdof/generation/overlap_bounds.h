#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/candidates.h>

namespace sixdof {

/// An upper bound on the overlap volume of two bodies over all translations, from their boxes alone (length^3).
///
/// The volume is at most the distance of two opposite faces of one body's box times the area of the largest section of
/// the other body's box by a plane with their normal n. Projected onto the face of that box normal to its axis i, a
/// section's area is multiplied by |n_i|, so it is at most e_j e_k / |n_i| for each i, with the edges e. Nor is the
/// overlap larger than either box. Crossing plates attain the bound, far below either volume.
///
/// @param size_a, size_b edges of the bodies' boxes, each in its own frame
/// @param R_AB rotates directions from B's frame to A's
double overlap_upper_bound(const Eigen::Vector3d& size_a, const Eigen::Vector3d& size_b, const Eigen::Matrix3d& R_AB);

/// The overlap V at translation s.
struct OverlapMeasurement {
  double s = 0.0;
  double volume = 0.0;
  double slope = 0.0;      ///< -dV/ds
  double curvature = 0.0;  ///< d2V/ds2; approximate
};

/// Bounds on the slope: the derivative of the volume by the displacement inwards, -dV/ds.
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

/// Bounds on how fast an overlap volume can change while B moves towards A along a ray, between two measurements.
///
/// The slope is the area (projected along the ray) of B's leading faces inside A less that of B's trailing faces inside
/// A; the same holds with A and B exchanged. A triangle that does not touch the other surface stays inside or outside.
/// The normals of two triangles that meet tell whether one enters or leaves, so whether the pair can only raise the
/// slope or only lower it. From either end of the interval to a point inside, the slope rises by at most the area of
/// the triangles that take part in a raising pair in between, and falls likewise. A face parallel to the ray is neither
/// entered nor left through. A pair of leaves stands for the pairs of their triangles.
///
/// Holds for meshes that do not intersect themselves.
class SlopeBounds {
 public:
  /// Parts of an interval, each with bounds of its own.
  static constexpr std::size_t k_parts = 32;

  /// What the bounds need of a mesh.
  enum class Items {
    leaves,
    triangles
  };

  /// @param areas_a, areas_b area vectors of all triangles in tree order, in each mesh's own frame; all outlive this
  SlopeBounds(Items items, const Tree& tree_a, std::span<const Eigen::Vector3d> areas_a, const Tree& tree_b,
              std::span<const Eigen::Vector3d> areas_b)
      : a_(items, tree_a, areas_a), b_(items, tree_b, areas_b) {}

  /// @param swept pairs of items, of a displacement that contains the interval
  /// @param outwards_A, outwards_B direction from which B comes (unit), in each mesh's frame
  /// @param first, last outer and inner end of the interval as fractions of the displacement
  /// @param outer_slope, inner_slope slopes there
  std::array<SlopeRange, k_parts> bound(std::span<const SweptPair> swept, const Eigen::Vector3d& outwards_A,
                                        const Eigen::Vector3d& outwards_B, double first, double last,
                                        double outer_slope, double inner_slope);

 private:
  using Areas = std::array<double, k_parts>;

  /// Upper bounds on how much pairs change the slope, for each part: from the outer end of the interval to any point of
  /// the part, and from there to the inner end.
  struct SlopeChange {
    Areas raised_since_outer{}, raised_until_inner{};
    Areas lowered_since_outer{}, lowered_until_inner{};
  };

  /// The parts from the first to the last; empty if first > last.
  struct PartRange {
    std::uint8_t first, last;
    static constexpr PartRange none() { return {k_parts, 0}; }
    bool any() const { return first <= last; }
    void extend(const PartRange& by) { *this = {std::min(first, by.first), std::max(last, by.last)}; }
  };

  /// Of an item: 0 its triangles that look outwards, 1 those that look inwards.
  struct Side {
    float area;                   ///< Projected.
    PartRange raising, lowering;  ///< Where pairs of either kind may meet.
  };
  struct ItemContacts {
    std::uint32_t ray = 0;    ///< The areas are those of this ray.
    std::uint32_t round = 0;  ///< The parts are those of this call of bound().
    std::uint32_t sides = 0;  ///< Bits of the sides that have an area.
    Side side[2];
  };

  /// The items of one mesh that may meet one of the other.
  class Contacts {
   public:
    Contacts(Items items, const Tree& tree, std::span<const Eigen::Vector3d> areas)
        : leaves_(items == Items::leaves ? tree.leaves() : std::span<const Tree::Leaf>()),
          areas_(areas),
          contacts_(items == Items::leaves ? leaves_.size() : areas.size()) {}
    /// @param outwards in the mesh's frame
    void start(const Eigen::Vector3d& outwards);
    ItemContacts& of(std::uint32_t item);
    SlopeChange change() const;

   private:
    std::span<const Eigen::Vector3d> areas_of(std::uint32_t item) const;

    std::span<const Tree::Leaf> leaves_;  ///< Empty if the items are triangles.
    std::span<const Eigen::Vector3d> areas_;
    std::vector<ItemContacts> contacts_;  ///< Of all items.
    std::vector<std::uint32_t> touched_;  ///< Items whose round is the current one.
    Eigen::Vector3d outwards_ = Eigen::Vector3d::Zero();
    std::uint32_t ray_ = 0, round_ = 0;
  };

  Contacts a_;
  Contacts b_;
};

}  // namespace sixdof
