#include <sixdof/algorithm/ist/traversal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/algorithm/ist/traversal.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Four balls of B, moved to A's frame, are tested at once against each ball of A. No fused multiply-add is used, so
// every instruction set gives the same bits.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ist {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes4 = hn::CappedTag<double, 4>;
using Entry = std::pair<std::int32_t, std::int32_t>;

/// Children of a node side by side, or a leaf by itself, in A's frame.
struct Balls {
  const double *x, *y, *z, *r;
  const std::int32_t* child;
};

/// Moves four balls to A's frame. A single one is moved by the same operations in the same order, see move_one().
HWY_INLINE void move_four(const SphereNode& node, const Pose& X, double* x_out, double* y_out, double* z_out) {
  const Lanes4 d;
  const std::size_t n = hn::Lanes(d);
  double* const out[3] = {x_out, y_out, z_out};
  for (std::size_t l = 0; l < 4; l += n) {
    const auto x = hn::LoadU(d, node.x.data() + l);
    const auto y = hn::LoadU(d, node.y.data() + l);
    const auto z = hn::LoadU(d, node.z.data() + l);
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto rotated = hn::Add(hn::Add(hn::Mul(hn::Set(d, X.R(k, 0)), x), hn::Mul(hn::Set(d, X.R(k, 1)), y)),
                                   hn::Mul(hn::Set(d, X.R(k, 2)), z));
      hn::Store(hn::Add(rotated, hn::Set(d, X.t[k])), d, out[k] + l);
    }
  }
}

double move_one(const Eigen::Vector3d& p, const Pose& X, Eigen::Index k) {
  return X.R(k, 0) * p.x() + X.R(k, 1) * p.y() + X.R(k, 2) * p.z() + X.t[k];
}

/// Squared distances of the centres of four balls from that of ball `i` of `one`, and the sums of their radii.
struct Reach {
  hn::Vec<Lanes4> squared, radii;
  HWY_INLINE Reach(const Balls& four, std::size_t l, const Balls& one, std::size_t i) {
    const Lanes4 d;
    const auto dx = hn::Sub(hn::LoadU(d, four.x + l), hn::Set(d, one.x[i]));
    const auto dy = hn::Sub(hn::LoadU(d, four.y + l), hn::Set(d, one.y[i]));
    const auto dz = hn::Sub(hn::LoadU(d, four.z + l), hn::Set(d, one.z[i]));
    squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    radii = hn::Add(hn::LoadU(d, four.r + l), hn::Set(d, one.r[i]));
  }
};

/// Bit j is set if ball j of `four` overlaps ball `i` of `one`.
HWY_INLINE unsigned overlap_mask(const Balls& four, const Balls& one, std::size_t i) {
  const Lanes4 d;
  const std::size_t n = hn::Lanes(d);
  unsigned mask = 0;
  for (std::size_t l = 0; l < 4; l += n) {
    const Reach reach(four, l, one, i);
    const auto hit =
        hn::And(hn::Gt(reach.radii, hn::Zero(d)), hn::Lt(reach.squared, hn::Mul(reach.radii, reach.radii)));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hit, bits);
    mask |= static_cast<unsigned>(bits[0] & ((1u << n) - 1u)) << l;
  }
  return mask;
}

/// Gaps (distance of centres minus both radii) of ball `i` of `one` to four balls; +infinity for empty slots.
HWY_INLINE void gaps(const Balls& four, const Balls& one, std::size_t i, double* out) {
  const Lanes4 d;
  for (std::size_t l = 0; l < 4; l += hn::Lanes(d)) {
    const Reach reach(four, l, one, i);
    hn::StoreU(hn::Sub(hn::Sqrt(reach.squared), reach.radii), d, out + l);
  }
}

/// A pair of nodes, opened: their children against each other, four at a time. One of the two may be a leaf, which is
/// tested against the other's four children at once.
class OpenPair {
 public:
  OpenPair(const SphereTree& a, const SphereTree& b, const Pose& X_AB) : tree_a_(a), tree_b_(b), X_AB_(X_AB) {}

