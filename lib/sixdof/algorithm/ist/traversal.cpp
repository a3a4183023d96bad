#include <sixdof/algorithm/ist/traversal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

// Vectors are kept in structures here, which sets of unknown vector length (SVE, RVV) do not allow; NEON serves them.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/algorithm/ist/traversal.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/highway.h>

#include <sixdof/algorithm/ist/node_pair-inl.h>

// Pairs of nodes are tested in single precision, with slack; pairs of leaves that pass are computed in double
// precision. No fused multiply-add is used, so every instruction set gives the same bits.

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

/// Sums over pairs of overlapping balls, collected and then computed several at a time. Each of the eight lanes has
/// sums of its own, which are added last: the same bits on every instruction set.
class PairSums {
 public:
  PairSums(PairForce law, const Pose& X_AB, const Eigen::Vector3d& about) : law_(law), X_AB_(X_AB), about_(about) {}

  /// The overlap of a ball of A and a ball of B, each in its own frame, scaled by `share`.
  HWY_ATTR void add(const Sphere& a, const Sphere& b, double share) {
    a_[filled_] = a;
    b_[filled_] = b;
    share_[filled_] = share;
    if (++filled_ == k_batch) flush();
  }

  HWY_ATTR void finish(PenetrationSum& sum) {
    while (filled_ % k_lanes != 0) add(a_[filled_ - 1], b_[filled_ - 1], 0.0);
    flush();
    for (std::size_t lane = 0; lane < k_lanes; ++lane) {
      sum.volume += total_[k_volume][lane];
      sum.second += total_[k_second][lane];
      for (std::size_t k = 0; k < 3; ++k) {
        sum.force[static_cast<Eigen::Index>(k)] += total_[k_force + k][lane];
        sum.moment[static_cast<Eigen::Index>(k)] += total_[k_moment + k][lane];
        sum.first[static_cast<Eigen::Index>(k)] += total_[k_first + k][lane];
      }
    }
  }

  /// How many of the added pairs overlapped.
  std::uint64_t overlapping() const { return overlapping_; }

 private:
  static constexpr std::size_t k_lanes = 8;
  static constexpr std::size_t k_batch = 32;  ///< What was just written is not read at once as wider vectors.
  using Lanes = hn::CappedTag<double, k_lanes>;
  enum Output : std::size_t {
    k_volume,
    k_force,
    k_moment = k_force + 3,
    k_first = k_moment + 3,
    k_second = k_first + 3,
    k_outputs
  };

  HWY_ATTR void flush() {
    const Lanes d;
    for (std::size_t first = 0; first < filled_; first += hn::Lanes(d)) compute(first);
    filled_ = 0;
  }

