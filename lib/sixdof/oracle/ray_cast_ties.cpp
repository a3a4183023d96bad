#include <sixdof/oracle/ray_cast_ties.h>

#include <algorithm>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include <sixdof/oracle/ray_cast_search.h>
#include <sixdof/proximity/close_search.h>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/ray_cast_ties.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/proximity/double_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

using namespace double_lanes::HWY_NAMESPACE;

/// For each child of a node, a lower bound on axis . p for the points p of its volume, by its box and by its slab.
/// Infinite in lanes without a child.
/// @param rounding by which bounds are lowered
void support_bounds(const PreciseVolumes& volumes, const Eigen::Vector3d& axis, double rounding, double* bounds) {
  const V3 n{set(axis[0]), set(axis[1]), set(axis[2])};
  const auto at = [](const double* p, std::size_t i) { return hn::Load(k_lanes, p + i); };
  for (std::size_t i = 0; i < Tree::k_width; i += hn::Lanes(k_lanes)) {
    const V3 normal = load(volumes.normal, i), center = load(volumes.box_center, i), half = load(volumes.box_half, i);
    // The axis is `along` times the slab's normal plus a rest, for which the box is used.
    const V along = dot(n, normal);
    const V3 rest = n - along * normal;
    const V slab = hn::Sub(hn::Mul(along, at(volumes.middle, i)), hn::Mul(hn::Abs(along), at(volumes.half, i)));
    const V in_slab = hn::Add(slab, hn::Sub(dot(rest, center), dot(abs(rest), half)));
    const V in_box = hn::Sub(dot(n, center), dot(abs(n), half));
    hn::Store(hn::Sub(hn::Max(in_slab, in_box), set(rounding)), k_lanes, bounds + i);
  }
  std::fill(bounds + volumes.child_count, bounds + Tree::k_width, TreeSupport::k_infinity);
}

/// The least axis . (p - center) of some triangles' corners p.
double least_of_corners(std::span<const Tree::Corners> triangles, const Eigen::Vector3d& center,
                        const Eigen::Vector3d& axis) {
  double least = TreeSupport::k_infinity;
  for (const Tree::Corners& t : triangles) {
    for (const Eigen::Vector3d& p : t) least = std::min(least, axis.dot(p - center));
  }
  return least;
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
  x.evaluations += volumes.child_count;
  for (std::size_t i = 0; i < volumes.child_count; ++i) {
    const auto lane = static_cast<std::size_t>(std::min_element(bounds, bounds + Tree::k_width) - bounds);
    least = std::min(least, found.least);
    if (bounds[lane] >= least - x.tolerance || x.evaluations >= x.limit) {
      found.bound = std::min(found.bound, bounds[lane]);
      break;
    }
    bounds[lane] = TreeSupport::k_infinity;
    const Found below = search(x, volumes.child[lane], least);
    found.bound = std::min(found.bound, below.bound);
    found.least = std::min(found.least, below.least);
  }
  if (found.least <= found.bound + x.tolerance) {
    x.known[child.node()] = {std::min(found.bound, found.least), x.axis_number};
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

using Triangles = std::span<const Tree::Corners>;

/// The triangles below a child.
Triangles triangles_of(const Tree& tree, Tree::Child child) {
  if (child.is_leaf()) return tree.corners().subspan(child.first(), child.count());
  const Tree::Node& node = tree.nodes()[child.node()];
  return tree.corners().subspan(node.first_triangle, node.triangle_count);
}

/// Sets slab and box of one lane, relative to `origin`. The slab is the thinnest along the triangles' mean normal.
void fit_precise_volume(Triangles triangles, const Eigen::Vector3d& origin, PreciseVolumes& volumes, std::size_t lane) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Tree::Corners& t : triangles) sum += (t[1] - t[0]).cross(t[2] - t[0]);
  const double scale = sum.cwiseAbs().maxCoeff();
  const Eigen::Vector3d normal = scale > 0.0 ? Eigen::Vector3d((sum / scale).normalized()) : Eigen::Vector3d::UnitX();
  double low = TreeSupport::k_infinity;
  double high = -low;
  Eigen::AlignedBox3d box;
  for (const Tree::Corners& t : triangles) {
    for (const Eigen::Vector3d& corner : t) {
      const Eigen::Vector3d p = corner - origin;
      low = std::min(low, normal.dot(p));
      high = std::max(high, normal.dot(p));
      box.extend(p);
    }
  }
  volumes.middle[lane] = 0.5 * (low + high);
  volumes.half[lane] = 0.5 * (high - low);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    volumes.normal[k][lane] = normal[axis];
    volumes.box_center[k][lane] = 0.5 * (box.min()[axis] + box.max()[axis]);
    volumes.box_half[k][lane] = 0.5 * (box.max()[axis] - box.min()[axis]);
  }
}

}  // namespace

