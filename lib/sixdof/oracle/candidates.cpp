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
    return std::max(a.volume.squared_diagonal(), b.volume.squared_diagonal()) < blurred_;
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
/// on a stack while their memory is fetched. Which of two pairs is found first depends on the trees alone, not on which
/// others are found: sums over them have the same bits whatever was pruned.
/// @tparam moving the displacement is not zero
/// @tparam Take called for leaves that may intersect: as take(leaf of A, leaf of B, whether floats blur them) or, if
/// `moving`, take(SweptPair)
template <bool moving, class Take>
class DualTreeTraversal {
 public:
  DualTreeTraversal(const Tree& a, const Tree& b, const Pose& X_AB, const TreeMotion& motion, const CloseTests& close,
                    CandidateScratch& scratch, Take take)
      : a_(a), b_(b), motion_(motion), close_(close), R_AB_(X_AB.R), stack_(scratch.nodes), take_(take) {}

  void run() {
    stack_.assign(1, {0, 0, k_all, k_all});
    while (!stack_.empty()) {
      const NodePair pair = stack_.back();
      stack_.pop_back();
      expand(pair);
    }
  }

 private:
  static constexpr std::uint8_t k_all = 0xff;
  static constexpr std::uint32_t k_none = ~0u;

  using NodePair = CandidateScratch::NodePair;

  /// What is known about the children of two nodes.
  struct Expansion {
    const NodePair& pair;
    const Tree::Node& node_a;
    const Tree::Node& node_b;
    bool blurred;
    std::uint32_t overlapping[k_width] = {};  // children of A, for each child of B
  };

  void expand(const NodePair& pair) {
    Expansion x{.pair = pair, .node_a = a_.nodes()[pair.a], .node_b = b_.nodes()[pair.b], .blurred = false};
    const std::uint32_t lanes_a = pair.lanes_a & ((1u << x.node_a.child_count) - 1);
    std::uint32_t lanes_b = pair.lanes_b & ((1u << x.node_b.child_count) - 1);
    x.blurred = close_.are_due(x.node_a, x.node_b);
    if (x.blurred) {
      test_closely(x, lanes_a, lanes_b);
    } else {
      load(pair);
      lanes_b &= overlapping_node(children_b_, x.node_a, lanes_a, motion_);
      for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(rest));
        if constexpr (moving) {
          x.overlapping[j] =
              lanes_a & overlap_intervals(children_a_, x.node_a, children_b_, j, motion_, first_[j], last_[j]);
        } else {
          x.overlapping[j] = lanes_a & overlapping_children(children_a_, x.node_a, children_b_, j);
        }
      }
      if (use_of_cross_axes_.is_due()) ask_cross_axes(lanes_b, x.overlapping);
    }
    for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      for (std::uint32_t m = x.overlapping[j]; m != 0; m &= m - 1) {
        descend(x, static_cast<std::size_t>(std::countr_zero(m)), j);
      }
    }
  }

  HWY_NOINLINE void test_closely(Expansion& x, std::uint32_t lanes_a, std::uint32_t lanes_b) {
    for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      x.overlapping[j] = close_.overlapping_children(x.node_a, lanes_a, x.node_b, j);
      if constexpr (moving) {
        std::fill_n(first_[j], k_width, detail::k_first_fraction);
        std::fill_n(last_[j], k_width, detail::k_last_fraction);
      }
    }
  }

  /// To child i of A's node and child j of B's.
  HWY_INLINE void descend(const Expansion& x, std::size_t i, std::size_t j) {
    const Tree::Child a = x.node_a.child[i], b = x.node_b.child[j];
    if (a.is_leaf() && b.is_leaf()) {
      if constexpr (moving) {
        take_(SweptPair{x.node_a.leaf[i], x.node_b.leaf[j], first_[j][i], last_[j][i]});
      } else {
        take_(x.node_a.leaf[i], x.node_b.leaf[j], x.blurred);
      }
      return;
    }
    NodePair next = x.pair;
    next.lanes_a = a.is_leaf() ? static_cast<std::uint8_t>(1u << i) : k_all;
    next.lanes_b = b.is_leaf() ? static_cast<std::uint8_t>(1u << j) : k_all;
    if (!a.is_leaf()) prefetch(a_.nodes()[next.a = a.node()]);
    if (!b.is_leaf()) prefetch(b_.nodes()[next.b = b.node()]);
    stack_.push_back(next);
  }

  /// The volumes of the children of both nodes, unless they are those of the last pair.
  HWY_INLINE void load(const NodePair& pair) {
    if (pair.a != loaded_a_) load_children<false, moving>(a_.nodes()[loaded_a_ = pair.a], motion_, children_a_);
    if (pair.b != loaded_b_) load_children<true, moving>(b_.nodes()[loaded_b_ = pair.b], motion_, children_b_);
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

  const Tree& a_;
  const Tree& b_;
  const TreeMotion& motion_;
  const CloseTests& close_;
  const Eigen::Matrix3d& R_AB_;
  std::vector<NodePair>& stack_;
  Children children_a_, children_b_;
  std::uint32_t loaded_a_ = k_none, loaded_b_ = k_none;
  /// If moving: intervals of fractions of the last expansion, [child of B][child of A].
  HWY_ALIGN float first_[k_width][k_width];
  HWY_ALIGN float last_[k_width][k_width];
  std::optional<detail::CrossAxes> cross_axes_;  // made when they are asked for the first time
  detail::CrossAxesUse use_of_cross_axes_ = k_use_of_cross_axes;
  Take take_;
};

