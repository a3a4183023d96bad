#include <sixdof/oracle/candidates.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/candidates.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/candidates_bounds-inl.h>
#include <sixdof/oracle/triangle_pairs-inl.h>
#include <sixdof/proximity/close_search.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

namespace leaves = triangle_pairs::HWY_NAMESPACE;

/// Nodes smaller than this many times the rounding of floats are tested in doubles: floats would not separate most of
/// their children.
constexpr float k_blurred = 64.0f;

/// Tests in doubles, for volumes that are small next to the rounding of floats. They hold for all fractions of the
/// displacement: B is taken at half of it, and has to be farther away than half of it and the margin.
class CloseTests {
 public:
  CloseTests(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
             const TreeMotion& motion)
      : bounds_(a, b, {X_AB.R, X_AB.t + 0.5 * displacement}),
        enough_((0.5 + 1e-14) * displacement.norm() +  // with the rounding of positions on the way
                static_cast<double>(motion.margin)),
        blurred_(k_blurred * k_blurred * motion.rounding * motion.rounding) {}

  /// @param size_a, size_b squares of the volumes' diagonals
  bool are_due(float size_a, float size_b) const { return std::max(size_a, size_b) < blurred_; }

  /// Whether two volumes are apart.
  bool apart(std::uint32_t a, std::uint32_t b) const { return apart(bounds_.shape_of_a({a}), bounds_.shape_of_b({b})); }

  bool apart(TrianglePair pair) const {
    return apart(bounds_.shape_of_a({0, pair.a}), bounds_.shape_of_b({0, pair.b}));
  }

 private:
  bool apart(const detail::CloseShape& a, const detail::CloseShape& b) const {
    return bounds_.lower_bound(a, b, Eigen::Vector3d::Zero(), enough_) > enough_;
  }

  detail::CloseBounds bounds_;
  double enough_;  // a distance
  float blurred_;  // square of a diagonal
};

/// Axes across two triangles along a displacement: instead of many cross(), so they pay sooner than CandidateAxes says.
constexpr detail::CrossAxesUse k_use_of_moving_cross_edges(0.5);

/// Depth-first traversal of pairs of volumes. Pairs wait on a stack while their memory is fetched. Which of two pairs
/// is found first depends on the trees alone, not on which others are found: sums over them have the same bits whatever
/// was pruned.
/// @tparam moving the displacement is not zero
/// @tparam Take called for leaves that may intersect: as take(leaf of A, leaf of B, whether floats blur them) or, if
/// `moving`, take(SweptPair)
template <bool moving, class Take>
class DualTreeTraversal {
 public:
  DualTreeTraversal(const Tree& a, const Tree& b, const Pose& X_AB, const TreeMotion& motion, const CloseTests& close,
                    CandidateScratch& scratch, Take take)
      : a_(a),
        b_(b),
        motion_(motion),
        close_(close),
        R_AB_(X_AB.R),
        stack_(scratch.volumes),
        use_of_cross_axes_(scratch.axes.volumes),
        expansion_(a, b),
        take_(take) {}

  /// Expands up to `most` pairs. Returns how many it did.
  std::size_t run(std::size_t most) {
    std::size_t count = 0;
    for (; count < most && !stack_.empty(); ++count) {
      const VolumePair pair = stack_.back();
      stack_.pop_back();
      expand(pair);
    }
    return count;
  }

 private:
  using VolumePair = CandidateScratch::VolumePair;