  HWY_INLINE void open(Entry entry) {
    entry_ = entry;
    if (entry.first >= 0) {
      const SphereNode& node = tree_a_.nodes[static_cast<std::size_t>(entry.first)];
      a_ = {node.x.data(), node.y.data(), node.z.data(), node.r.data(), node.child.data()};
    } else {
      const Sphere& leaf = tree_a_.leaves[static_cast<std::size_t>(~entry.first)];
      a_ = {&leaf.center.x(), &leaf.center.y(), &leaf.center.z(), &leaf.radius, &entry_.first};
    }
    if (entry.second >= 0) {
      const SphereNode& node = tree_b_.nodes[static_cast<std::size_t>(entry.second)];
      move_four(node, X_AB_, x_, y_, z_);
      b_ = {x_, y_, z_, node.r.data(), node.child.data()};
    } else {
      const Sphere& leaf = tree_b_.leaves[static_cast<std::size_t>(~entry.second)];
      x_[0] = move_one(leaf.center, X_AB_, 0);
      y_[0] = move_one(leaf.center, X_AB_, 1);
      z_[0] = move_one(leaf.center, X_AB_, 2);
      b_ = {x_, y_, z_, &leaf.radius, &entry_.second};
    }
  }

  /// Calls meet(i, j) for every child i of A's node and j of B's that overlap, until it returns true; says whether it
  /// did. All are tested before the first is met: one loop over what was found is easier to foresee than four.
  template <class Meet>
  HWY_INLINE bool any_overlap(TraversalCount& count, const Meet& meet) const {
    const bool leaf_b = entry_.second < 0;
    const std::size_t tests = leaf_b ? 1 : rows();
    unsigned found = 0;
    for (std::size_t k = 0; k < tests; ++k) {
      found |= overlap_mask(leaf_b ? a_ : b_, leaf_b ? b_ : a_, k) << (4 * k);
    }
    count.sphere_tests += 4 * tests;
    for (; found != 0; found &= found - 1) {
      const auto bit = static_cast<std::size_t>(__builtin_ctz(found));
      const std::size_t one = bit / 4, lane = bit % 4;
      if (leaf_b ? meet(lane, one) : meet(one, lane)) return true;
    }
    return false;
  }

  /// Calls meet(i, j, gap) for every two children nearer than `within`, which meet() may lower.
  template <class Meet>
  HWY_ATTR void for_each_nearer(const double& within, TraversalCount& count, const Meet& meet) const {
    const auto measure = [&](const Balls& four, const Balls& one, std::size_t k, const auto& meet_lane) HWY_ATTR {
      count.sphere_tests += 4;
      double gap[4];
      gaps(four, one, k, gap);
      for (std::size_t lane = 0; lane < 4; ++lane) {
        if (gap[lane] < within && four.child[lane] != SphereNode::k_empty) meet_lane(lane, gap[lane]);
      }
    };
    if (entry_.second < 0) {
      measure(a_, b_, 0, [&](std::size_t i, double gap) { meet(i, std::size_t{0}, gap); });
      return;
    }
    for (std::size_t i = 0; i < rows(); ++i) {
      measure(b_, a_, i, [&](std::size_t j, double gap) { meet(i, j, gap); });
    }
  }

  Entry children(std::size_t i, std::size_t j) const { return {a_.child[i], b_.child[j]}; }
  bool leaves(std::size_t i, std::size_t j) const { return a_.child[i] < 0 && b_.child[j] < 0; }
  Sphere ball_a(std::size_t i) const { return {{a_.x[i], a_.y[i], a_.z[i]}, a_.r[i]}; }
  Sphere ball_b(std::size_t j) const { return {{b_.x[j], b_.y[j], b_.z[j]}, b_.r[j]}; }
  double volume_a(std::size_t i) const { return volume(tree_a_, entry_.first, i); }
  double volume_b(std::size_t j) const { return volume(tree_b_, entry_.second, j); }

 private:
  /// Children of A's node. Nodes fill their slots from the first on.
  std::size_t rows() const {
    if (entry_.first < 0) return 1;
    std::size_t count = 4;
    while (a_.child[count - 1] == SphereNode::k_empty) --count;
    return count;
  }
  static double volume(const SphereTree& tree, std::int32_t index, std::size_t slot) {
    return index >= 0 ? tree.nodes[static_cast<std::size_t>(index)].volume[slot]
                      : tree.leaves[static_cast<std::size_t>(~index)].volume();
  }

