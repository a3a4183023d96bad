// Part of distance_search.cpp, which includes it once per instruction set: it has no include guard.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <hwy/highway.h>

#include <sixdof/oracle/distance_bounds-inl.h>
#include <sixdof/oracle/distance_search.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::detail {
namespace HWY_NAMESPACE {

/// The children of a pair of volumes that may hold a closer pair of triangles.
class PairExpansion {
 public:
  PairExpansion(const Tree& a, const Tree& b, const Pose& X_AB) : tree_a_(a), tree_b_(b), R_AB_(X_AB.R), sides_(a, b) {}

  /// To be called when the frames' direction changes.
  void forget() { sides_.forget(); }

  /// Calls keep() for each pair of volumes whose bound is not above the best.
  /// @param top not two leaves
  /// @param count of nodes expanded, to be increased
  template <class Keep>
  HWY_INLINE void expand(const NodePair& top, const QueryFrames& frames, float best, std::uint64_t& count,
                         const Keep& keep) {
    sides_.take(tree_a_, top.a, tree_b_, top.b, frames);
    const auto& [a, b] = sides_;
    const auto near_b =
        b.lanes() & near_volumes(a.volumes(), a.whole(), b.volumes(), frames.shift_along, frames.slack, best);
    const auto near_a =
        a.lanes() & near_volumes(b.volumes(), b.whole(), a.volumes(), frames.shift_along, frames.slack, best);
    // One volume after the other of the side that has fewer.
    const bool x_is_a = std::popcount(near_a) >= std::popcount(near_b);
    const auto& x = x_is_a ? a : b;
    const auto& y = x_is_a ? b : a;
    const std::uint32_t near_x = x_is_a ? near_a : near_b;
    const Frame& frame = x_is_a ? frames.a : frames.b;
    for (std::uint32_t rest = x_is_a ? near_b : near_a; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      HWY_ALIGN float bounds[k_width];
      ++count;
      std::uint32_t kept =
          near_x & bound_volumes(x.volumes(), y.volumes(), j, frame, frames.shift_along, frames.slack, best, bounds);
      if (kept != 0 && use_.is_due())
        kept = ask_cross_axes(x.volumes(), y.volumes(), j, x_is_a, frames.slack, best, kept, bounds);
      if (kept == 0) continue;
      const std::uint32_t child_y = y.child(j);
      y.prefetch_child(child_y);
      for (; kept != 0; kept &= kept - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(kept));
        const std::uint32_t child_x = x.child(i);
        x.prefetch_child(child_x);
        keep(x_is_a ? NodePair{child_x, child_y, bounds[i]} : NodePair{child_y, child_x, bounds[i]});
      }
    }
  }

 private:
  HWY_NOINLINE std::uint32_t ask_cross_axes(const Volumes& x, const Volumes& y, std::size_t j, bool x_is_a,
                                            const Slack& slack, float best, std::uint32_t kept, float* bounds) {
    if (!cross_axes_) cross_axes_.emplace(R_AB_);
    const auto& axes_x = x_is_a ? cross_axes_->in_a : cross_axes_->in_b;
    const auto& axes_y = x_is_a ? cross_axes_->in_b : cross_axes_->in_a;
    const std::uint32_t left = bound_across_axes(x, y, j, axes_x, axes_y, slack, best, kept, bounds);
    use_.count(std::popcount(kept), std::popcount(left));
    return left;
  }

  const Tree& tree_a_;
  const Tree& tree_b_;
  const Eigen::Matrix3d& R_AB_;
  Expansion<k_rounding, true, 8> sides_;
  std::optional<CrossAxes> cross_axes_;  // made when they are asked for the first time
  CrossAxesUse use_{0.125};
};

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();
