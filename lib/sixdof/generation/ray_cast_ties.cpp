#include <sixdof/generation/ray_cast_ties.h>

#include <algorithm>
#include <cmath>

#include <sixdof/generation/ray_cast_search.h>

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

/// Lower bound on axis . p for the points p of the volume of one lane, by its box and by its slab.
/// @param axis in the mesh's axes
/// @param rounding by which the bound is lowered
double support_bound(const PreciseVolumes& volumes, std::size_t lane, const double (&axis)[3], double rounding) {
  const double along =
      axis[0] * volumes.normal[0][lane] + axis[1] * volumes.normal[1][lane] + axis[2] * volumes.normal[2][lane];
  // The axis is `along` times the slab's normal plus a rest, for which the box is used.
  double in_slab = along * volumes.middle[lane] - std::abs(along) * volumes.half[lane];
  double in_box = -rounding;
  for (std::size_t k = 0; k < 3; ++k) {
    const double rest = axis[k] - along * volumes.normal[k][lane];
    in_slab += rest * volumes.box_center[k][lane] - std::abs(rest) * volumes.box_half[k][lane];
    in_box += axis[k] * volumes.box_center[k][lane] - std::abs(axis[k]) * volumes.box_half[k][lane];
  }
  return std::max(in_slab - rounding, in_box);
}

/// The same for a child's volume.
/// @param axis in the common frame
double support_bound(const CastTree& tree, std::uint32_t slot, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d in_mesh = tree.matrix().transpose() * axis;
  return support_bound(tree.mesh().precise_volumes()[slot / k_width], slot % k_width,
                       {in_mesh[0], in_mesh[1], in_mesh[2]}, k_support_rounding * tree.radius());
}

/// In the common frame.
Eigen::Vector3d box_center(const CastTree& tree, std::uint32_t slot) {
  const PreciseVolumes& v = tree.mesh().precise_volumes()[slot / k_width];
  const std::size_t lane = slot % k_width;
  return tree.matrix() * Eigen::Vector3d(v.box_center[0][lane], v.box_center[1][lane], v.box_center[2][lane]);
}

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
  for (std::size_t i = 0; i < k_width; ++i) bounds[i] = support_bound(volumes, i, a, rounding_);
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

bool separated_in_double(const Cast& cast, std::uint32_t a, std::uint32_t b) {
  const Hit& best = cast.best;
  const Eigen::Vector3d& u = cast.direction;
  // As in try_update(), a tie stays below the target.
  const double tie = std::min(k_cast_tie * cast.size(), 0.5 * cast.target);
  const double enough = cast.target - (best.pair ? 0.5 * tie : 0.0);
  const auto separates = [&](const Eigen::Vector3d& axis) {
    const double rate = axis.dot(u);
    const double least = support_bound(cast.a, a, axis) + support_bound(cast.b, b, axis) + best.translation * rate;
    return least + cast.reach() * std::min(rate, 0.0) >= enough;
  };
  if (separates(best.axis) || separates(best.separating_axis)) return true;
  const Eigen::Vector3d apart = box_center(cast.a, a) + box_center(cast.b, b) + best.translation * u;
  const Eigen::Vector3d nearest = apart + std::max(0.0, -apart.dot(u)) * u;
  if (separates(nearest.normalized())) return true;
  for (const Eigen::Vector3d& normal : {cast.a.slab(a).normal, cast.b.slab(b).normal}) {
    if (separates(normal.dot(u) < 0.0 ? Eigen::Vector3d(-normal) : normal)) return true;
  }
  return false;
}

}  // namespace sixdof::ray_cast
