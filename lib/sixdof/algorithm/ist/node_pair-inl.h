// Compiled once per instruction set: part of traversal.cpp, included by nothing else.
#if defined(SIXDOF_IST_NODE_PAIR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_IST_NODE_PAIR_INL_H_
#undef SIXDOF_IST_NODE_PAIR_INL_H_
#else
#define SIXDOF_IST_NODE_PAIR_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

#include <sixdof/algorithm/ist/node_pair.h>

// The 4 x 4 balls of a node of A and a node of B against each other, in lanes 4 i + j. No fused multiply-add is used,
// so every instruction set gives the same bits.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ist {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t k_slots = SphereNode::k_slots;
constexpr std::size_t k_pairs = k_slots * k_slots;
using Floats = hn::CappedTag<float, k_pairs>;
using Ints = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;
using I = hn::Vec<Ints>;
constexpr Floats k_floats;
constexpr Ints k_ints;

/// Tests balls of A's and B's nodes.
class NodePairTest {
 public:
  explicit HWY_INLINE NodePairTest(const NodePlacement& placement) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      for (Eigen::Index l = 0; l < 3; ++l) turn_[k][l] = hn::Set(k_floats, placement.turn(k, l));
      shift_[k] = hn::Set(k_floats, placement.shift[k]);
    }
    ratio_ = hn::Set(k_floats, placement.ratio);
    slack_ = hn::Set(k_floats, placement.slack);
  }

  /// Bit 4 i + j is set if ball i of `a` may overlap ball j of `b`; it is if they do.
  HWY_INLINE unsigned overlapping(const SphereNode& a, const SphereNode& b) const {
    unsigned bits = 0;
    for_each_part(a, b, [&](std::size_t l, F squared, F radii) HWY_ATTR {
      // Where a slot is empty, the sum of radii and its square with this sign are -infinity.
      const auto hit = hn::Le(squared, hn::Mul(radii, hn::Abs(radii)));
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(k_floats, hit, bytes);
      std::uint16_t part;
      std::memcpy(&part, bytes, sizeof part);
      bits |= (part & ((1u << hn::Lanes(k_floats)) - 1u)) << l;
    });
    return bits;
  }

 private:
  /// Calls part(lane, squared distances of the centres, sums of the radii and the slack) for the lanes from `lane` on.
  template <class Part>
  HWY_INLINE void for_each_part(const SphereNode& a, const SphereNode& b, const Part& part) const {
    for (std::size_t l = 0; l < k_pairs; l += hn::Lanes(k_floats)) {
      const F x = of_b(b.x, l), y = of_b(b.y, l), z = of_b(b.z, l);
      const auto moved = [&](std::size_t k) HWY_ATTR {
        const F turned = hn::Add(hn::Add(hn::Mul(turn_[k][0], x), hn::Mul(turn_[k][1], y)), hn::Mul(turn_[k][2], z));
        return hn::Add(turned, shift_[k]);
      };
      const F dx = hn::Sub(moved(0), of_a(a.x, l)), dy = hn::Sub(moved(1), of_a(a.y, l)),
              dz = hn::Sub(moved(2), of_a(a.z, l));
      const F squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      const F radius_b = hn::Add(hn::Mul(of_b(b.r, l), ratio_), slack_);
      part(l, squared, hn::Add(radius_b, of_a(a.r, l)));
    }
  }

  using Row = std::array<float, k_slots>;
  static constexpr bool k_whole_rows = hn::MaxLanes(k_floats) >= k_slots;  // else one lane at a time
  /// Slot (lane / 4) for the lanes from l on.
  static HWY_INLINE F of_a(const Row& row, std::size_t l) {
    if constexpr (k_whole_rows) {
      const I slot = hn::ShiftRight<2>(hn::Iota(k_ints, static_cast<std::int32_t>(l)));
      return hn::TableLookupLanes(hn::LoadDup128(k_floats, row.data()), hn::IndicesFromVec(k_floats, slot));
    } else {
      return hn::Set(k_floats, row[l / k_slots]);
    }
  }
  /// Slot (lane % 4) for the lanes from l on.
  static HWY_INLINE F of_b(const Row& row, std::size_t l) {
    if constexpr (k_whole_rows) {
      return hn::LoadDup128(k_floats, row.data());
    } else {
      return hn::Set(k_floats, row[l % k_slots]);
    }
  }

  F turn_[3][3], shift_[3], ratio_, slack_;
};

/// Gaps between balls of A's and B's nodes, in double precision: far apart, single precision could not tell them apart.
class NodePairGaps {
 public:
  NodePairGaps(const SphereTree& a, const SphereTree& b, const Pose& X_AB)
      : unit_a_(a.bound.radius),
        unit_b_(b.bound.radius),
        turn_(b.bound.radius * X_AB.R),
        shift_(X_AB * b.bound.center - a.bound.center) {}

