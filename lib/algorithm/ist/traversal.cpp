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

/// A node as it stands, or a leaf dressed as a node with one ball.
const SphereNode& open(const SphereTree& tree, std::int32_t index, SphereNode& dressed) {
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

struct PairSumming {
  PenetrationSum& sum;
  PairForce law;
  Eigen::Vector3d about;

  /// Adds the overlap of two balls (centres in A's frame), scaled by `share`.
  void add(const Eigen::Vector3d& center_a, double r_a, const Eigen::Vector3d& center_b, double r_b,
           double share) const {
    const Eigen::Vector3d across = center_b - center_a;
    const double d = across.norm();
    const double volume = share * overlap_volume(r_a, r_b, d);
    sum.volume += volume;
    if (d == 0.0) return;  // concentric: no direction to push
    const double magnitude = law == PairForce::volume ? volume : share * overlap_disc_area(r_a, r_b, d);
    const Eigen::Vector3d force = across * (magnitude / d);
    sum.force += force;
    // The force's line of action is the line of centres, so any point on it gives the torque.
    sum.moment += (center_b - about).cross(force);
  }
};

bool is_leaf(std::int32_t child) { return child < 0; }

HWY_ATTR void SumAll(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                     const Eigen::Vector3d& about, TraversalScratch& scratch, PenetrationSum& sum) {
  const PairSumming summing{sum, law, about};
  auto& stack = scratch.stack;
  stack.assign(1, {0, 0});
  SphereNode dressed_a{}, dressed_b{};
  MovedNode moved;
  while (!stack.empty()) {
    const auto [ia, ib] = stack.back();
    stack.pop_back();
    const SphereNode& node_a = open(a, ia, dressed_a);
    const SphereNode& node_b = open(b, ib, dressed_b);
    move(node_b, X_AB, moved);
    for (std::size_t i = 0; i < 4; ++i) {
      if (node_a.child[i] == SphereNode::k_empty) continue;
      sum.count.sphere_tests += 4;
      for (unsigned mask = overlap_mask(node_a, i, moved); mask != 0; mask &= mask - 1) {
        const auto j = static_cast<std::size_t>(__builtin_ctz(mask));
        if (is_leaf(node_a.child[i]) && is_leaf(node_b.child[j])) {
          summing.add({node_a.x[i], node_a.y[i], node_a.z[i]}, node_a.r[i], {moved.x[j], moved.y[j], moved.z[j]},
                      node_b.r[j], 1.0);
          ++sum.count.leaf_pairs;
        } else {
          stack.emplace_back(node_a.child[i], node_b.child[j]);
        }
      }
    }
  }
}

/// A pair of nodes waiting to be opened, with what to assume of it if it never is.
struct Expectation {
  double volume;        ///< Expected overlap volume.
  std::uint64_t order;  ///< Breaks ties: first come, first opened.
  Entry entry;
  Eigen::Vector3d center_a, center_b;
  double r_a, r_b, share;
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
    waiting.push({share * lens, order++, entry, in_a.center, in_b.center, in_a.radius, in_b.radius, share});
  };
  wait({0, 0}, a.bound, a.volume, {X_AB * b.bound.center, b.bound.radius}, b.volume);
  SphereNode dressed_a{}, dressed_b{};
  MovedNode moved;
  while (!waiting.empty()) {
    const Expectation next = waiting.top();
    waiting.pop();
    if (sum.count.sphere_tests >= budget) {
      sum.complete = false;
      summing.add(next.center_a, next.r_a, next.center_b, next.r_b, next.share);
      continue;
    }
    const SphereNode& node_a = open(a, next.entry.first, dressed_a);
    const SphereNode& node_b = open(b, next.entry.second, dressed_b);
    move(node_b, X_AB, moved);
    for (std::size_t i = 0; i < 4; ++i) {
      if (node_a.child[i] == SphereNode::k_empty) continue;
      sum.count.sphere_tests += 4;
      for (unsigned mask = overlap_mask(node_a, i, moved); mask != 0; mask &= mask - 1) {
        const auto j = static_cast<std::size_t>(__builtin_ctz(mask));
        const Sphere in_a = node_a.sphere(i);
        const Sphere in_b{{moved.x[j], moved.y[j], moved.z[j]}, node_b.r[j]};
        if (is_leaf(node_a.child[i]) && is_leaf(node_b.child[j])) {
          summing.add(in_a.center, in_a.radius, in_b.center, in_b.radius, 1.0);
          ++sum.count.leaf_pairs;
        } else {
          wait({node_a.child[i], node_b.child[j]}, in_a, node_a.volume[i], in_b, node_b.volume[j]);
        }
      }
    }
  }
}