/// Tests the triangles of pairs of leaves, which wait in a queue while their memory is fetched.
class LeafTests {
 public:
  LeafTests(const Tree& a, const Tree& b, const TreeMotion& motion, const CloseTests& close, CandidateScratch& scratch,
            std::vector<TrianglePair>& pairs)
      : a_(a),
        b_(b),
        motion_(motion),
        close_(close),
        queue_(scratch.leaves),
        pairs_(pairs),
        leaves_a_(a),
        leaves_b_(b) {
    queue_.clear();
  }

  HWY_INLINE void add(std::uint32_t a, std::uint32_t b, bool blurred) {
    queue_.push_back({a, b, blurred});
    prefetch(a_.leaves()[a]);
    prefetch(b_.leaves()[b]);
    if (queue_.size() >= k_most) test(queue_.size() - k_ahead);
  }
  void finish() { test(queue_.size()); }

 private:
  static constexpr std::size_t k_ahead = 8, k_most = 32;  // pairs of leaves that wait

  /// Tests the first pairs of the queue.
  HWY_NOINLINE void test(std::size_t count) {
    for (const CandidateScratch::LeafPair& pair : std::span(queue_).first(count)) {
      const LeafLanes& of_b = leaves_b_.get(
          pair.b, [&](const Tree::Leaf& leaf, LeafLanes& out) { leaves::load_leaf_of_b(leaf, motion_, out); });
      const LeafLanes& of_a = leaves_a_.get(pair.a, leaves::load_leaf_of_a);
      std::uint32_t bits = leaves::test_triangles(of_a, of_b, motion_.slack);
      if (bits != 0 && use_of_cross_edges_.is_due()) {
        const int before = std::popcount(bits);
        bits = leaves::overlapping_across_edges(of_a, of_b, bits, motion_);
        use_of_cross_edges_.count(before, std::popcount(bits));
      }
      leaves::for_each_pair(bits, a_.leaves()[pair.a].child, b_.leaves()[pair.b].child,
                            [&](TrianglePair triangles, std::uint32_t) {
                              if (!pair.blurred || !close_.apart(triangles)) pairs_.push_back(triangles);
                            });
    }
    queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(count));
  }

  const Tree& a_;
  const Tree& b_;
  const TreeMotion& motion_;
  const CloseTests& close_;
  std::vector<CandidateScratch::LeafPair>& queue_;
  std::vector<TrianglePair>& pairs_;
  LeafCache leaves_a_, leaves_b_;
  detail::CrossAxesUse use_of_cross_edges_ = k_use_of_cross_edges;
};

