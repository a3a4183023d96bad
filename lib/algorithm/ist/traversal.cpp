#include <sixdof/algorithm/ist/traversal.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

/// One node's balls in A's frame.
struct MovedNode {
  HWY_ALIGN double x[4], y[4], z[4];
  const SphereNode* node;
};

HWY_ATTR void move(const SphereNode& node, const Pose& X, MovedNode& moved) {
  const Lanes4 d;
  const std::size_t n = hn::Lanes(d);
  double* const out[3] = {moved.x, moved.y, moved.z};
  for (std::size_t l = 0; l < 4; l += n) {
    const auto x = hn::LoadU(d, node.x.data() + l);
    const auto y = hn::LoadU(d, node.y.data() + l);
    const auto z = hn::LoadU(d, node.z.data() + l);
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto rotated = hn::Add(hn::Add(hn::Mul(hn::Set(d, X.R(k, 0)), x), hn::Mul(hn::Set(d, X.R(k, 1)), y)),
                                   hn::Mul(hn::Set(d, X.R(k, 2)), z));
      hn::StoreU(hn::Add(rotated, hn::Set(d, X.t[k])), d, out[k] + l);
    }
  }
  moved.node = &node;
}

/// Bit j is set if ball `slot` of `a` overlaps ball j of `b`.
HWY_ATTR unsigned overlap_mask(const SphereNode& a, std::size_t slot, const MovedNode& b) {
  const Lanes4 d;
  const std::size_t n = hn::Lanes(d);
  unsigned mask = 0;
  for (std::size_t l = 0; l < 4; l += n) {
    const auto dx = hn::Sub(hn::LoadU(d, b.x + l), hn::Set(d, a.x[slot]));
    const auto dy = hn::Sub(hn::LoadU(d, b.y + l), hn::Set(d, a.y[slot]));
    const auto dz = hn::Sub(hn::LoadU(d, b.z + l), hn::Set(d, a.z[slot]));
    const auto squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    const auto reach = hn::Add(hn::LoadU(d, b.node->r.data() + l), hn::Set(d, a.r[slot]));
    const auto hit = hn::And(hn::Gt(reach, hn::Zero(d)), hn::Lt(squared, hn::Mul(reach, reach)));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hit, bits);
    mask |= static_cast<unsigned>(bits[0] & ((1u << n) - 1u)) << l;
  }
  return mask;
}

/// Gaps (distance of centres minus both radii) of ball `slot` of `a` to the four balls of `b`; +infinity for empty
/// slots.
HWY_ATTR void gaps(const SphereNode& a, std::size_t slot, const MovedNode& b, double* out) {
  const Lanes4 d;
  const std::size_t n = hn::Lanes(d);
  for (std::size_t l = 0; l < 4; l += n) {
    const auto dx = hn::Sub(hn::LoadU(d, b.x + l), hn::Set(d, a.x[slot]));
    const auto dy = hn::Sub(hn::LoadU(d, b.y + l), hn::Set(d, a.y[slot]));
    const auto dz = hn::Sub(hn::LoadU(d, b.z + l), hn::Set(d, a.z[slot]));
    const auto squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    const auto reach = hn::Add(hn::LoadU(d, b.node->r.data() + l), hn::Set(d, a.r[slot]));
    hn::StoreU(hn::Sub(hn::Sqrt(squared), reach), d, out + l);
  }
}

/// A pair of nodes, opened: their children against each other. A leaf counts as a node with one child, itself.
class OpenPair {
 public:
  OpenPair(const SphereTree& a, const SphereTree& b, const Pose& X_AB) : a_(a), b_(b), X_AB_(X_AB) {}

  HWY_ATTR void open(Entry entry) {
    node_a_ = &node(a_, entry.first, dressed_a_);
    node_b_ = &node(b_, entry.second, dressed_b_);
    move(*node_b_, X_AB_, moved_);
  }

  /// Calls meet(i, j) for every two children that overlap, until it returns true; says whether it did.
  template <class Meet>
  HWY_ATTR bool any_overlap(TraversalCount& count, const Meet& meet) const {
    for (std::size_t i = 0; i < 4; ++i) {
      if (node_a_->child[i] == SphereNode::k_empty) continue;
      count.sphere_tests += 4;
      for (unsigned mask = overlap_mask(*node_a_, i, moved_); mask != 0; mask &= mask - 1) {
        if (meet(i, static_cast<std::size_t>(__builtin_ctz(mask)))) return true;
      }
    }
    return false;
  }

  /// Calls meet(i, j, gap) for every two children nearer than `within`, which meet() may lower.
  template <class Meet>
  HWY_ATTR void for_each_nearer(const double& within, TraversalCount& count, const Meet& meet) const {
    for (std::size_t i = 0; i < 4; ++i) {
      if (node_a_->child[i] == SphereNode::k_empty) continue;
      count.sphere_tests += 4;
      double gap[4];
      gaps(*node_a_, i, moved_, gap);
      for (std::size_t j = 0; j < 4; ++j) {
        if (gap[j] < within && node_b_->child[j] != SphereNode::k_empty) meet(i, j, gap[j]);
      }
    }
  }

  Entry children(std::size_t i, std::size_t j) const { return {node_a_->child[i], node_b_->child[j]}; }
  bool leaves(std::size_t i, std::size_t j) const { return node_a_->child[i] < 0 && node_b_->child[j] < 0; }
  Sphere ball_a(std::size_t i) const { return node_a_->sphere(i); }
  Sphere ball_b(std::size_t j) const { return {{moved_.x[j], moved_.y[j], moved_.z[j]}, node_b_->r[j]}; }
  double volume_a(std::size_t i) const { return node_a_->volume[i]; }
  double volume_b(std::size_t j) const { return node_b_->volume[j]; }

