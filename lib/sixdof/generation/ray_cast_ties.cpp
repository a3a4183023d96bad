#include <sixdof/generation/ray_cast_ties.h>

#include <algorithm>
#include <cmath>

namespace sixdof::ray_cast {
namespace {

constexpr std::size_t k_width = Tree::k_width;

/// Upper limit of a DifferenceSupport's budget, so that one configuration cannot spend what a thousand others saved.
constexpr std::uint64_t k_largest_budget = 1024;
/// Most support values take no more evaluations than this: one node per level.
constexpr std::uint64_t k_smallest_budget = 64;

/// A support value may be too small by this, in units of the tree's radius, where that saves the evaluation of all
/// subtrees that tie for it. Larger than k_support_rounding.
constexpr double k_support_tolerance = 2e-15;
/// Bounds are lowered by this, in the same units: the rounding of some fifteen products and sums.
constexpr double k_support_rounding = 1e-15;

/// Axes of pairs that tie differ by rounding. Support values along axes that differ by no more than this are off by
/// less than half of k_cast_tie for points within Cast::size().
constexpr double k_same_axis = 5e-16;

/// Cosine of the largest angle (1.4e-3) between a patch's normal and an axis that stands on it. Triangles of a flat
/// patch are tilted by less.
constexpr double k_least_patch_cosine = 1.0 - 1e-6;

}  // namespace

bool CoplanarPatch::is_facing(const Eigen::Vector3d& axis, const Eigen::Vector3d& direction) const {
  return size > 0.0f && normal.dot(axis) >= k_least_patch_cosine && normal.dot(direction) >= 0.0;
}

TreeSupport::TreeSupport(const CastTree& tree)
    : tree_(&tree), tolerance_(k_support_tolerance * tree.radius()), rounding_(k_support_rounding * tree.radius()) {}

void TreeSupport::set_axis(const Eigen::Vector3d& axis) {
  axis_ = tree_->matrix().transpose() * axis;
  ++axis_number_;
}

double TreeSupport::support_value(std::size_t slot, std::uint64_t& budget) {
  if (known_.empty()) known_.resize(k_width * tree_->nodes().size());
  Known& known = known_[slot];
  if (known.axis_number == axis_number_) return known.value;
  const CastChild child = tree_->child(slot);
  const std::uint64_t triangles = child.is_leaf() ? tree_->leaves()[child.index()].child.count()
                                                  : tree_->mesh().tree().nodes()[child.index()].triangle_count;
  if (budget < std::min(triangles, k_smallest_budget)) return k_unknown;
  const std::uint64_t before = evaluations_;
  const Found found = search(child, k_infinity, before + budget);
  budget -= std::min(budget, evaluations_ - before);
  known = {std::min(found.bound, found.least), axis_number_};
  return known.value;
}

void TreeSupport::bound_children(const PreciseVolumes& volumes, double* bounds) const {
  const double a[3] = {axis_[0], axis_[1], axis_[2]};
  for (std::size_t i = 0; i < k_width; ++i) {
    const double along = a[0] * volumes.normal[0][i] + a[1] * volumes.normal[1][i] + a[2] * volumes.normal[2][i];
    // The axis is `along` times the slab's normal plus a rest, for which the box is used.
    double in_slab = along * volumes.middle[i] - std::abs(along) * volumes.half[i];
    double in_box = -rounding_;
    for (std::size_t k = 0; k < 3; ++k) {
      const double rest = a[k] - along * volumes.normal[k][i];
      in_slab += rest * volumes.box_center[k][i] - std::abs(rest) * volumes.box_half[k][i];
      in_box += a[k] * volumes.box_center[k][i] - std::abs(a[k]) * volumes.box_half[k][i];
    }
    bounds[i] = std::max(in_slab - rounding_, in_box);
  }
}

TreeSupport::Found TreeSupport::search(CastChild child, double least, std::uint64_t limit) {
  Found found;
  if (child.is_leaf()) {
    const Tree::Child leaf = tree_->leaves()[child.index()].child;
    const Tree& tree = tree_->mesh().tree();
    for (std::uint32_t t = leaf.first(); t < leaf.first() + leaf.count(); ++t) {
      for (const Eigen::Vector3d& corner : tree.corners()[t]) {
        found.least = std::min(found.least, axis_.dot(corner - tree.center()));
      }
    }
    evaluations_ += leaf.count();
    return found;
  }
  const std::size_t count = tree_->nodes()[child.index()].child_count;
  alignas(64) double bounds[k_width];
  bound_children(tree_->mesh().precise_volumes()[child.index()], bounds);
  evaluations_ += count;
  for (std::size_t i = 0; i < count; ++i) {
    const auto lane = static_cast<std::size_t>(std::min_element(bounds, bounds + count) - bounds);
    least = std::min(least, found.least);
    if (bounds[lane] >= least - tolerance_ || evaluations_ >= limit) {
      found.bound = std::min(found.bound, bounds[lane]);
      break;
    }
    bounds[lane] = k_infinity;
    const std::size_t slot = k_width * child.index() + lane;
    const Found below = search(tree_->child(slot), least, limit);
    if (below.least <= below.bound + tolerance_) known_[slot] = {std::min(below.bound, below.least), axis_number_};
    found.bound = std::min(found.bound, below.bound);
    found.least = std::min(found.least, below.least);
  }
  return found;
}

double DifferenceSupport::support_value(std::size_t slot_a, std::size_t slot_b, const Eigen::Vector3d& axis,
                                        std::uint64_t budget) {
  budget_ = std::min(budget_ + budget, k_largest_budget);
  if (!has_axis_ || (axis - axis_).cwiseAbs().maxCoeff() > k_same_axis) {
    has_axis_ = true;
    axis_ = axis;
    a_.set_axis(axis);
    b_.set_axis(axis);
  }
  const double of_a = a_.support_value(slot_a, budget_);
  return of_a == TreeSupport::k_unknown ? of_a : of_a + b_.support_value(slot_b, budget_);
}

}  // namespace sixdof::ray_cast