  void expand(const VolumePair& pair) {
    expansion_.take(pair.a, pair.size_a, pair.b, pair.size_b, motion_.frames);
    const auto& [a, b] = expansion_;
    const bool blurred = close_.are_due(pair.size_a, pair.size_b);
    // One volume after the other of B or, if B's is whole, of A.
    const bool x_is_a = a.splits();
    const auto& x = x_is_a ? a : b;
    const auto& y = x_is_a ? b : a;
    const Passage& passage = x_is_a ? motion_.of_b : motion_.of_a;
    std::uint32_t rest = y.lanes();
    if (y.splits()) rest &= near_boxes<k_rounding>(x.whole(), y.volumes(), motion_.slack(k_units), passage.half_in_x);
    for (; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      std::uint32_t bits =
          blurred ? test_closely(x_is_a, j)
                  : overlapping_volumes<moving>(x.volumes(), y.volumes(), j, passage, motion_, first_, last_);
      bits &= x.lanes();
      if (!blurred && bits != 0 && use_of_cross_axes_.is_due())
        bits = ask_cross_axes(x.volumes(), y.volumes(), j, x_is_a, bits);
      if (bits == 0) continue;
      for (; bits != 0; bits &= bits - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(bits));
        x_is_a ? descend(i, j, i, blurred) : descend(j, i, i, blurred);
      }
    }
  }

  /// In doubles.
  HWY_NOINLINE std::uint32_t test_closely(bool x_is_a, std::size_t j) {
    const auto& [a, b] = expansion_;
    std::uint32_t bits = 0;
    for (std::uint32_t rest = (x_is_a ? a : b).lanes(); rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      if (!close_.apart(a.child(x_is_a ? i : j), b.child(x_is_a ? j : i))) bits |= 1u << i;
    }
    if constexpr (moving) {
      std::fill_n(first_, k_width, detail::k_first_fraction);
      std::fill_n(last_, k_width, detail::k_last_fraction);
    }
    return bits;
  }

  /// @param i, j lanes of the volumes of A and of B
  /// @param lane of the fractions
  HWY_INLINE void descend(std::size_t i, std::size_t j, std::size_t lane, bool blurred) {
    const auto& [of_a, of_b] = expansion_;
    const std::uint32_t a = of_a.child(i), b = of_b.child(j);
    if ((a & b & Tree::k_leaf_number) != 0) {
      const std::uint32_t leaf_a = a - Tree::k_leaf_number, leaf_b = b - Tree::k_leaf_number;
      if constexpr (moving) {
        take_(SweptPair{leaf_a, leaf_b, first_[lane], last_[lane]});
      } else {
        take_(leaf_a, leaf_b, blurred);
      }
      return;
    }
    of_a.prefetch_child(a);
    of_b.prefetch_child(b);
    stack_.push_back({a, b, of_a.volumes().size[i], of_b.volumes().size[j]});
  }

  HWY_NOINLINE std::uint32_t ask_cross_axes(const Volumes& x, const Volumes& y, std::size_t j, bool x_is_a,
                                            std::uint32_t bits) {
    if (!cross_axes_) cross_axes_.emplace(R_AB_);
    const auto& axes_x = x_is_a ? cross_axes_->in_a : cross_axes_->in_b;
    const auto& axes_y = x_is_a ? cross_axes_->in_b : cross_axes_->in_a;
    const std::uint32_t left =
        overlapping_across_axes(x, y, j, axes_x, axes_y, bits, x_is_a ? motion_.of_b : motion_.of_a, motion_);
    use_of_cross_axes_.count(std::popcount(bits), std::popcount(left));
    return left;
  }

  const Tree& a_;
  const Tree& b_;
  const TreeMotion& motion_;
  const CloseTests& close_;
  const Eigen::Matrix3d& R_AB_;
  std::vector<VolumePair>& stack_;
  detail::CrossAxesUse& use_of_cross_axes_;
  /// Of the volumes that are taken 80 % are loaded if one is kept, 45 % with 16, 36 % with 64, which do not fit the
  /// first cache (elephants, overlap of 10 %).
  static constexpr std::size_t k_kept = 16;
  Expansion<k_rounding, false, k_kept> expansion_;
  /// If moving: intervals of fractions of the volumes of x.
  HWY_ALIGN float first_[k_width];
  HWY_ALIGN float last_[k_width];
  std::optional<detail::CrossAxes> cross_axes_;  // made when they are asked for the first time
  Take take_;
};

