#include <sixdof/oracle/candidates.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/candidates.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/candidates_bounds-inl.h>
#include <sixdof/oracle/close_search.h>
#include <sixdof/oracle/triangle_pairs-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

namespace leaves = triangle_pairs::HWY_NAMESPACE;
using leaves::LeafCache;
using leaves::LeafLanes;

/// Square of a box's diagonal.
HWY_INLINE float size_of(const Tree::Volume& v) {
  const float x = v.upper[0] - v.lower[0];
  const float y = v.upper[1] - v.lower[1];
  const float z = v.upper[2] - v.lower[2];
  return x * x + y * y + z * z;
}

/// Nodes smaller than this many times the slack are tested in doubles: floats would not separate most of their
/// children.
constexpr float k_blurred = 64.0f;

/// Tests in doubles, for volumes that are small next to the rounding of floats. They hold for all fractions of the
/// displacement: B is taken at half of it, and has to be farther away than half of it.
class CloseTests {
 public:
  CloseTests(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement, float slack)
      : bounds_(a, b, {X_AB.R, X_AB.t + 0.5 * displacement}),
        half_displacement_((0.5 + 1e-14) * displacement.norm()),  // with the rounding of positions on the way
        blurred_(k_blurred * k_blurred * slack * slack) {}

  bool are_due(const Tree::Node& a, const Tree::Node& b) const {
    return std::max(size_of(a.volume), size_of(b.volume)) < blurred_;
  }

  /// Children of A's node (bits), of those in `lanes`, that may intersect child j of B's node.
  std::uint32_t overlapping_children(const Tree::Node& node_a, std::uint32_t lanes, const Tree::Node& node_b,
                                     std::size_t j) const {
    const detail::CloseShape shape_b = bounds_.shape_of_b(detail::CloseVolume::child_of(node_b, j));
    std::uint32_t bits = 0;
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(lanes));
      if (!apart(bounds_.shape_of_a(detail::CloseVolume::child_of(node_a, i)), shape_b)) bits |= 1u << i;
    }
    return bits;
  }

  bool apart(TrianglePair pair) const {
    return apart(bounds_.shape_of_a({0, pair.a}), bounds_.shape_of_b({0, pair.b}));
  }

 private:
  bool apart(const detail::CloseShape& a, const detail::CloseShape& b) const {
    return bounds_.lower_bound(a, b, Eigen::Vector3d::Zero(), half_displacement_) > half_displacement_;
  }

  detail::CloseBounds bounds_;
  double half_displacement_;
  float blurred_;  // square of a diagonal
};

/// Axes across two boxes, and across two triangles: instead of cross(), once or, along a displacement, often.
constexpr detail::CrossAxesUse k_use_of_cross_axes(0.3);
constexpr detail::CrossAxesUse k_use_of_cross_edges(0.9);
constexpr detail::CrossAxesUse k_use_of_moving_cross_edges(0.5);

/// Depth-first traversal of pairs of nodes. All 8 x 8 pairs of children of two nodes are tested together. Pairs wait
/// on a stack, and those of leaves in a queue, while their memory is fetched. Which of two pairs is found first depends
/// on the trees alone, not on which others are found: sums over them have the same bits whatever was pruned.
/// @tparam moving the displacement is not zero
/// @tparam Test called as test(leaf of A, its lanes, leaf of B, its lanes, whether floats blur them) for leaves that
/// may intersect
template <bool moving, class Test>
class DualTreeTraversal {
 public:
  DualTreeTraversal(const Tree& a, const Tree& b, const Pose& X_AB, const TreeMotion& motion, const CloseTests& close,
                    CandidateScratch& scratch, Test test)
      : a_(a),
        b_(b),
        motion_(motion),
        close_(close),
        R_AB_(X_AB.R),
        stack_(scratch.nodes),
        queue_(scratch.leaves),
        leaves_a_(a),
        leaves_b_(b),
        test_(test) {}

  void run() {
    queue_.clear();
    stack_.assign(1, {0, 0, k_all, k_all});
    while (!stack_.empty()) {
      const NodePair pair = stack_.back();
      stack_.pop_back();
      expand(pair);
      if (queue_.size() >= 2 * k_ahead) test_leaves(queue_.size() - k_ahead);
    }
    test_leaves(queue_.size());
  }

