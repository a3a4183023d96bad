// Compiled once per instruction set: part of traversal.cpp. It has no include guard.

#include <array>
#include <bit>
#include <cstring>

#include <hwy/highway.h>

#include <sixdof/algorithm/ist/traversal.h>
#include <sixdof/base/set_bits.h>

// Tests a node of A against a node of B: their 4 x 4 pairs of balls in lanes 4 i + j, i a slot of A's node and j one of
// B's. Products and sums are separate operations (no fused multiply-add), so all instruction sets round alike.

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

/// Overlap test of the balls of two nodes, in single precision.
class NodePairTest {
 public:
  explicit HWY_INLINE NodePairTest(const NodeTransform& transform) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      for (Eigen::Index l = 0; l < 3; ++l) rotation_[k][l] = hn::Set(k_floats, transform.rotation(k, l));
      translation_[k] = hn::Set(k_floats, transform.translation[k]);
    }
    ratio_ = hn::Set(k_floats, transform.ratio);
    slack_ = hn::Set(k_floats, transform.slack);
  }

  /// Sets bit 4 i + j if ball i of `a` overlaps ball j of `b`, and possibly where their gap is within the rounding.
  HWY_INLINE unsigned overlapping(const SphereNode& a, const SphereNode& b) const {
    unsigned bits = 0;
    for (std::size_t l = 0; l < k_pairs; l += hn::Lanes(k_floats)) {
      const F x = of_b(b.x, l), y = of_b(b.y, l), z = of_b(b.z, l);
      const auto transformed = [&](std::size_t k) HWY_ATTR {
        const F rotated =
            hn::Add(hn::Add(hn::Mul(rotation_[k][0], x), hn::Mul(rotation_[k][1], y)), hn::Mul(rotation_[k][2], z));
        return hn::Add(rotated, translation_[k]);
      };
      const F dx = hn::Sub(transformed(0), of_a(a.x, l)), dy = hn::Sub(transformed(1), of_a(a.y, l)),
              dz = hn::Sub(transformed(2), of_a(a.z, l));
      const F squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      const F radius_b = hn::Add(hn::Mul(of_b(b.r, l), ratio_), slack_);
      const F radii = hn::Add(radius_b, of_a(a.r, l));
      // In an empty slot the sum of radii, and its square with this sign, is -infinity.
      const auto hit = hn::Le(squared, hn::Mul(radii, hn::Abs(radii)));
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(k_floats, hit, bytes);
      std::uint16_t part;
      std::memcpy(&part, bytes, sizeof part);
      bits |= (part & ((1u << hn::Lanes(k_floats)) - 1u)) << l;
    }
    return bits;
  }

 private:
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

  F rotation_[3][3], translation_[3], ratio_, slack_;
};

/// Gaps between the balls of two nodes. In double precision: the rounding errors of single precision grow with
/// distance.
class NodePairGaps {
 public:
  NodePairGaps(const SphereTree& a, const SphereTree& b, const Pose& X_AB)
      : unit_a_(a.bound.radius),
        unit_b_(b.bound.radius),
        rotation_(b.bound.radius * X_AB.R),
        translation_(X_AB * b.bound.center - a.bound.center) {}

  /// Writes the gap (distance of centres minus both radii) of ball i of `a` to ball j of `b` to out[4 i + j], in the
  /// meshes' length unit; +infinity where a slot is empty. It is a lower bound of the gaps of the leaves below: balls
  /// are rounded up by far more than the rounding errors here.
  /// @return bit 4 i + j is set if the gap is smaller than `within`.
  HWY_INLINE unsigned measure(const SphereNode& a, const SphereNode& b, double within, double* out) const {
    const Doubles d;
    unsigned bits = 0;
    for (std::size_t l = 0; l < k_slots; l += hn::Lanes(d)) {
      const auto row = [&](const std::array<float, k_slots>& values) HWY_ATTR {
        return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, Doubles>(), values.data() + l));
      };
      const auto x = row(b.x), y = row(b.y), z = row(b.z), r = hn::Mul(row(b.r), hn::Set(d, unit_b_));
      const auto transformed = [&](Eigen::Index k) HWY_ATTR {
        const auto rotated =
            hn::Add(hn::Add(hn::Mul(hn::Set(d, rotation_(k, 0)), x), hn::Mul(hn::Set(d, rotation_(k, 1)), y)),
                    hn::Mul(hn::Set(d, rotation_(k, 2)), z));
        return hn::Add(rotated, hn::Set(d, translation_[k]));
      };
      const auto bx = transformed(0), by = transformed(1), bz = transformed(2);
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
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d translation_;
};

/// The pairs that replace an expanded pair of nodes. If both are nodes of inner nodes, or both nodes of leaves, these
/// are pairs of their children. If only one is a node of leaves, that node stays in the pair and the other one is
/// replaced by each of its children that overlaps one of the leaves.
///
/// Branchless: all bits of a mask are set, or none.
struct ChildPairs {
  std::int32_t first_a, first_b;          ///< Node or leaf of the first slot.
  std::int32_t slot_mask_a, slot_mask_b;  ///< 0 where the node stays in the pair: all slots are the node itself.
  unsigned pairs;                         ///< Bits 4 i + j as NodePairTest's.
  bool leaves;                            ///< Pairs of leaves.