  const SphereTree& tree_a_;
  const SphereTree& tree_b_;
  const Pose& X_AB_;
  Entry entry_;
  Balls a_{}, b_{};
  HWY_ALIGN double x_[4], y_[4], z_[4];  ///< B's balls in A's frame.
};

/// Asks for the cache lines of what will be opened soon.
inline void prefetch(const SphereTree& tree, std::int32_t index) {
  if (index < 0) {
    __builtin_prefetch(&tree.leaves[static_cast<std::size_t>(~index)]);
    return;
  }
  constexpr std::size_t k_line = 64;
  const auto* const bytes = reinterpret_cast<const char*>(&tree.nodes[static_cast<std::size_t>(index)]);
  for (std::size_t at = 0; at < sizeof(SphereNode); at += k_line) __builtin_prefetch(bytes + at);
}

enum class Order {
  depth_first,   ///< Finds the first leaves soon.
  breadth_first  ///< Knows long before which nodes come next, so that they are in the cache by then.
};

/// Calls leaf(pair, i, j) for every two leaf spheres that overlap until it returns true; says whether it did.
template <Order k_order, class Leaf>
HWY_ATTR bool any_leaf_pair(const SphereTree& a, const SphereTree& b, const Pose& X_AB, TraversalScratch& scratch,
                            TraversalCount& count, const Leaf& leaf) {
  constexpr std::size_t k_ahead = 6;  // entries between asking for a node and opening it
  auto& waiting = scratch.waiting;
  waiting.assign(1, {0, 0});
  OpenPair pair(a, b, X_AB);
  const auto open_all = [&](std::size_t i, std::size_t j) HWY_ATTR {
    if (pair.leaves(i, j)) return leaf(pair, i, j);
    waiting.push_back(pair.children(i, j));
    return false;
  };
  if constexpr (k_order == Order::breadth_first) {
    for (std::size_t next = 0; next < waiting.size(); ++next) {
      if (next + k_ahead < waiting.size()) {
        prefetch(a, waiting[next + k_ahead].first);
        prefetch(b, waiting[next + k_ahead].second);
      }
      pair.open(waiting[next]);
      if (pair.any_overlap(count, open_all)) return true;
    }
  } else {
    while (!waiting.empty()) {
      pair.open(waiting.back());
      waiting.pop_back();
      if (pair.any_overlap(count, open_all)) return true;
    }
  }
  return false;
}

/// Sums over pairs of overlapping balls, collected and then computed four at a time. Each of the four lanes has sums of
/// its own, which are added last: the same bits on every instruction set.
class PairSums {
 public:
  PairSums(PairForce law, const Eigen::Vector3d& about) : law_(law), about_(about) {}

  /// The overlap of two balls (in A's frame), scaled by `share`.
  HWY_ATTR void add(const Sphere& in_a, const Sphere& in_b, double share) {
    put(in_a, in_b, share);
    if (filled_ == k_batch) flush();
  }

  HWY_ATTR void finish(PenetrationSum& sum) {
    while (filled_ % k_lanes != 0) put({{0, 0, 0}, 1.0}, {{1, 0, 0}, 1.0}, 0.0);
    flush();
    for (std::size_t lane = 0; lane < k_lanes; ++lane) {
      sum.volume += total_[k_volume][lane];
      for (std::size_t k = 0; k < 3; ++k) {
        sum.force[static_cast<Eigen::Index>(k)] += total_[k_force + k][lane];
        sum.moment[static_cast<Eigen::Index>(k)] += total_[k_moment + k][lane];
      }
    }
  }

 private:
  static constexpr std::size_t k_lanes = 4;
  static constexpr std::size_t k_batch = 32;  ///< Numbers stored one by one are not read as vectors at once.
  enum Input : std::size_t {
    k_a,            ///< Centre of A's ball, three rows.
    k_b = k_a + 3,  ///< Centre of B's ball.
    k_radius_a = k_b + 3,
    k_radius_b,
    k_share,
    k_inputs
  };
  enum Output : std::size_t {
    k_volume,
    k_force,
    k_moment = k_force + 3,
    k_outputs = k_moment + 3
  };

