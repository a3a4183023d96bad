#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <sixdof/generation/ray_cast_front.h>
#include <sixdof/generation/ray_cast_ties.h>
#include <sixdof/generation/ray_cast_tree.h>

/// The branch and bound of the ray cast. Internal: use ray_cast.h.
namespace sixdof::ray_cast {

/// A pair of triangles in tree order.
struct CastPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

/// What casts looked at.
struct CastCounts {
  std::uint64_t nodes = 0;       ///< Nodes whose children were bounded against a volume.
  std::uint64_t leaf_pairs = 0;  ///< Pairs of leaves whose triangles were bounded.
  std::uint64_t offers = 0;      ///< Pairs of triangles that came up for exact distances.
  std::uint64_t distances = 0;   ///< Exact distances of two triangles.
  std::uint64_t supports = 0;    ///< Triangles and volumes whose height along an axis was found (CastTies).

  /// All of them, in units of some 25 ns: within a factor of 1.5 of the time of nearly all rays (fitted to rays of
  /// eight bodies of 2,000 to 100,000 triangles, each with itself).
  std::uint64_t work() const { return 5 * nodes + 6 * leaf_pairs + offers + 11 * distances + supports / 4; }
};

/// One ray: B stands at `translation` along `direction` from where the centres of the boxes agree.
///
/// Trees are in A's axes, A's mirrored in its centre, so that everything is a sum: the difference b - a of a point b of
/// B and a of A is a point of the one tree plus a point of the other plus translation * direction.
struct Cast {
  Cast(const CastTree& tree_a, const CastTree& tree_b)
      : a(tree_a), b(tree_b), face_ties(tree_a, tree_b), ties(tree_a, tree_b) {}

  /// After a tree was turned.
  void forget_rotation() {
    face.clear();
    face_ties.clear();
    ties.clear();
    front.clear();
  }

  const CastTree& a;
  const CastTree& b;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  double target = 0.0;
  /// The largest translation found so far at which a pair of triangles is `target` apart; in the beginning the least that is of
  /// interest.
  double translations = 0.0;
  std::optional<CastPair> pair;                     ///< The pair that is.
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< Unit vector from A to B between the pair's closest points.
  /// Unit vector along which the last pair that was turned down is apart by the target, up to a tie.
  Eigen::Vector3d apart_axis = Eigen::Vector3d::UnitX();
  CastCounts counts;
  /// What wider targets taught about this ray. To be cleared when the direction changed.
  CastFront front;
  CastFace face;       ///< Of A or B, over one of the other.
  CastTies face_ties;  ///< Along its normal.
  CastTies ties;       ///< Along apart_axis.

  /// Lengths that errors are relative to.
  double size() const { return a.radius() + b.radius() + target; }
};

/// Errors of exact distances and their use, in units of Cast::size(): pairs that would raise the translation's distance by
/// less are as good as the pair that is there already. So of many faces that tie only the first is looked into.
constexpr double k_cast_tie = 1e-14;

/// Takes a pair of triangles if it raises the translation. Returns whether it did.
bool offer_pair(Cast& cast, CastPair pair);

/// Finds the pair of triangles with the largest translation above cast.translation. After a wider target on the same ray, whose work
/// is in cast.front, it takes a fraction of the time. Every instruction set does the same floating
/// point operations in the same order, so that all find the same pair.
void find_first_hit(Cast& cast);

}  // namespace sixdof::ray_cast