CastMesh::CastMesh(std::shared_ptr<const Tree> tree) : tree_(std::move(tree)) {
  precise_volumes_.resize(tree_->nodes().size());
  for (std::size_t n = 0; n < precise_volumes_.size(); ++n) {
    const Tree::Node& node = tree_->nodes()[n];
    std::copy_n(node.child, Tree::k_width, precise_volumes_[n].child);
    precise_volumes_[n].child_count = node.child_count;
    for (std::size_t lane = 0; lane < node.child_count; ++lane) {
      fit_precise_volume(triangles_of(*tree_, node.child[lane]), tree_->center(), precise_volumes_[n], lane);
    }
  }
}

bool CoplanarPatch::is_facing(const Eigen::Vector3d& axis, const Eigen::Vector3d& direction) const {
  return size > 0.0f && normal.dot(axis) >= k_least_patch_cosine && normal.dot(direction) >= 0.0;
}

TreeSupport::TreeSupport(const CastMesh& mesh) : mesh_(mesh) {}

void TreeSupport::set_axis(const Eigen::Vector3d& axis) {
  axis_ = axis;
  ++axis_number_;
}

double TreeSupport::support_value(std::uint32_t volume, std::uint64_t& budget) {
  const Tree& tree = mesh_.tree();
  if (known_.empty()) known_.resize(tree.nodes().size() + tree.leaves().size());
  const bool is_leaf = (volume & detail::CloseVolume::k_leaf) != 0;
  const std::uint32_t index = volume & ~detail::CloseVolume::k_leaf;
  Known& known = known_[is_leaf ? tree.nodes().size() + index : index];
  if (known.axis_number == axis_number_) return known.value;
  const Tree::Child child = is_leaf ? tree.leaves()[index].child : Tree::Child::node(index);
  if (budget < k_smallest_budget && budget < (is_leaf ? child.count() : tree.nodes()[index].triangle_count)) {
    return k_unknown;
  }
  Search search{.mesh = mesh_,
                .axis = axis_,
                .tolerance = k_support_tolerance * tree.radius(),
                .rounding = k_support_rounding * tree.radius(),
                .known = known_.data(),
                .axis_number = axis_number_,
                .evaluations = 0,
                .limit = budget};
  known = {HWY_DYNAMIC_DISPATCH(find_support_value)(search, child), axis_number_};
  evaluations_ += search.evaluations;
  budget -= std::min(budget, search.evaluations);
  return known.value;
}

double DifferenceSupport::support_value(std::uint32_t a, std::uint32_t b, const Eigen::Vector3d& axis,
                                        std::uint64_t budget) {
  budget_ = std::min(budget_ + budget, k_largest_budget);
  if (!has_axis_ || (axis - axis_).cwiseAbs().maxCoeff() > k_same_axis) {
    has_axis_ = true;
    axis_ = axis;
    a_.set_axis(-axis);
    b_.set_axis(R_.transpose() * axis);
  }
  const double of_a = a_.support_value(a, budget_);
  return of_a == TreeSupport::k_unknown ? of_a : of_a + b_.support_value(b, budget_);
}

bool separated_in_double(const Cast& cast, std::uint32_t a, std::uint32_t b) {
  const Tree& tree_a = cast.a.tree();
  const Tree& tree_b = cast.b.tree();
  const Eigen::Vector3d shift = cast.offset + cast.best.translation * cast.direction;
  const Pose X_AB{.R = cast.R, .t = tree_a.center() + shift - cast.R * tree_b.center()};
  const detail::CloseBounds bounds(tree_a, tree_b, X_AB, cast.reach() * cast.direction);
  const double enough = cast.best.pair ? cast.target - 0.5 * cast.tie() : cast.target;
  return bounds.lower_bound(bounds.shape_of_a({a}), bounds.shape_of_b({b}), cast.best.axis, enough) > enough;
}

}  // namespace sixdof::ray_cast
#endif  // HWY_ONCE