  void put(const Sphere& in_a, const Sphere& in_b, double share) {
    const double lane[k_inputs] = {in_a.center.x(), in_a.center.y(), in_a.center.z(),
                                   in_b.center.x(), in_b.center.y(), in_b.center.z(),
                                   in_a.radius,     in_b.radius,     share};
    for (std::size_t i = 0; i < k_inputs; ++i) pair_[i][filled_] = lane[i];
    ++filled_;
  }

  HWY_ATTR void flush() {
    const Lanes4 d;
    for (std::size_t first = 0; first < filled_; first += hn::Lanes(d)) compute(first);
    filled_ = 0;
  }

  /// Volume and disc area as overlap_volume() and overlap_disc_area() have them.
  HWY_INLINE void compute(std::size_t first) {
    const Lanes4 d;
    const std::size_t sums = first % k_lanes;
    const auto constant = [&](double value) HWY_ATTR { return hn::Set(d, value); };
    constexpr double k_pi = std::numbers::pi;
    const auto in = [&](std::size_t i) HWY_ATTR { return hn::Load(d, pair_[i] + first); };
    const auto zero = hn::Zero(d), r1 = in(k_radius_a), r2 = in(k_radius_b), share = in(k_share);
    const auto x = hn::Sub(in(k_b), in(k_a)), y = hn::Sub(in(k_b + 1), in(k_a + 1)),
               z = hn::Sub(in(k_b + 2), in(k_a + 2));
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
    auto magnitude = volume;
    if (law_ == PairForce::gradient) {
      const auto to_plane = hn::Div(hn::Add(squared, hn::Mul(difference, sum)), hn::Mul(constant(2.0), distance));
      const auto disc = hn::Max(hn::Sub(hn::Mul(r1, r1), hn::Mul(to_plane, to_plane)), zero);
      const auto crossing = hn::Mul(share, hn::Mul(constant(k_pi), disc));
      magnitude = hn::IfThenElse(hn::Or(contained, hn::Ge(distance, sum)), zero, crossing);
    }
    // Concentric balls have no direction to push.
    const auto factor = hn::IfThenElse(hn::Gt(distance, zero), hn::Div(magnitude, distance), zero);
    const auto fx = hn::Mul(factor, x), fy = hn::Mul(factor, y), fz = hn::Mul(factor, z);
    // The force's line of action is the line of centres, so any point on it gives the torque.
    const auto ax = hn::Sub(in(k_b), constant(about_.x())), ay = hn::Sub(in(k_b + 1), constant(about_.y())),
               az = hn::Sub(in(k_b + 2), constant(about_.z()));
    const auto add_to = [&](std::size_t i, auto value)
                            HWY_ATTR { hn::Store(hn::Add(hn::Load(d, total_[i] + sums), value), d, total_[i] + sums); };
    add_to(k_volume, volume);
    add_to(k_force, fx);
    add_to(k_force + 1, fy);
    add_to(k_force + 2, fz);
    add_to(k_moment, hn::Sub(hn::Mul(ay, fz), hn::Mul(az, fy)));
    add_to(k_moment + 1, hn::Sub(hn::Mul(az, fx), hn::Mul(ax, fz)));
    add_to(k_moment + 2, hn::Sub(hn::Mul(ax, fy), hn::Mul(ay, fx)));
  }

  PairForce law_;
  Eigen::Vector3d about_;
  std::size_t filled_ = 0;
  HWY_ALIGN double pair_[k_inputs][k_batch];
  HWY_ALIGN double total_[k_outputs][k_lanes] = {};
};

HWY_ATTR void SumAll(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                     const Eigen::Vector3d& about, TraversalScratch& scratch, PenetrationSum& sum) {
  PairSums sums(law, about);
  any_leaf_pair<Order::breadth_first>(a, b, X_AB, scratch, sum.count,
                                      [&](const OpenPair& pair, std::size_t i, std::size_t j) HWY_ATTR {
                                        sums.add(pair.ball_a(i), pair.ball_b(j), 1.0);
                                        ++sum.count.leaf_pairs;
                                        return false;
                                      });
  sums.finish(sum);
}

HWY_ATTR bool AnyOverlap(const SphereTree& a, const SphereTree& b, const Pose& X_AB, TraversalScratch& scratch,
                         TraversalCount& count) {
  return any_leaf_pair<Order::depth_first>(a, b, X_AB, scratch, count,
                                           [](const OpenPair&, std::size_t, std::size_t) { return true; });
}

