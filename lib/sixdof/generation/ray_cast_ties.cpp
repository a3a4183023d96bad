#include <sixdof/generation/ray_cast_ties.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include <sixdof/generation/ray_cast_search.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/generation/ray_cast_ties.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/double_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

using namespace double_lanes::HWY_NAMESPACE;

/// For each child of a node, a lower bound on axis . p for the points p of its volume: support_bound() below.
void support_bounds(const PreciseVolumes& volumes, const Eigen::Vector3d& axis, double rounding, double* bounds) {
  const V3 n{set(axis[0]), set(axis[1]), set(axis[2])};
  for (std::size_t i = 0; i < Tree::k_width; i += hn::Lanes(k_lanes)) {
    const V3 normal = load(volumes.normal, i), center = load(volumes.box_center, i), half = load(volumes.box_half, i);
    const V along = hn::Add(hn::Add(hn::Mul(n.x, normal.x), hn::Mul(n.y, normal.y)), hn::Mul(n.z, normal.z));
    V in_slab = hn::Sub(hn::Mul(along, hn::Load(k_lanes, volumes.middle + i)),
                        hn::Mul(hn::Abs(along), hn::Load(k_lanes, volumes.half + i)));
    V in_box = set(-rounding);
    const auto add = [&](V axis_k, V normal_k, V center_k, V half_k) {
      const V rest = hn::Sub(axis_k, hn::Mul(along, normal_k));
      in_slab = hn::Add(in_slab, hn::Sub(hn::Mul(rest, center_k), hn::Mul(hn::Abs(rest), half_k)));
      in_box = hn::Add(in_box, hn::Sub(hn::Mul(axis_k, center_k), hn::Mul(hn::Abs(axis_k), half_k)));
    };
    add(n.x, normal.x, center.x, half.x);
    add(n.y, normal.y, center.y, half.y);
    add(n.z, normal.z, center.z, half.z);
    hn::Store(hn::Max(hn::Sub(in_slab, set(rounding)), in_box), k_lanes, bounds + i);
  }
}

/// The least axis . (p - center) of some triangles' corners p.
double least_of_corners(std::span<const Tree::Corners> triangles, const Eigen::Vector3d& center,
                        const Eigen::Vector3d& axis) {
  using Points = hn::CappedTag<double, 4>;
  constexpr Points d;
  const double* const p = triangles[0][0].data();  // x, y, z of each corner in turn
  const std::size_t count = 3 * triangles.size();
  const std::size_t lanes = hn::Lanes(d);
  double least = std::numeric_limits<double>::infinity();
  if (count < lanes) {
    for (const Eigen::Vector3d& corner : triangles[0]) least = std::min(least, axis.dot(corner - center));
    return least;
  }
  auto value = hn::Set(d, least);
  for (std::size_t i = 0; i < count; i += lanes) {
    hn::Vec<Points> x, y, z;
    hn::LoadInterleaved3(d, p + 3 * std::min(i, count - lanes), x, y, z);
    const auto along = [&](auto coordinate, int k) {
      return hn::Mul(hn::Set(d, axis[k]), hn::Sub(coordinate, hn::Set(d, center[k])));
    };
    value = hn::Min(value, hn::Add(hn::Add(along(x, 0), along(y, 1)), along(z, 2)));
  }
  return hn::GetLane(hn::MinOfLanes(d, value));
}

/// The lane of the least bound, the first of equal ones.
std::size_t lane_of_least(const double* bounds) {
  V least = set(TreeSupport::k_infinity);
  for (std::size_t i = 0; i < Tree::k_width; i += hn::Lanes(k_lanes)) {
    least = hn::Min(least, hn::Load(k_lanes, bounds + i));
  }
  least = hn::MinOfLanes(k_lanes, least);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < Tree::k_width; i += hn::Lanes(k_lanes)) {
    bits |= bits_of(hn::Eq(hn::Load(k_lanes, bounds + i), least), i);
  }
  return static_cast<std::size_t>(std::countr_zero(bits));
}

/// Result of the search of a subtree.
struct Found {
  double bound = TreeSupport::k_infinity;  ///< Lower bound on all that was not evaluated.
  double least = TreeSupport::k_infinity;  ///< The least axis . p of what was.
};

/// @param least found elsewhere: what is not less need not be evaluated
Found search(TreeSupport::Search& x, Tree::Child child, double least) {
  Found found;
  if (child.is_leaf()) {
    const Tree& tree = x.mesh.tree();
    x.evaluations += child.count();
    found.least = least_of_corners(tree.corners().subspan(child.first(), child.count()), tree.center(), x.axis);
    return found;
  }
  const PreciseVolumes& volumes = x.mesh.precise_volumes()[child.node()];
  HWY_ALIGN double bounds[Tree::k_width];
  support_bounds(volumes, x.axis, x.rounding, bounds);
  std::fill(bounds + volumes.child_count, bounds + Tree::k_width, TreeSupport::k_infinity);
  x.evaluations += volumes.child_count;
  for (std::size_t i = 0; i < volumes.child_count; ++i) {
    const std::size_t lane = lane_of_least(bounds);
    least = std::min(least, found.least);
    if (bounds[lane] >= least - x.tolerance || x.evaluations >= x.limit) {
      found.bound = std::min(found.bound, bounds[lane]);
      break;
    }
    bounds[lane] = TreeSupport::k_infinity;
    const Found below = search(x, volumes.child[lane], least);
    if (below.least <= below.bound + x.tolerance) {
      x.known[Tree::k_width * child.node() + lane] = {std::min(below.bound, below.least), x.axis_number};
    }
    found.bound = std::min(found.bound, below.bound);
    found.least = std::min(found.least, below.least);
  }
  return found;
}

double find_support_value(TreeSupport::Search& x, Tree::Child child) {
  const Found found = search(x, child, TreeSupport::k_infinity);
  return std::min(found.bound, found.least);
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::ray_cast {

HWY_EXPORT(find_support_value);

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
  const Tree::Child child = tree_->mesh().precise_volumes()[slot / k_width].child[slot % k_width];
  if (budget < k_smallest_budget) {
    const std::uint64_t triangles = child.is_leaf() ? child.count() : tree_->nodes()[child.node()].triangle_count;
    if (budget < triangles) return k_unknown;
  }
  Search search{.mesh = tree_->mesh(),
                .axis = axis_,
                .tolerance = tolerance_,
                .rounding = rounding_,
                .known = known_.data(),
                .axis_number = axis_number_,
                .evaluations = 0,
                .limit = budget};
  known = {HWY_DYNAMIC_DISPATCH(find_support_value)(search, child), axis_number_};
  evaluations_ += search.evaluations;
  budget -= std::min(budget, search.evaluations);
  return known.value;
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

bool slabs_tie(const Cast& cast, std::uint32_t a, std::uint32_t b) {
  const double tie = k_cast_tie * cast.size();
  const auto separates = [&](const CastTree& x, std::uint32_t slot_x, const CastTree& y, std::uint32_t slot_y) {
    const CastSlab slab = x.slab(slot_x);
    const double rate = slab.normal.dot(cast.direction);
    const double sign = rate < 0.0 ? -1.0 : 1.0;
    const double least = sign * slab.middle - slab.half + support_bound(y, slot_y, sign * slab.normal);
    return least + cast.best.translation * std::abs(rate) >= cast.target - tie;
  };
  return separates(cast.a, a, cast.b, b) || separates(cast.b, b, cast.a, a);
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
#endif  // HWY_ONCE