/// Tests the triangles of pairs of leaves.
/// @tparam moving the displacement is not zero
template <bool moving>
class LeafTests {
 public:
  LeafTests(const Tree& a, const Tree& b, const TreeMotion& motion, detail::CrossAxesUse& use_of_cross_edges)
      : motion_(motion), leaves_a_(a), leaves_b_(b), use_of_cross_edges_(use_of_cross_edges) {}

  /// Calls take(pair of triangles, lane of first() and last()) for those that may intersect.
  template <class Take>
  HWY_INLINE void test(std::uint32_t a, std::uint32_t b, const Take& take) {
    const leaves::SideA& of_a = leaves_a_.get(a, motion_);
    const leaves::SideB& of_b = leaves_b_.get(b, motion_);
    std::uint32_t bits =
        pairs_of(of_a.count, of_b.count) & leaves::test_triangles<moving>(of_a, of_b, motion_, first_, last_);
    if (bits != 0 && use_of_cross_edges_.is_due()) {
      const int before = std::popcount(bits);
      bits = leaves::test_across_edges<moving>(of_a, of_b, bits, motion_, first_, last_);
      use_of_cross_edges_.count(before, std::popcount(bits));
    }
    for (; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      take(pair_of(of_a.first, of_b.first, lane), lane);
    }
  }

  /// If moving: the fractions between which a pair may intersect.
  float first(std::uint32_t lane) const { return first_[lane]; }
  float last(std::uint32_t lane) const { return last_[lane]; }

 private:
  const TreeMotion& motion_;
  leaves::LeafCache<true> leaves_a_;
  leaves::LeafCache<false> leaves_b_;
  detail::CrossAxesUse& use_of_cross_edges_;
  HWY_ALIGN float first_[leaves::k_pairs];
  HWY_ALIGN float last_[leaves::k_pairs];
};

/// Pairs of leaves that are tested later, when their memory has been fetched.
class LeafQueue {
 public:
  LeafQueue(const Tree& a, const Tree& b, const TreeMotion& motion, const CloseTests& close, CandidateScratch& scratch,
            std::vector<TrianglePair>& pairs)
      : a_(a),
        b_(b),
        close_(close),
        queue_(scratch.leaves),
        pairs_(pairs),
        tests_(a, b, motion, scratch.axes.triangles) {
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

  /// Tests the first pairs.
  HWY_NOINLINE void test(std::size_t count) {
    for (const CandidateScratch::LeafPair& pair : std::span(queue_).first(count)) {
      tests_.test(pair.a, pair.b, [&](TrianglePair triangles, std::uint32_t) {
        if (!pair.blurred || !close_.apart(triangles)) pairs_.push_back(triangles);
      });
    }
    queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(count));
  }

  const Tree& a_;
  const Tree& b_;
  const CloseTests& close_;
  std::vector<CandidateScratch::LeafPair>& queue_;
  std::vector<TrianglePair>& pairs_;
  LeafTests<false> tests_;
};

/// Expands up to `most` of the pairs in `scratch`. Returns how many it did.
std::size_t continue_search(const Tree& a, const Tree& b, const Pose& X_AB, double margin, CandidateScratch& scratch,
                            std::vector<TrianglePair>& pairs, std::size_t most) {
  const TreeMotion motion(a, b, X_AB, Eigen::Vector3d::Zero(), margin);
  const CloseTests close(a, b, X_AB, Eigen::Vector3d::Zero(), motion);
  LeafQueue queue(a, b, motion, close, scratch, pairs);
  const auto take = [&](std::uint32_t leaf_a, std::uint32_t leaf_b, bool blurred) {
    queue.add(leaf_a, leaf_b, blurred);
  };
  const std::size_t count =
      DualTreeTraversal<false, decltype(take)>(a, b, X_AB, motion, close, scratch, take).run(most);
  queue.finish();
  return count;
}