HWY_ATTR bool AnyOverlap(const SphereTree& a, const SphereTree& b, const Pose& X_AB, TraversalScratch& scratch) {
  auto& stack = scratch.stack;
  stack.assign(1, {0, 0});
  SphereNode dressed_a{}, dressed_b{};
  MovedNode moved;
  while (!stack.empty()) {
    const auto [ia, ib] = stack.back();
    stack.pop_back();
    const SphereNode& node_a = open(a, ia, dressed_a);
    const SphereNode& node_b = open(b, ib, dressed_b);
    move(node_b, X_AB, moved);
    for (std::size_t i = 0; i < 4; ++i) {
      if (node_a.child[i] == SphereNode::k_empty) continue;
      for (unsigned mask = overlap_mask(node_a, i, moved); mask != 0; mask &= mask - 1) {
        const auto j = static_cast<std::size_t>(__builtin_ctz(mask));
        if (is_leaf(node_a.child[i]) && is_leaf(node_b.child[j])) return true;
        stack.emplace_back(node_a.child[i], node_b.child[j]);
      }
    }
  }
  return false;
}

HWY_ATTR void Closest(const SphereTree& a, const SphereTree& b, const Pose& X_AB, SphereSeparation& best) {
  struct Bounded {
    double gap;
    Entry entry;
  };
  std::vector<Bounded> stack{{-std::numeric_limits<double>::infinity(), {0, 0}}};
  SphereNode dressed_a{}, dressed_b{};
  MovedNode moved;
  best.distance = std::numeric_limits<double>::infinity();
  while (!stack.empty()) {
    const Bounded next = stack.back();
    stack.pop_back();
    if (next.gap >= best.distance) continue;
    const SphereNode& node_a = open(a, next.entry.first, dressed_a);
    const SphereNode& node_b = open(b, next.entry.second, dressed_b);
    move(node_b, X_AB, moved);
    std::array<Bounded, 16> found;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (node_a.child[i] == SphereNode::k_empty) continue;
      best.count.sphere_tests += 4;
      double gap[4];
      gaps(node_a, i, moved, gap);
      for (std::size_t j = 0; j < 4; ++j) {
        if (gap[j] >= best.distance || node_b.child[j] == SphereNode::k_empty) continue;
        if (is_leaf(node_a.child[i]) && is_leaf(node_b.child[j])) {
          best.distance = gap[j];
          best.leaf_a = ~node_a.child[i];
          best.leaf_b = ~node_b.child[j];
        } else {
          found[count++] = {gap[j], {node_a.child[i], node_b.child[j]}};
        }
      }
    }
    // The most promising pair is opened first, i.e. pushed last.
    std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count),
              [](const Bounded& p, const Bounded& q) { return p.gap > q.gap; });
    stack.insert(stack.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
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

bool overlaps(const SphereTree& a, const SphereTree& b, const Pose& X_AB, TraversalScratch& scratch) {
  return HWY_DYNAMIC_DISPATCH(AnyOverlap)(a, b, X_AB, scratch);
}

SphereSeparation separation(const SphereTree& a, const SphereTree& b, const Pose& X_AB) {
  SphereSeparation best;
  HWY_DYNAMIC_DISPATCH(Closest)(a, b, X_AB, best);
  return best;
}

}  // namespace sixdof::ist
#endif
