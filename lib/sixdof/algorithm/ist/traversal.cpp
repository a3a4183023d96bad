#include <sixdof/algorithm/ist/traversal.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include <Eigen/Geometry>

// SIMD vectors are members of structures here, which targets of unknown vector length (SVE, RVV) do not allow.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/algorithm/ist/traversal.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/highway.h>

#include <sixdof/algorithm/ist/node_pair-inl.h>

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

/// Sums over pairs of overlapping spheres, which are collected and then computed several at a time. Each of eight lanes
/// has its own sums, which are added at the end: the same bits on every instruction set.
class PairSums {
 public:
  PairSums(PairForce law, const Pose& X_AB, const Eigen::Vector3d& about) : law_(law), X_AB_(X_AB), about_(about) {}

  /// Adds the overlap of a sphere of A and one of B, each in its own frame, times `weight`.
  void add(const Sphere& a, const Sphere& b, double weight) {
    a_[filled_] = a;
    b_[filled_] = b;
    weight_[filled_] = weight;
    if (++filled_ == k_batch) flush();
  }

  void finish(PenetrationSum& sum) {
    while (filled_ % k_lanes != 0) add(a_[filled_ - 1], b_[filled_ - 1], 0.0);
    flush();
    for (std::size_t lane = 0; lane < k_lanes; ++lane) {
      sum.volume += total_[k_volume][lane];
      sum.second_moment += total_[k_second_moment][lane];
      for (std::size_t k = 0; k < 3; ++k) {
        sum.force[static_cast<Eigen::Index>(k)] += total_[k_force + k][lane];
        sum.moment[static_cast<Eigen::Index>(k)] += total_[k_moment + k][lane];
        sum.first_moment[static_cast<Eigen::Index>(k)] += total_[k_first_moment + k][lane];
      }
    }
  }

  /// Number of added pairs that overlap.
  std::uint64_t overlapping() const { return overlapping_; }

 private:
  static constexpr std::size_t k_lanes = 8;
  static constexpr std::size_t k_batch = 32;  ///< Pairs. Delays reading as vectors what was just written as scalars.
  using Lanes = hn::CappedTag<double, k_lanes>;
  enum Output : std::size_t {
    k_volume,
    k_force,
    k_moment = k_force + 3,
    k_first_moment = k_moment + 3,
    k_second_moment = k_first_moment + 3,
    k_outputs
  };

  void flush() {
    const Lanes d;
    for (std::size_t first = 0; first < filled_; first += hn::Lanes(d)) compute(first);
    filled_ = 0;
  }