/// A pair of nodes waiting to be opened, with what to assume of it if it never is.
struct Expectation {
  double volume;        ///< Expected overlap volume.
  std::uint64_t order;  ///< Breaks ties: first come, first opened.
  Entry entry;
  Sphere in_a, in_b;
  double share;  ///< Of the balls' lens.
  bool operator<(const Expectation& o) const { return volume != o.volume ? volume < o.volume : order > o.order; }
};

HWY_ATTR void SumWithin(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                        const Eigen::Vector3d& about, std::uint64_t budget, PenetrationSum& sum) {
  PairSums sums(law, about);
  std::priority_queue<Expectation> waiting;
  std::uint64_t order = 0;
  const auto wait = [&](Entry entry, const Sphere& in_a, double volume_a, const Sphere& in_b, double volume_b) {
    const double share = std::min(1.0, volume_a / in_a.volume()) * std::min(1.0, volume_b / in_b.volume());
    const double lens = overlap_volume(in_a.radius, in_b.radius, (in_b.center - in_a.center).norm());
    waiting.push({share * lens, order++, entry, in_a, in_b, share});
  };
  wait({0, 0}, a.bound, a.volume, {X_AB * b.bound.center, b.bound.radius}, b.volume);
  OpenPair pair(a, b, X_AB);
  while (!waiting.empty()) {
    const Expectation next = waiting.top();
    waiting.pop();
    if (sum.count.sphere_tests >= budget) {
      sum.complete = false;
      sums.add(next.in_a, next.in_b, next.share);
      continue;
    }
    pair.open(next.entry);
    pair.any_overlap(sum.count, [&](std::size_t i, std::size_t j) HWY_ATTR {
      if (pair.leaves(i, j)) {
        sums.add(pair.ball_a(i), pair.ball_b(j), 1.0);
        ++sum.count.leaf_pairs;
      } else {
        wait(pair.children(i, j), pair.ball_a(i), pair.volume_a(i), pair.ball_b(j), pair.volume_b(j));
      }
      return false;
    });
  }
  sums.finish(sum);
}

HWY_ATTR void Closest(const SphereTree& a, const SphereTree& b, const Pose& X_AB, SphereSeparation& best) {
  struct Bounded {
    double gap;
    Entry entry;
  };
  std::vector<Bounded> stack{{-std::numeric_limits<double>::infinity(), {0, 0}}};
  std::array<Bounded, 16> found;
  OpenPair pair(a, b, X_AB);
  best.distance = std::numeric_limits<double>::infinity();
  while (!stack.empty()) {
    const Bounded next = stack.back();
    stack.pop_back();
    if (next.gap >= best.distance) continue;
    pair.open(next.entry);
    std::size_t count = 0;
    pair.for_each_nearer(best.distance, best.count, [&](std::size_t i, std::size_t j, double gap) {
      if (pair.leaves(i, j)) {
        best.distance = gap;
        best.leaf_a = ~pair.children(i, j).first;
        best.leaf_b = ~pair.children(i, j).second;
      } else {
        found[count++] = {gap, pair.children(i, j)};
      }
    });
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
  HWY_DYNAMIC_DISPATCH(SumAll)(a, b, X_AB, law, about, scratch, sum);
  return sum;
}

PenetrationSum penetration_within(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                                  const Eigen::Vector3d& about, std::uint64_t budget) {
  PenetrationSum sum;
  HWY_DYNAMIC_DISPATCH(SumWithin)(a, b, X_AB, law, about, budget, sum);
  return sum;
}

SphereContact overlaps(const SphereTree& a, const SphereTree& b, const Pose& X_AB, TraversalScratch& scratch) {
  SphereContact contact;
  contact.any = HWY_DYNAMIC_DISPATCH(AnyOverlap)(a, b, X_AB, scratch, contact.count);
  return contact;
}

SphereSeparation separation(const SphereTree& a, const SphereTree& b, const Pose& X_AB) {
  SphereSeparation best;
  HWY_DYNAMIC_DISPATCH(Closest)(a, b, X_AB, best);
  return best;
}

}  // namespace sixdof::ist
#endif
