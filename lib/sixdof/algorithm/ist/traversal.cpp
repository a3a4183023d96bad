#include <sixdof/algorithm/ist/traversal.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include <Eigen/Geometry>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/algorithm/ist/traversal.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/highway.h>

#include <sixdof/algorithm/ist/node_pair-inl.h>
#include <sixdof/algorithm/ist/pair_sums-inl.h>

// Pairs of nodes are tested in single precision, with slack for the rounding; the pairs of leaves that remain are
// computed in double precision.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ist {
namespace HWY_NAMESPACE {

/// A pair of leaves, each in its own tree's frame.
struct LeafPair {
  const Sphere &a, &b;
  double distance;  ///< Of their centres.

  LeafPair(const SphereTree& tree_a, const SphereTree& tree_b, const Pose& X_AB, std::int32_t leaf_a,
           std::int32_t leaf_b)
      : a(tree_a.leaves[static_cast<std::size_t>(leaf_a)]),
        b(tree_b.leaves[static_cast<std::size_t>(leaf_b)]),
        distance((X_AB * b.center - a.center).norm()) {}
  double gap() const { return distance - (a.radius + b.radius); }
  bool overlap() const { return gap() < 0.0; }
};

/// Finds all pairs of leaves that overlap, and possibly some whose gap is within the rounding of the test.
/// @return their number; they are in scratch.leaf_pairs
std::size_t find_leaf_pairs(const SphereTree& a, const SphereTree& b, const NodeTransform& transform,
                            TraversalScratch& scratch, TraversalCount& count) {
  constexpr std::size_t k_batch = 64;  // pairs of nodes that are expanded between two checks of the lists' capacity
  constexpr std::size_t k_ahead = 12;  // pairs between prefetching nodes and testing them
  const NodePairExpansion expansion(a, b, transform);
  PairList &queue = scratch.node_pairs, &leaves = scratch.leaf_pairs;
  queue.make_room(1);
  queue.a[0] = queue.b[0] = 0;
  std::size_t next = 0, queued = 1, found = 0;
  // Breadth first: the nodes to be tested are known long enough before to be prefetched.
  while (next < queued) {
    const std::size_t end = std::min(queued, next + k_batch);
    queue.make_room(queued + k_batch * k_pairs);
    leaves.make_room(found + k_batch * k_pairs);
    expansion.expand_all<k_ahead>(queue.a.data() + next, queue.b.data() + next, end - next, {queue, queued},
                                  {leaves, found});
    next = end;
  }
  count.sphere_tests += queued * k_pairs;
  return found;
}

void penetration(const SphereTree& a, const SphereTree& b, const Pose& X_AB, const NodeTransform& transform,
                 PairForce law, const Eigen::Vector3d& about, TraversalScratch& scratch, PenetrationSum& sum) {
  constexpr std::size_t k_ahead = 16;  // pairs between prefetching leaves and reading them
  const std::size_t found = find_leaf_pairs(a, b, transform, scratch, sum.count);
  if (found == 0) return;
  const PairList& pairs = scratch.leaf_pairs;
  const auto leaf = [](const SphereTree& tree, std::int32_t index) -> const Sphere& {
    return tree.leaves[static_cast<std::size_t>(index)];
  };
  PairSums sums(law, X_AB, about);
  for (std::size_t i = 0; i < found; ++i) {
    const std::size_t ahead = std::min(i + k_ahead, found - 1);
    __builtin_prefetch(&leaf(a, pairs.a[ahead]));
    __builtin_prefetch(&leaf(b, pairs.b[ahead]));
    const std::int32_t in_a = pairs.a[i], in_b = pairs.b[i];
    const double weight = a.weight(in_a) * b.weight(in_b);
    if (law == PairForce::cones) {
      sums.add(leaf(a, in_a), leaf(b, in_b), weight, a.axis(in_a), b.axis(in_b));
    } else {
      sums.add(leaf(a, in_a), leaf(b, in_b), weight);
    }
  }
  sums.finish(sum);
  sum.count.leaf_pairs = sums.overlapping();
}

/// Depth first, some pairs at a time.
bool overlaps(const SphereTree& a, const SphereTree& b, const Pose& X_AB, const NodeTransform& transform,
              TraversalScratch& scratch, TraversalCount& count) {
  constexpr std::size_t k_batch = 4;  // pairs whose tests the processor can overlap
  const NodePairExpansion expansion(a, b, transform);
  PairList &stack = scratch.node_pairs, &leaves = scratch.leaf_pairs;
  leaves.make_room(k_batch * k_pairs);
  stack.make_room(1);
  stack.a[0] = stack.b[0] = 0;
  for (std::size_t size = 1; size > 0;) {
    const std::size_t taken = std::min(size, k_batch);
    size -= taken;
    std::int32_t batch_a[k_batch], batch_b[k_batch];
    std::copy_n(stack.a.data() + size, taken, batch_a);
    std::copy_n(stack.b.data() + size, taken, batch_b);
    stack.make_room(size + k_batch * k_pairs);
    std::size_t found = 0;
    expansion.expand_all<0>(batch_a, batch_b, taken, {stack, size}, {leaves, found});
    count.sphere_tests += taken * k_pairs;
    for (std::size_t i = 0; i < found; ++i) {
      if (LeafPair(a, b, X_AB, leaves.a[i], leaves.b[i]).overlap()) return true;
    }
  }
  return false;
}

/// Of a pair of nodes that may never be expanded.
struct ExpectedOverlap {
  double volume;
  std::uint64_t order;  ///< Breaks ties: first come, first expanded.
  std::int32_t node_a, node_b;
  Sphere ball_a, ball_b;      ///< Of the two nodes, each in its own tree's frame.
  double volume_a, volume_b;  ///< Of the leaves below.
  double density;             ///< Product of the leaves' densities in both balls.
  bool operator<(const ExpectedOverlap& o) const { return volume != o.volume ? volume < o.volume : order > o.order; }
};

void penetration_within_budget(const SphereTree& a, const SphereTree& b, const Pose& X_AB,
                               const NodeTransform& transform, PairForce law, const Eigen::Vector3d& about,
                               std::uint64_t budget, PenetrationSum& sum) {
  const NodePairExpansion expansion(a, b, transform);
  PairSums sums(law, X_AB, about);
  std::priority_queue<ExpectedOverlap> queue;
  std::uint64_t order = 0;
  const auto push = [&](ExpectedOverlap next) {
    next.order = order++;
    next.density =
        std::min(1.0, next.volume_a / next.ball_a.volume()) * std::min(1.0, next.volume_b / next.ball_b.volume());
    next.volume = next.density * overlap_volume(next.ball_a.radius, next.ball_b.radius,
                                                (next.ball_b.center - next.ball_a.center).norm());
    queue.push(next);
  };
  push({.node_a = 0, .node_b = 0, .ball_a = a.bound, .ball_b = b.bound, .volume_a = a.volume, .volume_b = b.volume});
  while (!queue.empty()) {
    const ExpectedOverlap here = queue.top();
    queue.pop();
    if (sum.count.sphere_tests >= budget) {
      sums.add(here.ball_a, here.ball_b, here.density, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
      continue;
    }
    sum.count.sphere_tests += k_pairs;
    const ChildPairs children = expansion.expand(here.node_a, here.node_b);
    for (unsigned left = children.pairs; left != 0; left &= left - 1) {
      const auto pair = static_cast<unsigned>(__builtin_ctz(left));
      const std::int32_t in_a = children.in_a(pair), in_b = children.in_b(pair);
      if (children.leaves) {
        const LeafPair leaf(a, b, X_AB, in_a, in_b);
        if (!leaf.overlap()) continue;
        sums.add(leaf.a, leaf.b, a.weight(in_a) * b.weight(in_b), a.axis(in_a), b.axis(in_b));
        ++sum.count.leaf_pairs;
        continue;
      }
      ExpectedOverlap next = here;
      next.node_a = in_a;
      next.node_b = in_b;
      if (!children.a_stays()) {
        next.ball_a = a.ball(static_cast<std::size_t>(here.node_a), pair / k_slots);
        next.volume_a = a.volumes[static_cast<std::size_t>(here.node_a)][pair / k_slots];
      }
      if (!children.b_stays()) {
        next.ball_b = b.ball(static_cast<std::size_t>(here.node_b), pair % k_slots);
        next.volume_b = b.volumes[static_cast<std::size_t>(here.node_b)][pair % k_slots];
      }
      push(next);
    }
  }
  sums.finish(sum);
}

void separation(const SphereTree& a, const SphereTree& b, const Pose& X_AB, SphereSeparation& best) {
  struct Bounded {
    double gap;  ///< Lower bound.
    std::int32_t node_a, node_b;
  };
  const NodePairGaps gaps(a, b, X_AB);
  std::vector<Bounded> stack{{-std::numeric_limits<double>::infinity(), 0, 0}};
  std::array<Bounded, k_pairs> found;
  best.distance = std::numeric_limits<double>::infinity();
  while (!stack.empty()) {
    const Bounded here = stack.back();
    stack.pop_back();
    if (here.gap >= best.distance) continue;
    double gap[k_pairs];
    const auto node_a = static_cast<std::size_t>(here.node_a), node_b = static_cast<std::size_t>(here.node_b);
    const unsigned nearer = gaps.measure(a.nodes[node_a], b.nodes[node_b], best.distance, gap);
    best.count.sphere_tests += k_pairs;
    const ChildPairs children(here.node_a, a.first_child[node_a], here.node_b, b.first_child[node_b], nearer);
    std::size_t count = 0;
    for (unsigned left = children.pairs; left != 0; left &= left - 1) {
      const auto pair = static_cast<unsigned>(__builtin_ctz(left));
      const std::int32_t in_a = children.in_a(pair), in_b = children.in_b(pair);
      if (!children.leaves) {
        found[count++] = {children.smallest_gap(gap, pair), in_a, in_b};
      } else if (const double exact = LeafPair(a, b, X_AB, in_a, in_b).gap(); exact < best.distance) {
        best.distance = exact;
        best.leaf_a = in_a;
        best.leaf_b = in_b;
      }
    }
    // The pair with the smallest bound is expanded first, so it is pushed last.
    const auto end = found.begin() + static_cast<std::ptrdiff_t>(count);
    std::sort(found.begin(), end, [](const Bounded& p, const Bounded& q) { return p.gap > q.gap; });
    stack.insert(stack.end(), found.begin(), end);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ist
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::ist {

NodeTransform NodeTransform::of(const SphereTree& a, const SphereTree& b, const Pose& X_AB) {
  // Far above the rounding of the pose's rotation and of the sums below.
  constexpr double k_touch = 1.0 + 1e-12;
  // In overlap all lengths are below T = 2 (1 + ratio). With u = 2^-24 a coordinate of a transformed centre (three
  // products of rounded factors, the rounded translation, three sums) is off by less than 13 u T and the centre by
  // sqrt(3) times that; the differences, squares and sums of the test add less than 9 u T.
  constexpr float k_slack = 32.0f / (1 << 24);
  NodeTransform result;
  const double unit = a.bound.radius, ratio = b.bound.radius / unit;
  const Eigen::Vector3d translation = (X_AB * b.bound.center - a.bound.center) / unit;
  result.apart = !(translation.norm() <= k_touch * (1.0 + ratio));
  if (result.apart) return result;
  result.rotation = (ratio * X_AB.R).cast<float>();
  result.translation = translation.cast<float>();
  result.ratio = static_cast<float>(ratio);
  result.slack = k_slack * 2.0f * (1.0f + result.ratio);
  return result;
}

HWY_EXPORT(penetration);
HWY_EXPORT(penetration_within_budget);
HWY_EXPORT(overlaps);
HWY_EXPORT(separation);

PenetrationSum penetration(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                           const Eigen::Vector3d& about, TraversalScratch& scratch) {
  PenetrationSum sum;
  const auto transform = NodeTransform::of(a, b, X_AB);
  if (!transform.apart) HWY_DYNAMIC_DISPATCH(penetration)(a, b, X_AB, transform, law, about, scratch, sum);
  return sum;
}

PenetrationSum penetration_within_budget(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                                         const Eigen::Vector3d& about, std::uint64_t budget) {
  PenetrationSum sum;
  const auto transform = NodeTransform::of(a, b, X_AB);
  if (!transform.apart) {
    HWY_DYNAMIC_DISPATCH(penetration_within_budget)(a, b, X_AB, transform, law, about, budget, sum);
  }
  return sum;
}

SphereContact overlaps(const SphereTree& a, const SphereTree& b, const Pose& X_AB, TraversalScratch& scratch) {
  SphereContact contact;
  const auto transform = NodeTransform::of(a, b, X_AB);
  if (!transform.apart) contact.any = HWY_DYNAMIC_DISPATCH(overlaps)(a, b, X_AB, transform, scratch, contact.count);
  return contact;
}

SphereSeparation separation(const SphereTree& a, const SphereTree& b, const Pose& X_AB) {
  SphereSeparation best;
  HWY_DYNAMIC_DISPATCH(separation)(a, b, X_AB, best);
  return best;
}

Wrench steepest_descent(const PenetrationSum& sum) {
  if (!(sum.volume > 0.0)) return {};
  const Eigen::Vector3d centroid = sum.first_moment / sum.volume;
  const double gyration = std::sqrt(std::max(0.0, sum.second_moment / sum.volume - centroid.squaredNorm()));
  const double moment = (sum.moment - centroid.cross(sum.force)).norm();
  // A single pair has no radius of gyration; its moment about the centroid is rounding.
  const double norm = std::hypot(sum.force.norm(), gyration > 0.0 ? moment / gyration : 0.0);
  if (!(norm > 0.0)) return {};
  const double scale = sum.volume / norm;
  return {scale * sum.force, scale * sum.moment};
}

}  // namespace sixdof::ist
#endif  // HWY_ONCE