void divide_search(const Tree& a, const Tree& b, const Pose& X_AB, std::size_t enough, CandidateScratch& scratch,
                   std::vector<CandidateScratch::VolumePair>& pairs, std::vector<CandidateScratch::VolumePair>& wider) {
  const TreeMotion motion(a, b, X_AB, Eigen::Vector3d::Zero(), 0.0);
  const CloseTests close(a, b, X_AB, Eigen::Vector3d::Zero(), motion);
  bool meets_leaves = false;
  const auto take = [&](std::uint32_t, std::uint32_t, bool) { meets_leaves = true; };
  DualTreeTraversal<false, decltype(take)> traversal(a, b, X_AB, motion, close, scratch, take);
  scratch.start(a, b);
  pairs = scratch.volumes;
  for (bool divides = true; divides && pairs.size() < enough; pairs.swap(wider)) {
    divides = false;
    wider.clear();
    for (const CandidateScratch::VolumePair& pair : pairs) {
      scratch.volumes.assign(1, pair);
      meets_leaves = false;
      traversal.run(1);
      if (meets_leaves) scratch.volumes.assign(1, pair);  // pairs of leaves come before the pairs of volumes
      wider.insert(wider.end(), scratch.volumes.begin(), scratch.volumes.end());
      divides = divides || !meets_leaves;
    }
  }
}

void find_swept_leaves(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                       CandidateScratch& scratch, std::vector<SweptPair>& pairs) {
  const TreeMotion motion(a, b, X_AB, displacement);
  const CloseTests close(a, b, X_AB, displacement, motion);
  const auto take = [&](const SweptPair& pair) { pairs.push_back(pair); };
  DualTreeTraversal<true, decltype(take)>(a, b, X_AB, motion, close, scratch, take).run(CandidateSearch::k_whole);
}

void select_triangles(const Tree& a, const Tree& b, const Pose& X_AB, double margin,
                      std::span<const SweptPair> leaf_pairs, FractionRange range, std::vector<TrianglePair>& pairs) {
  const TreeMotion motion(a, b, X_AB, Eigen::Vector3d::Zero(), margin);
  CandidateAxes axes;
  LeafTests<false> tests(a, b, motion, axes.triangles);
  constexpr std::size_t k_ahead = 16;
  for (std::size_t i = 0; i < leaf_pairs.size(); ++i) {
    if (i + k_ahead < leaf_pairs.size() && range.meets(leaf_pairs[i + k_ahead])) {
      prefetch(a.leaves()[leaf_pairs[i + k_ahead].a]);
      prefetch(b.leaves()[leaf_pairs[i + k_ahead].b]);
    }
    if (!range.meets(leaf_pairs[i])) continue;
    tests.test(leaf_pairs[i].a, leaf_pairs[i].b,
               [&](TrianglePair triangles, std::uint32_t) { pairs.push_back(triangles); });
  }
}