 private:
  static constexpr std::uint8_t k_all = 0xff;
  static constexpr std::size_t k_ahead = 8;  // pairs of leaves that wait while their memory is fetched
  static constexpr std::uint32_t k_none = ~0u;

  using NodePair = CandidateScratch::NodePair;
  using LeafPair = CandidateScratch::LeafPair;

  void expand(const NodePair& pair) {
    const Tree::Node& node_a = a_.nodes()[pair.a];
    const Tree::Node& node_b = b_.nodes()[pair.b];
    std::uint32_t overlapping[k_width] = {};  // children of A, for each child of B
    const std::uint32_t lanes_a = pair.lanes_a & ((1u << node_a.child_count) - 1);
    std::uint32_t lanes_b = pair.lanes_b & ((1u << node_b.child_count) - 1);
    const bool blurred = close_.are_due(node_a, node_b);
    if (blurred) {
      for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(rest));
        overlapping[j] = close_.overlapping_children(node_a, lanes_a, node_b, j);
      }
    } else {
      load(pair);
      lanes_b &= overlapping_node(children_b_, node_a, lanes_a);
      for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(rest));
        overlapping[j] = overlapping_children<moving>(children_a_, node_a, children_b_, j, motion_) & lanes_a;
      }
      if (use_of_cross_axes_.is_due()) ask_cross_axes(lanes_b, overlapping);
    }
    for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      for (std::uint32_t m = overlapping[j]; m != 0; m &= m - 1) {
        descend(pair, node_a, static_cast<std::size_t>(std::countr_zero(m)), node_b, j, blurred);
      }
    }
  }

  /// To child i of A's node and child j of B's.
  HWY_INLINE void descend(const NodePair& pair, const Tree::Node& node_a, std::size_t i, const Tree::Node& node_b,
                          std::size_t j, bool blurred) {
    const Tree::Child a = node_a.child[i], b = node_b.child[j];
    if (a.is_leaf() && b.is_leaf()) {
      queue_.push_back({node_a.leaf[i], node_b.leaf[j], blurred});
      prefetch(a_.leaves()[node_a.leaf[i]]);
      prefetch(b_.leaves()[node_b.leaf[j]]);
      return;
    }
    NodePair next = pair;
    next.lanes_a = a.is_leaf() ? static_cast<std::uint8_t>(1u << i) : k_all;
    next.lanes_b = b.is_leaf() ? static_cast<std::uint8_t>(1u << j) : k_all;
    if (!a.is_leaf()) prefetch(a_.nodes()[next.a = a.node()]);
    if (!b.is_leaf()) prefetch(b_.nodes()[next.b = b.node()]);
    stack_.push_back(next);
  }

  /// The volumes of the children of both nodes, unless they are those of the last pair.
  HWY_INLINE void load(const NodePair& pair) {
    if (pair.a != loaded_a_) load_children<false>(a_.nodes()[loaded_a_ = pair.a], motion_, children_a_);
    if (pair.b != loaded_b_) load_children<true>(b_.nodes()[loaded_b_ = pair.b], motion_, children_b_);
  }

  HWY_NOINLINE void ask_cross_axes(std::uint32_t lanes_b, std::uint32_t* overlapping) {
    if (!cross_axes_) cross_axes_.emplace(R_AB_);
    for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      if (overlapping[j] == 0) continue;
      const int before = std::popcount(overlapping[j]);
      overlapping[j] = overlapping_across_axes(children_a_, children_b_, j, overlapping[j], *cross_axes_, motion_);
      use_of_cross_axes_.count(before, std::popcount(overlapping[j]));
    }
  }

  /// Tests the first pairs of the queue.
  HWY_NOINLINE void test_leaves(std::size_t count) {
    for (const LeafPair& pair : std::span(queue_).first(count)) {
      const LeafLanes& of_b = leaves_b_.get(
          pair.b, [&](const Tree::Leaf& leaf, LeafLanes& out) { leaves::load_leaf_of_b(leaf, motion_, out); });
      const LeafLanes& of_a = leaves_a_.get(pair.a, leaves::load_leaf_of_a);
      test_(a_.leaves()[pair.a].child, of_a, b_.leaves()[pair.b].child, of_b, pair.blurred);
    }
    queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(count));
  }

  const Tree& a_;
  const Tree& b_;
  const TreeMotion& motion_;
  const CloseTests& close_;
  const Eigen::Matrix3d& R_AB_;
  std::vector<NodePair>& stack_;
  std::vector<LeafPair>& queue_;
  Children children_a_, children_b_;
  std::uint32_t loaded_a_ = k_none, loaded_b_ = k_none;
  LeafCache leaves_a_, leaves_b_;
  std::optional<detail::CrossAxes> cross_axes_;  // made when they are asked for the first time
  detail::CrossAxesUse use_of_cross_axes_ = k_use_of_cross_axes;
  Test test_;
};