  /// Volume and disc area as overlap_volume() and overlap_disc_area() have them.
  HWY_INLINE void compute(std::size_t first) {
    const Lanes d;
    const std::size_t sums = first % k_lanes;
    const auto constant = [&](double value) HWY_ATTR { return hn::Set(d, value); };
    constexpr double k_pi = std::numbers::pi;
    const auto zero = hn::Zero(d), share = hn::LoadU(d, share_ + first);
    static_assert(sizeof(Sphere) == 4 * sizeof(double), "center x, y, z and radius");
    hn::Vec<Lanes> a_x, a_y, a_z, r1, b_x, b_y, b_z, r2;
    hn::LoadInterleaved4(d, &a_[first].center.x(), a_x, a_y, a_z, r1);
    hn::LoadInterleaved4(d, &b_[first].center.x(), b_x, b_y, b_z, r2);
    const auto moved = [&](Eigen::Index k) HWY_ATTR {
      const auto turned = hn::Add(hn::Add(hn::Mul(constant(X_AB_.R(k, 0)), b_x), hn::Mul(constant(X_AB_.R(k, 1)), b_y)),
                                  hn::Mul(constant(X_AB_.R(k, 2)), b_z));
      return hn::Add(turned, constant(X_AB_.t[k]));
    };
    const auto p_x = moved(0), p_y = moved(1), p_z = moved(2);
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
    const auto volume = hn::Mul(share, hn::IfThenElse(contained, ball, lens));
    const auto ax = hn::Sub(p_x, constant(about_.x())), ay = hn::Sub(p_y, constant(about_.y())),
               az = hn::Sub(p_z, constant(about_.z()));
    const auto add_to = [&](std::size_t i, auto value)
                            HWY_ATTR { hn::Store(hn::Add(hn::Load(d, total_[i] + sums), value), d, total_[i] + sums); };
    auto magnitude = volume;
    if (law_ == PairForce::gradient) {
      const auto to_plane = hn::Div(hn::Add(squared, hn::Mul(difference, sum)), hn::Mul(constant(2.0), distance));
      const auto disc = hn::Max(hn::Sub(hn::Mul(r1, r1), hn::Mul(to_plane, to_plane)), zero);
      const auto crossing = hn::Mul(share, hn::Mul(constant(k_pi), disc));
      magnitude = hn::IfThenElse(hn::Or(contained, hn::Ge(distance, sum)), zero, crossing);
      // The middle of the disc, or the centre of the ball inside the other, seen from B's centre.
      const auto in_b = hn::IfThenElse(hn::Lt(r1, r2), constant(-1.0), zero);
      const auto back = hn::IfThenElse(contained, in_b, hn::Sub(hn::Div(to_plane, distance), constant(1.0)));
      const auto mx = hn::Add(ax, hn::Mul(back, x)), my = hn::Add(ay, hn::Mul(back, y)),
                 mz = hn::Add(az, hn::Mul(back, z));
      add_to(k_first, hn::Mul(volume, mx));
      add_to(k_first + 1, hn::Mul(volume, my));
      add_to(k_first + 2, hn::Mul(volume, mz));
      add_to(k_second, hn::Mul(volume, hn::Add(hn::Add(hn::Mul(mx, mx), hn::Mul(my, my)), hn::Mul(mz, mz))));
    }
    const auto overlap = hn::And(hn::Lt(distance, sum), hn::Gt(share, zero));
    overlapping_ += hn::CountTrue(d, overlap);
    // Concentric balls have no direction to push.
    const auto factor = hn::IfThenElse(hn::Gt(distance, zero), hn::Div(magnitude, distance), zero);
    const auto fx = hn::Mul(factor, x), fy = hn::Mul(factor, y), fz = hn::Mul(factor, z);
    // The force's line of action is the line of centres, so any point on it gives the torque.
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
  double share_[k_batch];
  HWY_ALIGN double total_[k_outputs][k_lanes] = {};
};

/// Finds all pairs of leaves that overlap, and a few more. @return how many are in scratch.leaves.
HWY_ATTR std::size_t FindLeafPairs(const SphereTree& a, const SphereTree& b, const NodePlacement& placement,
                                   TraversalScratch& scratch, TraversalCount& count) {
  constexpr std::size_t k_batch = 64;  // pairs of nodes between two looks at the memory left
  constexpr std::size_t k_ahead = 12;  // pairs between asking for nodes and testing them
  const NodePairs nodes(a, b, placement);
  PairList &waiting = scratch.waiting, &leaves = scratch.leaves;
  waiting.make_room(1);
  waiting.a[0] = waiting.b[0] = 0;
  std::size_t next = 0, waits = 1, found = 0;
  // First come, first tested: so it is known long before which nodes come next.
  while (next < waits) {
    const std::size_t end = std::min(waits, next + k_batch);
    waiting.make_room(waits + k_batch * k_pairs);
    leaves.make_room(found + k_batch * k_pairs);
    nodes.descend_all<k_ahead>(waiting.a.data() + next, waiting.b.data() + next, end - next, {waiting, waits},
                               {leaves, found});
    next = end;
  }
  count.sphere_tests += waits * k_pairs;
  return found;
}

HWY_ATTR void SumAll(const SphereTree& a, const SphereTree& b, const Pose& X_AB, const NodePlacement& placement,
                     PairForce law, const Eigen::Vector3d& about, TraversalScratch& scratch, PenetrationSum& sum) {
  constexpr std::size_t k_ahead = 16;  // pairs between asking for leaves and reading them
  const std::size_t found = FindLeafPairs(a, b, placement, scratch, sum.count);
  if (found == 0) return;
  const PairList& pairs = scratch.leaves;
  const auto leaf = [](const SphereTree& tree, std::int32_t index) -> const Sphere& {
    return tree.leaves[static_cast<std::size_t>(index)];
  };
  PairSums sums(law, X_AB, about);
  for (std::size_t i = 0; i < found; ++i) {
    const std::size_t soon = std::min(i + k_ahead, found - 1);
    __builtin_prefetch(&leaf(a, pairs.a[soon]));
    __builtin_prefetch(&leaf(b, pairs.b[soon]));
    sums.add(leaf(a, pairs.a[i]), leaf(b, pairs.b[i]), a.share(pairs.a[i]) * b.share(pairs.b[i]));
  }
  sums.finish(sum);
  sum.count.leaf_pairs = sums.overlapping();
}

/// Some pairs of nodes at a time, the deepest first: finds the first leaves soon.
HWY_ATTR bool AnyOverlap(const SphereTree& a, const SphereTree& b, const Pose& X_AB, const NodePlacement& placement,
                         TraversalScratch& scratch, TraversalCount& count) {
  constexpr std::size_t k_some = 4;  // enough that one pair need not wait for another
  const NodePairs nodes(a, b, placement);
  PairList &waiting = scratch.waiting, &leaves = scratch.leaves;
  leaves.make_room(k_some * k_pairs);
  waiting.make_room(1);
  waiting.a[0] = waiting.b[0] = 0;
  for (std::size_t waits = 1; waits > 0;) {
    const std::size_t taken = std::min(waits, k_some);
    waits -= taken;
    std::int32_t now_a[k_some], now_b[k_some];
    std::copy_n(waiting.a.data() + waits, taken, now_a);
    std::copy_n(waiting.b.data() + waits, taken, now_b);
    waiting.make_room(waits + k_some * k_pairs);
    std::size_t found = 0;
    nodes.descend_all<0>(now_a, now_b, taken, {waiting, waits}, {leaves, found});
    count.sphere_tests += taken * k_pairs;
    for (std::size_t i = 0; i < found; ++i) {
      if (LeafPair(a, b, X_AB, leaves.a[i], leaves.b[i]).overlap()) return true;
    }
  }
  return false;
}

/// A pair of nodes waiting to be opened, with what to assume of it if it never is.
struct Expectation {
  double volume;        ///< Expected overlap volume.
  std::uint64_t order;  ///< Breaks ties: first come, first opened.
  std::int32_t node_a, node_b;
  Sphere in_a, in_b;          ///< The balls around what lies below, each in its own tree's frame.
  double volume_a, volume_b;  ///< Of the leaves below.
  double share;               ///< Of the balls' lens.
  bool operator<(const Expectation& o) const { return volume != o.volume ? volume < o.volume : order > o.order; }
};

HWY_ATTR void SumWithin(const SphereTree& a, const SphereTree& b, const Pose& X_AB, const NodePlacement& placement,
                        PairForce law, const Eigen::Vector3d& about, std::uint64_t budget, PenetrationSum& sum) {
  const NodePairs nodes(a, b, placement);
  PairSums sums(law, X_AB, about);
  std::priority_queue<Expectation> waiting;
  std::uint64_t order = 0;
  const auto wait = [&](Expectation next) {
    next.order = order++;
    next.share = std::min(1.0, next.volume_a / next.in_a.volume()) * std::min(1.0, next.volume_b / next.in_b.volume());
    next.volume =
        next.share * overlap_volume(next.in_a.radius, next.in_b.radius, (next.in_b.center - next.in_a.center).norm());
    waiting.push(next);
  };
  wait({.node_a = 0, .node_b = 0, .in_a = a.bound, .in_b = b.bound, .volume_a = a.volume, .volume_b = b.volume});
  while (!waiting.empty()) {
    const Expectation here = waiting.top();
    waiting.pop();
    if (sum.count.sphere_tests >= budget) {
      sum.complete = false;
      sums.add(here.in_a, here.in_b, here.share);
      continue;
    }
    sum.count.sphere_tests += k_pairs;
    const Descent below = nodes.descend(here.node_a, here.node_b);
    for (unsigned left = below.pairs; left != 0; left &= left - 1) {
      const auto pair = static_cast<unsigned>(__builtin_ctz(left));
      const std::int32_t in_a = below.in_a(pair), in_b = below.in_b(pair);
      if (below.leaves) {
        const LeafPair leaf(a, b, X_AB, in_a, in_b);
        if (!leaf.overlap()) continue;
        sums.add(leaf.a, leaf.b, a.share(in_a) * b.share(in_b));
        ++sum.count.leaf_pairs;
        continue;
      }
      Expectation next = here;
      next.node_a = in_a;
      next.node_b = in_b;
      if (below.others_a != 0) {
        next.in_a = a.ball(static_cast<std::size_t>(here.node_a), pair / k_slots);
        next.volume_a = a.volumes[static_cast<std::size_t>(here.node_a)][pair / k_slots];
      }
      if (below.others_b != 0) {
        next.in_b = b.ball(static_cast<std::size_t>(here.node_b), pair % k_slots);
        next.volume_b = b.volumes[static_cast<std::size_t>(here.node_b)][pair % k_slots];
      }
      wait(next);
    }
  }
  sums.finish(sum);
}

HWY_ATTR void Closest(const SphereTree& a, const SphereTree& b, const Pose& X_AB, SphereSeparation& best) {
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
    const Descent below(here.node_a, a.below[node_a], here.node_b, b.below[node_b], nearer);
    std::size_t count = 0;
    for (unsigned left = below.pairs; left != 0; left &= left - 1) {
      const auto pair = static_cast<unsigned>(__builtin_ctz(left));
      const std::int32_t in_a = below.in_a(pair), in_b = below.in_b(pair);
      if (!below.leaves) {
        found[count++] = {below.least(gap, pair), in_a, in_b};
      } else if (const double exact = LeafPair(a, b, X_AB, in_a, in_b).gap(); exact < best.distance) {
        best.distance = exact;
        best.leaf_a = in_a;
        best.leaf_b = in_b;
      }
    }
    // The most promising pair is opened first, i.e. pushed last.
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

HWY_EXPORT(SumAll);
HWY_EXPORT(SumWithin);
HWY_EXPORT(AnyOverlap);
HWY_EXPORT(Closest);

PenetrationSum penetration(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                           const Eigen::Vector3d& about, TraversalScratch& scratch) {
  PenetrationSum sum;
  const auto placement = NodePlacement::of(a, b, X_AB);
  if (!placement.apart) HWY_DYNAMIC_DISPATCH(SumAll)(a, b, X_AB, placement, law, about, scratch, sum);
  return sum;
}

PenetrationSum penetration_within(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                                  const Eigen::Vector3d& about, std::uint64_t budget) {
  PenetrationSum sum;
  const auto placement = NodePlacement::of(a, b, X_AB);
  if (!placement.apart) HWY_DYNAMIC_DISPATCH(SumWithin)(a, b, X_AB, placement, law, about, budget, sum);
  return sum;
}

SphereContact overlaps(const SphereTree& a, const SphereTree& b, const Pose& X_AB, TraversalScratch& scratch) {
  SphereContact contact;
  const auto placement = NodePlacement::of(a, b, X_AB);
  if (!placement.apart) contact.any = HWY_DYNAMIC_DISPATCH(AnyOverlap)(a, b, X_AB, placement, scratch, contact.count);
  return contact;
}

SphereSeparation separation(const SphereTree& a, const SphereTree& b, const Pose& X_AB) {
  SphereSeparation best;
  HWY_DYNAMIC_DISPATCH(Closest)(a, b, X_AB, best);
  return best;
}

}  // namespace sixdof::ist
#endif