void find_swept_triangles(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                          std::span<const SweptPair> leaf_pairs, std::vector<SweptPair>& pairs) {
  const TreeMotion motion(a, b, X_AB, displacement);
  detail::CrossAxesUse use_of_cross_edges = k_use_of_moving_cross_edges;
  LeafTests<true> tests(a, b, motion, use_of_cross_edges);
  for (const SweptPair& pair : leaf_pairs) {
    tests.test(pair.a, pair.b, [&](TrianglePair triangles, std::uint32_t lane) {
      pairs.push_back({triangles.a, triangles.b, tests.first(lane), tests.last(lane)});
    });
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof {
namespace candidates {
HWY_EXPORT(continue_search);
HWY_EXPORT(divide_search);
HWY_EXPORT(find_swept_leaves);
HWY_EXPORT(find_swept_triangles);
HWY_EXPORT(select_triangles);

// Calls from within: a dispatch among one instruction set alone (ARM's NEON) knows unqualified names only.
constexpr auto continue_search_now = [](auto&&... given) { return HWY_DYNAMIC_DISPATCH(continue_search)(given...); };
constexpr auto divide_search_now = [](auto&&... given) { return HWY_DYNAMIC_DISPATCH(divide_search)(given...); };
constexpr auto find_swept_leaves_now = [](auto&&... given) {
  return HWY_DYNAMIC_DISPATCH(find_swept_leaves)(given...);
};
constexpr auto find_swept_triangles_now = [](auto&&... given) {
  return HWY_DYNAMIC_DISPATCH(find_swept_triangles)(given...);
};
constexpr auto select_triangles_now = [](auto&&... given) { return HWY_DYNAMIC_DISPATCH(select_triangles)(given...); };
}  // namespace candidates

namespace {

std::size_t continue_search(const Tree& a, const Tree& b, const Pose& X_AB, double margin, CandidateScratch& scratch,
                            std::vector<TrianglePair>& pairs, std::size_t most) {
  return candidates::continue_search_now(a, b, X_AB, margin, scratch, pairs, most);
}

}  // namespace

void CandidateScratch::start(const Tree& a, const Tree& b) {
  volumes.assign(1, {0, 0, a.nodes()[0].volume.squared_diagonal(), b.nodes()[0].volume.squared_diagonal()});
  axes = {};
}

void CandidateSearch::start(const Tree& a, const Tree& b, const Pose& pose, double length) {
  X_AB = pose;
  margin = length;
  scratch.start(a, b);
  pairs.clear();
  expansions = 0;
}

void CandidateSearch::start(const Pose& pose, const CandidateScratch::VolumePair& pair, const CandidateAxes& axes) {
  X_AB = pose;
  margin = 0.0;
  scratch.volumes.assign(1, pair);
  scratch.axes = axes;
  pairs.clear();
  expansions = 0;
}

void CandidateSearch::advance(const Tree& a, const Tree& b, std::size_t most) {
  expansions += continue_search(a, b, X_AB, margin, scratch, pairs, most);
}

void find_candidates(const Tree& a, const Tree& b, const Pose& X_AB, CandidateScratch& scratch,
                     std::vector<TrianglePair>& pairs) {
  pairs.clear();
  scratch.start(a, b);
  continue_search(a, b, X_AB, 0.0, scratch, pairs, CandidateSearch::k_whole);
}

void divide_search(const Tree& a, const Tree& b, const Pose& X_AB, std::size_t enough, CandidateScratch& scratch,
                   std::vector<CandidateScratch::VolumePair>& pairs, std::vector<CandidateScratch::VolumePair>& wider) {
  candidates::divide_search_now(a, b, X_AB, enough, scratch, pairs, wider);
}

void find_swept_leaves(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                       CandidateScratch& scratch, std::vector<SweptPair>& pairs) {
  pairs.clear();
  scratch.start(a, b);
  candidates::find_swept_leaves_now(a, b, X_AB, displacement, scratch, pairs);
}

void find_swept_triangles(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                          std::span<const SweptPair> leaf_pairs, std::vector<SweptPair>& pairs) {
  pairs.clear();
  candidates::find_swept_triangles_now(a, b, X_AB, displacement, leaf_pairs, pairs);
}

void select_triangles(const Tree& a, const Tree& b, const Pose& X_AB, double margin,
                      std::span<const SweptPair> leaf_pairs, FractionRange range, std::vector<TrianglePair>& pairs) {
  pairs.clear();
  candidates::select_triangles_now(a, b, X_AB, margin, leaf_pairs, range, pairs);
}

void select_pairs(std::span<const SweptPair> swept, FractionRange range, std::vector<TrianglePair>& pairs) {
  pairs.clear();
  for (const SweptPair& pair : swept) {
    if (range.meets(pair)) pairs.push_back({pair.a, pair.b});
  }
}

}  // namespace sixdof
#endif  // HWY_ONCE