  /// @param child_a, child_b SphereTree::first_child of the two nodes
  HWY_INLINE ChildPairs(std::int32_t node_a, std::int32_t child_a, std::int32_t node_b, std::int32_t child_b,
                        unsigned overlapping) {
    const std::int32_t leaves_a = child_a >> 31, leaves_b = child_b >> 31;  // masks
    const std::int32_t stays_a = leaves_a & ~leaves_b, stays_b = leaves_b & ~leaves_a;
    leaves = (leaves_a & leaves_b) != 0;
    first_a = (node_a & stays_a) | ((child_a ^ leaves_a) & ~stays_a);
    first_b = (node_b & stays_b) | ((child_b ^ leaves_b) & ~stays_b);
    slot_mask_a = ~stays_a;
    slot_mask_b = ~stays_b;
    const unsigned o = overlapping;
    const unsigned any_of_a = (o | o >> 4 | o >> 8 | o >> 12) & 0x000fu,
                   any_of_b = (o | o >> 1 | o >> 2 | o >> 3) & 0x1111u;
    pairs = (any_of_a & static_cast<unsigned>(stays_a)) | (any_of_b & static_cast<unsigned>(stays_b)) |
            (o & static_cast<unsigned>(~(stays_a | stays_b)));
  }

  std::int32_t in_a(unsigned pair) const { return first_a + (slot_mask_a & static_cast<std::int32_t>(pair / k_slots)); }
  std::int32_t in_b(unsigned pair) const { return first_b + (slot_mask_b & static_cast<std::int32_t>(pair % k_slots)); }
  bool a_stays() const { return slot_mask_a == 0; }
  bool b_stays() const { return slot_mask_b == 0; }

  /// The smallest of NodePairGaps' gaps that belong to this pair.
  double smallest_gap(const double* gap, unsigned pair) const {
    const unsigned step = a_stays() ? k_slots : 1, end = !a_stays() && !b_stays() ? pair + 1 : pair + 4 * step;
    double result = gap[pair];
    for (unsigned i = pair; i < end; i += step) result = std::min(result, gap[i]);
    return result;
  }

  /// Writes the members of the pairs, followed by up to k_pairs undefined values. @return the number of pairs
  HWY_INLINE std::size_t write(std::int32_t* out_a, std::int32_t* out_b) const {
    constexpr hn::CappedTag<std::int32_t, 8> d;  // as many as k_set_bits has
    constexpr hn::Rebind<std::uint8_t, decltype(d)> d_bytes;
    const auto set = [&](std::int32_t x) HWY_ATTR { return hn::Set(d, x); };
    std::size_t count = 0;
    for (std::size_t l = 0; l < k_pairs; l += hn::Lanes(d)) {
      const unsigned part = pairs >> l & ((1u << hn::Lanes(d)) - 1u);
      const auto bits = hn::PromoteTo(d, hn::LoadU(d_bytes, k_set_bits[part].data()));
      const auto lane = hn::Add(bits, set(static_cast<std::int32_t>(l)));
      const auto slot_a = hn::ShiftRight<2>(lane), slot_b = hn::And(lane, set(3));
      hn::StoreU(hn::Add(set(first_a), hn::And(slot_a, set(slot_mask_a))), d, out_a + count);
      hn::StoreU(hn::Add(set(first_b), hn::And(slot_b, set(slot_mask_b))), d, out_b + count);
      count += static_cast<std::size_t>(std::popcount(part));
    }
    return count;
  }
};

struct ListEnd {
  PairList& list;
  std::size_t& size;
};

/// Expands pairs of nodes of two trees into the pairs of children that overlap.
class NodePairExpansion {
 public:
  HWY_INLINE NodePairExpansion(const SphereTree& a, const SphereTree& b, const NodeTransform& transform)
      : a_(a), b_(b), test_(transform) {}

  HWY_INLINE ChildPairs expand(std::int32_t a, std::int32_t b) const {
    return {a, a_.first_child[a], b, b_.first_child[b], test_.overlapping(a_.nodes[a], b_.nodes[b])};
  }

  /// Expands `count` pairs and appends the results. Both lists must have room for them.
  /// @tparam k_ahead nodes are prefetched so many pairs ahead; the columns must be readable that far beyond the last
  template <std::size_t k_ahead>
  HWY_INLINE void expand_all(const std::int32_t* a, const std::int32_t* b, std::size_t count, ListEnd of_nodes,
                             ListEnd of_leaves) const {
    // Ends of the two lists, selected by an index instead of an unpredictable branch.
    std::int32_t* out_a[2] = {of_nodes.list.a.data() + of_nodes.size, of_leaves.list.a.data() + of_leaves.size};
    std::int32_t* out_b[2] = {of_nodes.list.b.data() + of_nodes.size, of_leaves.list.b.data() + of_leaves.size};
    for (std::size_t i = 0; i < count; ++i) {
      if constexpr (k_ahead > 0) {
        a_.prefetch(a[i + k_ahead]);
        b_.prefetch(b[i + k_ahead]);
      }
      const ChildPairs children = expand(a[i], b[i]);
      const std::size_t kind = children.leaves ? 1 : 0, pairs = children.write(out_a[kind], out_b[kind]);
      out_a[kind] += pairs;
      out_b[kind] += pairs;
    }
    of_nodes.size = static_cast<std::size_t>(out_a[0] - of_nodes.list.a.data());
    of_leaves.size = static_cast<std::size_t>(out_a[1] - of_leaves.list.a.data());
  }

 private:
  struct Arrays {
    const SphereNode* nodes;
    const std::int32_t* first_child;
    explicit Arrays(const SphereTree& tree) : nodes(tree.nodes.data()), first_child(tree.first_child.data()) {}
    HWY_INLINE void prefetch(std::int32_t node) const {
      __builtin_prefetch(nodes + node);
      __builtin_prefetch(first_child + node);
    }
  };
  Arrays a_, b_;
  NodePairTest test_;
};

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ist
HWY_AFTER_NAMESPACE();