void find_candidates(const Tree& a, const Tree& b, const Pose& X_AB, CandidateScratch& scratch,
                     std::vector<TrianglePair>& pairs) {
  const TreeMotion motion(a, b, X_AB, Eigen::Vector3d::Zero());
  const CloseTests close(a, b, X_AB, Eigen::Vector3d::Zero(), motion.slack);
  detail::CrossAxesUse use_of_cross_edges = k_use_of_cross_edges;
  const auto test = [&](Tree::Child leaf_a, const LeafLanes& of_a, Tree::Child leaf_b, const LeafLanes& of_b,
                        bool blurred) {
    std::uint32_t bits = leaves::test_triangles(of_a, of_b, motion.slack);
    if (bits != 0 && use_of_cross_edges.is_due()) {
      const int before = std::popcount(bits);
      bits = leaves::overlapping_across_edges(of_a, of_b, bits, motion);
      use_of_cross_edges.count(before, std::popcount(bits));
    }
    leaves::for_each_pair(bits, leaf_a, leaf_b, [&](std::uint32_t, TrianglePair pair) {
      if (!blurred || !close.apart(pair)) pairs.push_back(pair);
    });
  };
  DualTreeTraversal<false, decltype(test)>(a, b, X_AB, motion, close, scratch, test).run();
}

void find_swept_candidates(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                           CandidateScratch& scratch, SweptCandidates& found) {
  const TreeMotion motion(a, b, X_AB, displacement);
  const CloseTests close(a, b, X_AB, displacement, motion.slack);
  detail::CrossAxesUse use_of_cross_edges = k_use_of_moving_cross_edges;
  const auto test = [&](Tree::Child leaf_a, const LeafLanes& of_a, Tree::Child leaf_b, const LeafLanes& of_b,
                        bool blurred) {
    HWY_ALIGN float first[leaves::k_pairs], last[leaves::k_pairs];
    std::uint32_t bits = leaves::test_moving_triangles(of_a, of_b, motion, first, last);
    if (bits != 0 && use_of_cross_edges.is_due()) {
      const int before = std::popcount(bits);
      bits = leaves::narrow_across_edges(of_a, of_b, bits, motion, first, last);
      use_of_cross_edges.count(before, std::popcount(bits));
    }
    leaves::for_each_pair(bits, leaf_a, leaf_b, [&](std::uint32_t lane, TrianglePair pair) {
      if (blurred && close.apart(pair)) return;
      found.pairs.push_back(pair);
      found.first.push_back(first[lane]);
      found.last.push_back(last[lane]);
    });
  };
  DualTreeTraversal<true, decltype(test)>(a, b, X_AB, motion, close, scratch, test).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof {
namespace candidates {
HWY_EXPORT(find_candidates);
HWY_EXPORT(find_swept_candidates);
}  // namespace candidates

void find_candidates(const Tree& a, const Tree& b, const Pose& X_AB, CandidateScratch& scratch,
                     std::vector<TrianglePair>& pairs) {
  pairs.clear();
  HWY_DYNAMIC_DISPATCH(candidates::find_candidates)(a, b, X_AB, scratch, pairs);
}

void find_swept_candidates(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                           CandidateScratch& scratch, SweptCandidates& found) {
  found.pairs.clear();
  found.first.clear();
  found.last.clear();
  HWY_DYNAMIC_DISPATCH(candidates::find_swept_candidates)(a, b, X_AB, displacement, scratch, found);
}

void select_candidates(const SweptCandidates& swept, double x, std::vector<TrianglePair>& pairs) {
  const auto fraction = static_cast<float>(x);  // intervals are padded by more than this rounds
  pairs.resize(swept.pairs.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < swept.pairs.size(); ++i) {
    pairs[count] = swept.pairs[i];
    count += swept.first[i] <= fraction && fraction <= swept.last[i] ? 1 : 0;
  }
  pairs.resize(count);
}

}  // namespace sixdof
#endif  // HWY_ONCE