  /// Writes the gap (distance of centres minus both radii) of ball i of `a` to ball j of `b` to out[4 i + j], in the
  /// meshes' length unit; +infinity where a slot is empty. A lower bound of the gaps of the leaves below: balls are
  /// rounded up by far more than what is rounded here.
  /// @return bit 4 i + j is set if the gap is smaller than `within`.
  HWY_INLINE unsigned measure(const SphereNode& a, const SphereNode& b, double within, double* out) const {
    const Doubles d;
    unsigned bits = 0;
    for (std::size_t l = 0; l < k_slots; l += hn::Lanes(d)) {
      const auto row = [&](const std::array<float, k_slots>& values) HWY_ATTR {
        return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, Doubles>(), values.data() + l));
      };
      const auto x = row(b.x), y = row(b.y), z = row(b.z), r = hn::Mul(row(b.r), hn::Set(d, unit_b_));
      const auto moved = [&](Eigen::Index k) HWY_ATTR {
        const auto turned = hn::Add(hn::Add(hn::Mul(hn::Set(d, turn_(k, 0)), x), hn::Mul(hn::Set(d, turn_(k, 1)), y)),
                                    hn::Mul(hn::Set(d, turn_(k, 2)), z));
        return hn::Add(turned, hn::Set(d, shift_[k]));
      };
      const auto bx = moved(0), by = moved(1), bz = moved(2);
      for (std::size_t i = 0; i < k_slots; ++i) {
        const auto of_a = [&](float value) HWY_ATTR { return hn::Set(d, unit_a_ * static_cast<double>(value)); };
        const auto dx = hn::Sub(bx, of_a(a.x[i])), dy = hn::Sub(by, of_a(a.y[i])), dz = hn::Sub(bz, of_a(a.z[i]));
        const auto squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
        const auto gap = hn::Sub(hn::Sqrt(squared), hn::Add(r, of_a(a.r[i])));
        hn::StoreU(gap, d, out + k_slots * i + l);
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(d, hn::Lt(gap, hn::Set(d, within)), bytes);
        bits |= (bytes[0] & ((1u << hn::Lanes(d)) - 1u)) << (k_slots * i + l);
      }
    }
    return bits;
  }

 private:
  using Doubles = hn::CappedTag<double, k_slots>;
  double unit_a_, unit_b_;
  Eigen::Matrix3d turn_;
  Eigen::Vector3d shift_;
};

/// What lies below a pair of nodes: pairs of nodes, or of leaves if both are nodes of leaves. Where only one of them
/// is, it is met again with each child of the other that one of its leaves may overlap.
///
/// Written without branches, which would be as unforeseeable as the shapes of the trees.
struct Descent {
  std::int32_t first_a, first_b;    ///< Node or leaf of the first slot.
  std::int32_t others_a, others_b;  ///< All bits: the other slots' follow; 0: it is the node itself, for all slots.
  unsigned pairs;                   ///< Bits 4 i + j as NodePairTest's.
  bool leaves;                      ///< Pairs of leaves.

  /// @param below_a, below_b SphereTree::below of the two nodes
  HWY_INLINE Descent(std::int32_t node_a, std::int32_t below_a, std::int32_t node_b, std::int32_t below_b,
                     unsigned overlapping) {
    const std::int32_t leaves_a = below_a >> 31, leaves_b = below_b >> 31;  // all bits or none
    const std::int32_t stays_a = leaves_a & ~leaves_b, stays_b = leaves_b & ~leaves_a;
    leaves = (leaves_a & leaves_b) != 0;
    first_a = (node_a & stays_a) | ((below_a ^ leaves_a) & ~stays_a);
    first_b = (node_b & stays_b) | ((below_b ^ leaves_b) & ~stays_b);
    others_a = ~stays_a;
    others_b = ~stays_b;
    const unsigned o = overlapping;
    const unsigned any_of_a = (o | o >> 4 | o >> 8 | o >> 12) & 0x000fu,
                   any_of_b = (o | o >> 1 | o >> 2 | o >> 3) & 0x1111u;
    pairs = (any_of_a & static_cast<unsigned>(stays_a)) | (any_of_b & static_cast<unsigned>(stays_b)) |
            (o & static_cast<unsigned>(~(stays_a | stays_b)));
  }

  std::int32_t in_a(unsigned pair) const { return first_a + (others_a & static_cast<std::int32_t>(pair / k_slots)); }
  std::int32_t in_b(unsigned pair) const { return first_b + (others_b & static_cast<std::int32_t>(pair % k_slots)); }