void find_candidates(const Tree& a, const Tree& b, const Pose& X_AB, CandidateScratch& scratch,
                     std::vector<TrianglePair>& pairs) {
  const TreeMotion motion(a, b, X_AB, Eigen::Vector3d::Zero());
  const CloseTests close(a, b, X_AB, Eigen::Vector3d::Zero(), motion.slack);
  LeafTests tests(a, b, motion, close, scratch, pairs);
  const auto take = [&](std::uint32_t leaf_a, std::uint32_t leaf_b, bool blurred) {
    tests.add(leaf_a, leaf_b, blurred);
  };
  DualTreeTraversal<false, decltype(take)>(a, b, X_AB, motion, close, scratch, take).run();
  tests.finish();
}

void find_swept_leaves(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                       CandidateScratch& scratch, std::vector<SweptPair>& pairs) {
  const TreeMotion motion(a, b, X_AB, displacement);
  const CloseTests close(a, b, X_AB, displacement, motion.slack);
  const auto take = [&](const SweptPair& pair) { pairs.push_back(pair); };
  DualTreeTraversal<true, decltype(take)>(a, b, X_AB, motion, close, scratch, take).run();
}

void find_swept_triangles(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                          std::span<const SweptPair> leaf_pairs, std::vector<SweptPair>& pairs) {
  const TreeMotion motion(a, b, X_AB, displacement);
  LeafCache leaves_a(a), leaves_b(b);
  const auto load_b = [&](const Tree::Leaf& leaf, LeafLanes& out) { leaves::load_leaf_of_b(leaf, motion, out); };
  detail::CrossAxesUse use_of_cross_edges = k_use_of_moving_cross_edges;
  for (const SweptPair& pair : leaf_pairs) {
    HWY_ALIGN float first[leaves::k_pairs], last[leaves::k_pairs];
    const LeafLanes& of_a = leaves_a.get(pair.a, leaves::load_leaf_of_a);
    const LeafLanes& of_b = leaves_b.get(pair.b, load_b);
    std::uint32_t bits = leaves::test_moving_triangles(of_a, of_b, motion, first, last);
    if (bits != 0 && use_of_cross_edges.is_due()) {
      const int before = std::popcount(bits);
      bits = leaves::narrow_across_edges(of_a, of_b, bits, motion, first, last);
      use_of_cross_edges.count(before, std::popcount(bits));
    }
    leaves::for_each_pair(bits, a.leaves()[pair.a].child, b.leaves()[pair.b].child,
                          [&](TrianglePair triangles, std::uint32_t lane) {
                            pairs.push_back({triangles.a, triangles.b, first[lane], last[lane]});
                          });
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof {
namespace candidates {
HWY_EXPORT(find_candidates);
HWY_EXPORT(find_swept_leaves);
HWY_EXPORT(find_swept_triangles);
}  // namespace candidates

void find_candidates(const Tree& a, const Tree& b, const Pose& X_AB, CandidateScratch& scratch,
                     std::vector<TrianglePair>& pairs) {
  pairs.clear();
  HWY_DYNAMIC_DISPATCH(candidates::find_candidates)(a, b, X_AB, scratch, pairs);
}

void find_swept_leaves(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                       CandidateScratch& scratch, std::vector<SweptPair>& pairs) {
  pairs.clear();
  HWY_DYNAMIC_DISPATCH(candidates::find_swept_leaves)(a, b, X_AB, displacement, scratch, pairs);
}

void find_swept_triangles(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                          std::span<const SweptPair> leaf_pairs, std::vector<SweptPair>& pairs) {
  pairs.clear();
  HWY_DYNAMIC_DISPATCH(candidates::find_swept_triangles)(a, b, X_AB, displacement, leaf_pairs, pairs);
}

void select_pairs(std::span<const SweptPair> swept, double x, std::vector<TrianglePair>& pairs) {
  pairs.clear();
  for (const SweptPair& pair : swept) {
    if (static_cast<double>(pair.first) <= x && x <= static_cast<double>(pair.last)) pairs.push_back({pair.a, pair.b});
  }
}

}  // namespace sixdof
#endif  // HWY_ONCE