 private:
  static const SphereNode& node(const SphereTree& tree, std::int32_t index, SphereNode& dressed) {
    if (index >= 0) return tree.nodes[static_cast<std::size_t>(index)];
    const Sphere& leaf = tree.leaves[static_cast<std::size_t>(~index)];
    dressed.r.fill(-std::numeric_limits<double>::infinity());
    dressed.child.fill(SphereNode::k_empty);
    dressed.x[0] = leaf.center.x();
    dressed.y[0] = leaf.center.y();
    dressed.z[0] = leaf.center.z();
    dressed.r[0] = leaf.radius;
    dressed.volume[0] = leaf.volume();
    dressed.child[0] = index;
    return dressed;
  }

  const SphereTree& a_;
  const SphereTree& b_;
  const Pose& X_AB_;
  const SphereNode* node_a_ = nullptr;
  const SphereNode* node_b_ = nullptr;
  SphereNode dressed_a_{}, dressed_b_{};
  MovedNode moved_;
};

/// Calls leaf(pair, i, j) for every two leaf spheres that overlap, depth first, until it returns true; says whether it
/// did.
template <class Leaf>
HWY_ATTR bool any_leaf_pair(const SphereTree& a, const SphereTree& b, const Pose& X_AB, TraversalScratch& scratch,
                            TraversalCount& count, const Leaf& leaf) {
  auto& stack = scratch.stack;
  stack.assign(1, {0, 0});
  OpenPair pair(a, b, X_AB);
  while (!stack.empty()) {
    pair.open(stack.back());
    stack.pop_back();
    const bool done = pair.any_overlap(count, [&](std::size_t i, std::size_t j) HWY_ATTR {
      if (pair.leaves(i, j)) return leaf(pair, i, j);
      stack.push_back(pair.children(i, j));
      return false;
    });
    if (done) return true;
  }
  return false;
}

struct PairSumming {
  PenetrationSum& sum;
  PairForce law;
  Eigen::Vector3d about;

  /// Adds the overlap of two balls (in A's frame), scaled by `share`.
  void add(const Sphere& in_a, const Sphere& in_b, double share) const {
    const Eigen::Vector3d across = in_b.center - in_a.center;
    const double d = across.norm();
    const double volume = share * overlap_volume(in_a.radius, in_b.radius, d);
    sum.volume += volume;
    if (d == 0.0) return;  // concentric: no direction to push
    const double magnitude = law == PairForce::volume ? volume : share * overlap_disc_area(in_a.radius, in_b.radius, d);
    const Eigen::Vector3d force = across * (magnitude / d);
    sum.force += force;
    // The force's line of action is the line of centres, so any point on it gives the torque.
    sum.moment += (in_b.center - about).cross(force);
  }
};

HWY_ATTR void SumAll(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                     const Eigen::Vector3d& about, TraversalScratch& scratch, PenetrationSum& sum) {
  const PairSumming summing{sum, law, about};
  any_leaf_pair(a, b, X_AB, scratch, sum.count, [&](const OpenPair& pair, std::size_t i, std::size_t j) {
    summing.add(pair.ball_a(i), pair.ball_b(j), 1.0);
    ++sum.count.leaf_pairs;
    return false;
  });
}

HWY_ATTR bool AnyOverlap(const SphereTree& a, const SphereTree& b, const Pose& X_AB, TraversalScratch& scratch,
                         TraversalCount& count) {
  return any_leaf_pair(a, b, X_AB, scratch, count, [](const OpenPair&, std::size_t, std::size_t) { return true; });
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
  const PairSumming summing{sum, law, about};
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
      summing.add(next.in_a, next.in_b, next.share);
      continue;
    }
    pair.open(next.entry);
    pair.any_overlap(sum.count, [&](std::size_t i, std::size_t j) HWY_ATTR {
      if (pair.leaves(i, j)) {
        summing.add(pair.ball_a(i), pair.ball_b(j), 1.0);
        ++sum.count.leaf_pairs;
      } else {
        wait(pair.children(i, j), pair.ball_a(i), pair.volume_a(i), pair.ball_b(j), pair.volume_b(j));
      }
      return false;
    });
  }
}

HWY_ATTR void Closest(const SphereTree& a, const SphereTree& b, const Pose& X_AB, SphereSeparation& best) {
  struct Bounded {
    double gap;
    Entry entry;
  };
  std::vector<Bounded> stack{{-std::numeric_limits<double>::infinity(), {0, 0}}}, found;
  OpenPair pair(a, b, X_AB);
  best.distance = std::numeric_limits<double>::infinity();
  while (!stack.empty()) {
    const Bounded next = stack.back();
    stack.pop_back();
    if (next.gap >= best.distance) continue;
    pair.open(next.entry);
    found.clear();
    pair.for_each_nearer(best.distance, best.count, [&](std::size_t i, std::size_t j, double gap) {
      if (pair.leaves(i, j)) {
        best.distance = gap;
        best.leaf_a = ~pair.children(i, j).first;
        best.leaf_b = ~pair.children(i, j).second;
      } else {
        found.push_back({gap, pair.children(i, j)});
      }
    });
    // The most promising pair is opened first, i.e. pushed last.
    std::sort(found.begin(), found.end(), [](const Bounded& p, const Bounded& q) { return p.gap > q.gap; });
    stack.insert(stack.end(), found.begin(), found.end());
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