  /// Adds the pairs from `first` on, one per SIMD lane. Volumes are those of overlap_volume().
  HWY_INLINE void compute(std::size_t first) {
    const Lanes d;
    const std::size_t sums = first % k_lanes;
    const auto constant = [&](double value) HWY_ATTR { return hn::Set(d, value); };
    constexpr double k_pi = std::numbers::pi;
    const auto zero = hn::Zero(d), weight = hn::LoadU(d, weight_ + first);
    static_assert(sizeof(Sphere) == 4 * sizeof(double), "center x, y, z and radius");
    hn::Vec<Lanes> a_x, a_y, a_z, r1, b_x, b_y, b_z, r2;
    hn::LoadInterleaved4(d, &a_[first].center.x(), a_x, a_y, a_z, r1);
    hn::LoadInterleaved4(d, &b_[first].center.x(), b_x, b_y, b_z, r2);
    const auto transformed = [&](Eigen::Index k) HWY_ATTR {
      const auto rotated =
          hn::Add(hn::Add(hn::Mul(constant(X_AB_.R(k, 0)), b_x), hn::Mul(constant(X_AB_.R(k, 1)), b_y)),
                  hn::Mul(constant(X_AB_.R(k, 2)), b_z));
      return hn::Add(rotated, constant(X_AB_.t[k]));
    };
    const auto p_x = transformed(0), p_y = transformed(1), p_z = transformed(2);
    const auto x = hn::Sub(p_x, a_x), y = hn::Sub(p_y, a_y), z = hn::Sub(p_z, a_z);
    const auto squared = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    const auto distance = hn::Sqrt(squared), sum = hn::Add(r1, r2), difference = hn::Sub(r1, r2);
    const auto contained = hn::Le(distance, hn::Abs(difference));
    const auto smaller = hn::Min(r1, r2);
    const auto ball = hn::Mul(constant(4.0 / 3.0 * k_pi), hn::Mul(smaller, hn::Mul(smaller, smaller)));
    const auto depth = hn::Max(hn::Sub(sum, distance), zero);
    const auto shape = hn::Sub(hn::Add(squared, hn::Mul(constant(2.0), hn::Mul(distance, sum))),
                               hn::Mul(constant(3.0), hn::Mul(difference, difference)));
    const auto lens = hn::Div(hn::Mul(constant(k_pi / 12.0), hn::Mul(hn::Mul(depth, depth), shape)), distance);
    const auto volume = hn::Mul(weight, hn::IfThenElse(contained, ball, lens));
    const auto ax = hn::Sub(p_x, constant(about_.x())), ay = hn::Sub(p_y, constant(about_.y())),
               az = hn::Sub(p_z, constant(about_.z()));
    const auto add_to = [&](std::size_t i, auto value)
                            HWY_ATTR { hn::Store(hn::Add(hn::Load(d, total_[i] + sums), value), d, total_[i] + sums); };
    auto magnitude = volume;
    if (law_ == PairForce::gradient) {
      const auto to_plane = hn::Div(hn::Add(squared, hn::Mul(difference, sum)), hn::Mul(constant(2.0), distance));
      const auto disc = hn::Max(hn::Sub(hn::Mul(r1, r1), hn::Mul(to_plane, to_plane)), zero);
      const auto crossing = hn::Mul(weight, hn::Mul(constant(k_pi), disc));
      magnitude = hn::IfThenElse(hn::Or(contained, hn::Ge(distance, sum)), zero, crossing);
      // Middle of the overlap: centre of the disc, or of the sphere inside the other. It is B's centre plus `back`
      // times the vector (x, y, z) from A's centre to B's.
      const auto in_b = hn::IfThenElse(hn::Lt(r1, r2), constant(-1.0), zero);
      const auto back = hn::IfThenElse(contained, in_b, hn::Sub(hn::Div(to_plane, distance), constant(1.0)));
      const auto mx = hn::Add(ax, hn::Mul(back, x)), my = hn::Add(ay, hn::Mul(back, y)),
                 mz = hn::Add(az, hn::Mul(back, z));
      add_to(k_first_moment, hn::Mul(volume, mx));
      add_to(k_first_moment + 1, hn::Mul(volume, my));
      add_to(k_first_moment + 2, hn::Mul(volume, mz));
      add_to(k_second_moment, hn::Mul(volume, hn::Add(hn::Add(hn::Mul(mx, mx), hn::Mul(my, my)), hn::Mul(mz, mz))));
    }
    const auto overlap = hn::And(hn::Lt(distance, sum), hn::Gt(weight, zero));
    overlapping_ += hn::CountTrue(d, overlap);
    // Concentric spheres exert no force: it would have no direction.
    const auto factor = hn::IfThenElse(hn::Gt(distance, zero), hn::Div(magnitude, distance), zero);
    const auto fx = hn::Mul(factor, x), fy = hn::Mul(factor, y), fz = hn::Mul(factor, z);
    // The force acts along the line of centres, so any point on it may be the end of the arm: here B's centre.
    add_to(k_volume, volume);
    add_to(k_force, fx);
    add_to(k_force + 1, fy);
    add_to(k_force + 2, fz);
    add_to(k_moment, hn::Sub(hn::Mul(ay, fz), hn::Mul(az, fy)));
    add_to(k_moment + 1, hn::Sub(hn::Mul(az, fx), hn::Mul(ax, fz)));
    add_to(k_moment + 2, hn::Sub(hn::Mul(ax, fy), hn::Mul(ay, fx)));
  }

  PairForce law_;
  const Pose& X_AB_;
  Eigen::Vector3d about_;
  std::size_t filled_ = 0;
  std::uint64_t overlapping_ = 0;
  Sphere a_[k_batch], b_[k_batch];
  double weight_[k_batch];
  HWY_ALIGN double total_[k_outputs][k_lanes] = {};
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
    sums.add(leaf(a, pairs.a[i]), leaf(b, pairs.b[i]), a.weight(pairs.a[i]) * b.weight(pairs.b[i]));
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
      sums.add(here.ball_a, here.ball_b, here.density);
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
        sums.add(leaf.a, leaf.b, a.weight(in_a) * b.weight(in_b));
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