  /// The least of the gaps (of NodePairGaps) that this pair stands for: its own, or those of all leaves of a node that
  /// is met again.
  double least(const double* gap, unsigned pair) const {
    const unsigned step = others_a == 0 ? k_slots : 1,
                   end = others_a != 0 && others_b != 0 ? pair + 1 : pair + 4 * step;
    double result = gap[pair];
    for (unsigned i = pair; i < end; i += step) result = std::min(result, gap[i]);
    return result;
  }

  /// Writes the pairs' members, and up to k_pairs numbers without meaning behind them. @return how many pairs there
  /// are.
  HWY_INLINE std::size_t write(std::int32_t* out_a, std::int32_t* out_b) const {
    const I mask_a = hn::Set(k_ints, others_a), mask_b = hn::Set(k_ints, others_b);
    const I from_a = hn::Set(k_ints, first_a), from_b = hn::Set(k_ints, first_b);
    std::size_t count = 0;
    for (std::size_t l = 0; l < k_pairs; l += hn::Lanes(k_ints)) {
      const I lane = hn::Iota(k_ints, static_cast<std::int32_t>(l));
      const I slot_a = hn::ShiftRight<2>(lane), slot_b = hn::And(lane, hn::Set(k_ints, 3));
      const unsigned part = pairs >> l & ((1u << hn::Lanes(k_ints)) - 1u);
      const std::uint64_t word = part;
      std::uint8_t bytes[8];
      std::memcpy(bytes, &word, sizeof bytes);
      const auto mask = hn::LoadMaskBits(k_ints, bytes);
      hn::StoreU(hn::Compress(hn::Add(from_a, hn::And(slot_a, mask_a)), mask), k_ints, out_a + count);
      hn::StoreU(hn::Compress(hn::Add(from_b, hn::And(slot_b, mask_b)), mask), k_ints, out_b + count);
      count += static_cast<std::size_t>(__builtin_popcount(part));
    }
    return count;
  }
};

/// The end of a list, where pairs are appended.
struct ListEnd {
  PairList& list;
  std::size_t& size;
};

/// Tests pairs of nodes of two trees.
class NodePairs {
 public:
  HWY_INLINE NodePairs(const SphereTree& a, const SphereTree& b, const NodePlacement& placement)
      : a_(a), b_(b), test_(placement) {}

  HWY_INLINE Descent descend(std::int32_t a, std::int32_t b) const {
    return {a, a_.below[a], b, b_.below[b], test_.overlapping(a_.nodes[a], b_.nodes[b])};
  }

  /// Appends what lies below `count` pairs of nodes, which both lists must have room for.
  /// @tparam k_ahead pairs between asking for nodes and testing them; 0: not at all. What stands in the columns that
  /// far behind the last pair is asked for too, whatever it is.
  template <std::size_t k_ahead>
  HWY_INLINE void descend_all(const std::int32_t* a, const std::int32_t* b, std::size_t count, ListEnd of_nodes,
                              ListEnd of_leaves) const {
    // Where the next pairs go, of nodes and of leaves: chosen by an index, since a branch could not be foreseen.
    std::int32_t* out_a[2] = {of_nodes.list.a.data() + of_nodes.size, of_leaves.list.a.data() + of_leaves.size};
    std::int32_t* out_b[2] = {of_nodes.list.b.data() + of_nodes.size, of_leaves.list.b.data() + of_leaves.size};
    for (std::size_t i = 0; i < count; ++i) {
      if constexpr (k_ahead > 0) {
        a_.prefetch(a[i + k_ahead]);
        b_.prefetch(b[i + k_ahead]);
      }
      const Descent below = descend(a[i], b[i]);
      const std::size_t kind = below.leaves ? 1 : 0, pairs = below.write(out_a[kind], out_b[kind]);
      out_a[kind] += pairs;
      out_b[kind] += pairs;
    }
    of_nodes.size = static_cast<std::size_t>(out_a[0] - of_nodes.list.a.data());
    of_leaves.size = static_cast<std::size_t>(out_a[1] - of_leaves.list.a.data());
  }

 private:
  struct Arrays {
    const SphereNode* nodes;
    const std::int32_t* below;
    explicit Arrays(const SphereTree& tree) : nodes(tree.nodes.data()), below(tree.below.data()) {}
    HWY_INLINE void prefetch(std::int32_t node) const {
      __builtin_prefetch(nodes + node);
      __builtin_prefetch(below + node);
    }
  };
  Arrays a_, b_;
  NodePairTest test_;
};

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ist
HWY_AFTER_NAMESPACE();

#endif
