// Compiled once per instruction set: part of distance_traversal.cpp, included by nothing else.
#if defined(SIXDOF_ORACLE_DISTANCE_SEED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_ORACLE_DISTANCE_SEED_INL_H_
#undef SIXDOF_ORACLE_DISTANCE_SEED_INL_H_
#else
#define SIXDOF_ORACLE_DISTANCE_SEED_INL_H_
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/distance_bounds-inl.h>
#include <sixdof/oracle/distance_traversal.h>

// Where a search begins: a pair of triangles that is probably close. A good one makes the cut-off tight from the start;
// which one it is has no influence on the result.

HWY_BEFORE_NAMESPACE();
namespace sixdof::detail {
namespace HWY_NAMESPACE {

/// A corner of a tree, the closest to some point so far.
struct Corner {
  float squared;
  std::uint32_t leaf;
  std::uint32_t triangle;  // in the leaf
  float point[3];          // relative to the tree's centre
};

/// Finds a corner closer to p than `best.squared`, nearly the closest. Returns whether there is one. Of corners that
/// differ by less than a few leaves' width sideways any will do: to look for the very closest of many nearly equal ones
/// would cost more than it saves. So will any whose square is less than `tolerance` times that of the closest.
bool find_corner(const Tree& tree, const float* p, float tolerance, Corner& best, std::vector<OpenPair>& open) {
  constexpr double k_leaves_wide = 32.0;  // square of it; r^2 / leaves is about a leaf's area
  const auto equal =
      static_cast<float>(k_leaves_wide * tree.radius() * tree.radius() / static_cast<double>(tree.leaves().size()));
  bool found = false;
  open.assign(1, {0, 0, 0.0f});
  while (!open.empty()) {
    const OpenPair top = open.back();
    open.pop_back();
    if (tolerance * top.lower + equal >= best.squared) continue;
    if ((top.a & OpenPair::k_leaf) != 0) {
      const Tree::Leaf& leaf = tree.leaves()[top.a - OpenPair::k_leaf];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        for (std::uint32_t t = 0; t < leaf.child.count(); ++t) {
          float squared = 0.0f;
          for (std::size_t k = 0; k < 3; ++k) {
            const float d = leaf.corner[corner][k][t] - p[k];
            squared += d * d;
          }
          if (squared >= best.squared) continue;
          best = {squared,
                  top.a - OpenPair::k_leaf,
                  t,
                  {leaf.corner[corner][0][t], leaf.corner[corner][1][t], leaf.corner[corner][2][t]}};
          found = true;
        }
      }
      continue;
    }
    const Tree::Node& node = tree.nodes()[top.a];
    HWY_ALIGN float bounds[k_width];
    for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
      V squared = hn::Zero(k_lanes);
      for (std::size_t k = 0; k < 3; ++k) {
        const V at = hn::Set(k_lanes, p[k]);
        const V below = hn::Sub(hn::Load(k_lanes, node.lower[k] + i), at);
        const V above = hn::Sub(at, hn::Load(k_lanes, node.upper[k] + i));
        const V gap = hn::Max(hn::Max(below, above), hn::Zero(k_lanes));
        squared = hn::MulAdd(gap, gap, squared);
      }
      hn::Store(squared, k_lanes, bounds + i);
    }
    const std::size_t first = open.size();
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      if (tolerance * bounds[i] + equal >= best.squared) continue;
      const OpenPair next{node.child[i].is_leaf() ? OpenPair::k_leaf + node.leaf[i] : node.child[i].node(), 0,
                          bounds[i]};
      std::size_t at = open.size();
      open.push_back(next);
      for (; at > first && open[at - 1].lower < next.lower; --at) open[at] = open[at - 1];
      open[at] = next;
    }
  }
  return found;
}

void turn(const Frame& f, const float* p, float* out) {
  for (std::size_t k = 0; k < 3; ++k) {
    out[k] = f.translation[k] + f.rotation[k][0] * p[0] + f.rotation[k][1] * p[1] + f.rotation[k][2] * p[2];
  }
}

void offer_seed(Traversal& traversal, const Samples& samples_a, const Samples& samples_b) {
  const Frames frames(*traversal.a, *traversal.b, traversal.X_AB);
  const Frame& to_a = frames.open_a;
  const Frame& to_b = frames.open_b;

  HWY_ALIGN float least[k_width];
  HWY_ALIGN float pairs[k_width];  // which: an exact small integer
  float best = std::numeric_limits<float>::infinity();
  std::size_t best_a = 0;
  std::size_t best_b = 0;
  for (std::size_t i = 0; i < Samples::k_count; i += hn::Lanes(k_lanes)) {
    V b[3];
    for (std::size_t k = 0; k < 3; ++k) {
      b[k] = hn::Set(k_lanes, to_a.translation[k]);
      for (std::size_t m = 0; m < 3; ++m) {
        b[k] = hn::MulAdd(hn::Set(k_lanes, to_a.rotation[k][m]), hn::Load(k_lanes, samples_b.point[m] + i), b[k]);
      }
    }
    V closest = hn::Set(k_lanes, std::numeric_limits<float>::infinity());
    V which = hn::Zero(k_lanes);
    for (std::size_t j = 0; j < Samples::k_count; ++j) {
      V squared = hn::Zero(k_lanes);
      for (std::size_t k = 0; k < 3; ++k) {
        const V d = hn::Sub(b[k], hn::Set(k_lanes, samples_a.point[k][j]));
        squared = hn::MulAdd(d, d, squared);
      }
      which = hn::IfThenElse(hn::Lt(squared, closest), hn::Set(k_lanes, static_cast<float>(j)), which);
      closest = hn::Min(closest, squared);
    }
    hn::Store(closest, k_lanes, least);
    hn::Store(which, k_lanes, pairs);
    for (std::size_t lane = 0; lane < hn::Lanes(k_lanes); ++lane) {
      if (least[lane] < best) {
        best = least[lane];
        best_a = static_cast<std::size_t>(pairs[lane]);
        best_b = i + lane;
      }
    }
  }

  // What is known already may be closer: the answer to the last query on a path.
  if (traversal.found && traversal.best * traversal.best <= static_cast<double>(best)) return;

  Corner a{best, samples_a.leaf[best_a], 0, {}};
  Corner b{best, samples_b.leaf[best_b], 0, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    a.point[k] = samples_a.point[k][best_a];
    b.point[k] = samples_b.point[k][best_b];
  }
  float from[3];
  bool search_b = true;
  for (const auto& [tolerance, turns] : {std::pair(1.1f, 6), std::pair(1.0f, 4)}) {  // most settle after fewer
    int misses = 0;
    for (int i = 0; i < turns && misses < 2; ++i, search_b = !search_b) {
      turn(search_b ? to_b : to_a, search_b ? a.point : b.point, from);
      Corner& moved = search_b ? b : a;
      moved.squared = best;
      if (!find_corner(search_b ? *traversal.b : *traversal.a, from, tolerance, moved, traversal.open)) ++misses;
      best = moved.squared;
    }
  }
  const TrianglePair pair{traversal.a->leaves()[a.leaf].child.first() + a.triangle,
                          traversal.b->leaves()[b.leaf].child.first() + b.triangle};
  if (offer_pair(traversal, pair)) traversal.direction = traversal.closest.on_b - traversal.closest.on_a;
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();

#endif
