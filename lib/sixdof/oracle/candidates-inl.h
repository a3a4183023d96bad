// Compiled once per instruction set: part of candidates.cpp and swept_candidates.cpp, included by nothing else.
#if defined(SIXDOF_ORACLE_CANDIDATES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_ORACLE_CANDIDATES_INL_H_
#undef SIXDOF_ORACLE_CANDIDATES_INL_H_
#else
#define SIXDOF_ORACLE_CANDIDATES_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/candidates_bounds-inl.h>
#include <sixdof/oracle/candidates_leaf-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

/// Depth-first traversal of pairs of nodes. All 8 x 8 pairs of children of two nodes are tested together. The order of
/// the pairs found is that of the trees.
/// @tparam moving the displacement is not zero
/// @tparam Test called as test(leaf of A, its lanes, leaf of B, its lanes) for leaves that may intersect
template <bool moving, class Test>
class DualTreeTraversal {
 public:
  DualTreeTraversal(const Tree& a, const Tree& b, const TreeMotion& motion, Test test)
      : a_(a), b_(b), motion_(motion), test_(test) {}

  void run() { expand(0, 0, ~0u, ~0u); }

 private:
  /// Expands all pairs of the given children (bits) of two nodes.
  void expand(std::uint32_t index_a, std::uint32_t index_b, std::uint32_t lanes_a, std::uint32_t lanes_b) {
    const Tree::Node& node_a = a_.nodes()[index_a];
    const Tree::Node& node_b = b_.nodes()[index_b];
    std::uint32_t overlapping[k_width] = {};  // children of A, for each child of B
    std::uint32_t leaves_a = 0;
    {
      Children children_a, children_b;
      load_children<false>(node_a, motion_, children_a);
      load_children<true>(node_b, motion_, children_b);
      lanes_a &= (1u << node_a.child_count) - 1;
      lanes_b &= (1u << node_b.child_count) - 1;
      for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(rest));
        overlapping[j] = overlapping_children<moving>(children_a, node_a, children_b, j, motion_) & lanes_a;
      }
    }
    for (std::size_t i = 0; i < node_a.child_count; ++i) {
      if (node_a.child[i].is_leaf()) leaves_a |= 1u << i;
    }
    test_leaves(node_a, node_b, leaves_a, lanes_b, overlapping);
    for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      const Tree::Child child_b = node_b.child[j];
      for (std::uint32_t m = child_b.is_leaf() ? overlapping[j] & ~leaves_a : overlapping[j]; m != 0; m &= m - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(m));
        const Tree::Child child_a = node_a.child[i];
        if (child_b.is_leaf()) {
          expand(child_a.node(), index_b, ~0u, 1u << j);
        } else if (child_a.is_leaf()) {
          expand(index_a, child_b.node(), 1u << i, ~0u);
        } else {
          expand(child_a.node(), child_b.node(), ~0u, ~0u);
        }
      }
    }
  }

  HWY_NOINLINE void test_leaves(const Tree::Node& node_a, const Tree::Node& node_b, std::uint32_t leaves_a,
                                std::uint32_t lanes_b, const std::uint32_t* overlapping) {
    LeafLanes of_a[k_width], of_b;
    std::uint32_t loaded = 0;
    for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      const Tree::Child leaf_b = node_b.child[j];
      if (!leaf_b.is_leaf() || (overlapping[j] & leaves_a) == 0) continue;
      load_leaf_of_b(b_.leaves()[node_b.leaf[j]], motion_, of_b);
      std::uint32_t left = overlapping[j] & leaves_a;
      if constexpr (moving) left &= overlapping_boxes(node_a, of_b, motion_);
      for (std::uint32_t m = left; m != 0; m &= m - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(m));
        const Tree::Child leaf_a = node_a.child[i];
        if ((loaded & 1u << i) == 0) load_leaf_of_a(a_.leaves()[node_a.leaf[i]], of_a[i]);
        loaded |= 1u << i;
        test_(leaf_a, of_a[i], leaf_b, of_b);
      }
    }
  }

  const Tree& a_;
  const Tree& b_;
  const TreeMotion& motion_;
  Test test_;
};

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();

#endif
