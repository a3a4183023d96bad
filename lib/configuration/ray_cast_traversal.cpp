#include <sixdof/configuration/ray_cast_traversal.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <Eigen/Geometry>

#include <sixdof/configuration/ray_cast_pair.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/configuration/ray_cast_traversal.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Let S be the set of differences b - a (b in B at travel 0, a in A), a Minkowski sum of B and the mirrored A. B at
// travel t is at least d away from A for every t >= t0 if some unit vector n with n . u >= 0 has
//   n . (s + t0 u) >= d for all s in S:
// moving on along u only adds to the left side. A pair of volumes that passes this test for the travel t0 found so far
// cannot raise it. That is all there is: no ray parameter is ever divided by n . u, grazing rays are no special case.
//
// Axes n tried for a pair of volumes, each the intersection of a box, a ball and a slab:
//   - the normal at the closest points found so far: where surfaces are smooth it is close to the best for every pair
//     that matters, and slabs make it tight to second order in the size of the patches;
//   - from centre to centre, with slabs: tight for small patches at a distance;
//   - from box to box, where the nearest point of the sum of the boxes lies; bounds at that travel are lowered by the
//     way there;
//   - the normals of the slabs.
// Where centres come nearer as t grows beyond t0, boxes and centres are taken at the nearest travel instead.
//
// Nothing here uses fused multiply-add, and all else (+ - * / sqrt min max) is rounded by IEEE rules lane by lane. So
// which pairs are looked into, and in what order, is the same on every instruction set.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, Tree::k_width>;
using V = hn::Vec<Lanes>;

constexpr Lanes k_lanes;
constexpr std::size_t k_width = Tree::k_width;
constexpr std::size_t k_leaf_triangles = Tree::k_leaf_triangles;

/// Bounds carry a few roundings (6e-8 each) of numbers up to Cast::size(): three of turning a corner, one or two each
/// of fitting, shifting and adding.
constexpr float k_slack = 1e-6f;

/// Axes are shorter than unit vectors by more than their rounding: a gap along them never exceeds the distance.
constexpr double k_axis_length = 1.0 - 4e-7;

/// Squares of lengths below this are taken for this, so that nothing is divided by zero.
constexpr float k_tiny_square = 1e-36f;

HWY_INLINE V set(float x) { return hn::Set(k_lanes, x); }
HWY_INLINE V mul_add(V x, V y, V z) { return hn::Add(hn::Mul(x, y), z); }
HWY_INLINE V sub_mul(V z, V x, V y) { return hn::Sub(z, hn::Mul(x, y)); }

/// The ray in floats.
struct Ray {
  float u[3];
  float axis[3];
  float aim;
  float slack;
};

/// Smallest n . (p - centre of the ball) over a volume: over the ball, and over the slab with what is left of n over
/// the ball. Both n and the slab's normal are shorter than unit vectors by more than their rounding, so the square root
/// is never below the length of what is left.
HWY_INLINE V lowest(const V* HWY_RESTRICT n, V radius, const V* HWY_RESTRICT normal, V slab_offset, V slab_half) {
  const V along = mul_add(n[2], normal[2], mul_add(n[1], normal[1], hn::Mul(n[0], normal[0])));
  const V rest = hn::Sqrt(hn::Max(sub_mul(set(1.0f), along, along), hn::Zero(k_lanes)));
  V slab = sub_mul(hn::Mul(along, slab_offset), hn::Abs(along), slab_half);
  slab = sub_mul(slab, rest, radius);
  return hn::Max(hn::Neg(radius), slab);
}

/// The same for one volume.
HWY_INLINE float lowest(const float* n, const CastVolume& v) {
  const float along = n[0] * v.normal[0] + n[1] * v.normal[1] + n[2] * v.normal[2];
  const float rest = std::sqrt(std::max(1.0f - along * along, 0.0f));
  return std::max(-v.ball_radius, along * v.slab_offset - std::abs(along) * v.slab_half - rest * v.ball_radius);
}

/// By how much each child's distance from `fixed` surely exceeds the aim from cast.travel on.
/// @param shift travel * u
/// @param heights of the balls' centres above the fixed one's along the axis found so far: the lowest is most likely to
/// hold what hits first
HWY_INLINE void bound_children(const CastNode& node, const CastVolume& fixed, const Ray& ray, const float* shift,
                               float* HWY_RESTRICT gaps, float* HWY_RESTRICT heights) {
  const V zero = hn::Zero(k_lanes);
  const V aim = set(ray.aim);
  const V enough = set(ray.slack);
  float at[3], box_at[3];
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = fixed.ball_center[k] + shift[k];
    box_at[k] = fixed.center[k] + shift[k];
  }
  const float axis_lowest = lowest(ray.axis, fixed) - ray.aim;
  // The fixed slab's normal, turned to where B comes from.
  const float toward = fixed.normal[0] * ray.u[0] + fixed.normal[1] * ray.u[1] + fixed.normal[2] * ray.u[2];
  const float sign = toward < 0.0f ? -1.0f : 1.0f;
  const float fixed_lowest = sign * fixed.slab_offset - fixed.slab_half - ray.aim;

  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V w[3], normal[3];
    for (std::size_t k = 0; k < 3; ++k) {
      w[k] = hn::Add(hn::Load(k_lanes, node.ball_center[k] + i), set(at[k]));
      normal[k] = hn::Load(k_lanes, node.normal[k] + i);
    }
    const V radius = hn::Load(k_lanes, node.ball_radius + i);
    const V slab_offset = hn::Load(k_lanes, node.slab_offset + i);
    const V slab_half = hn::Load(k_lanes, node.slab_half + i);
    V gap;
    {  // The axis found so far.
      const V n[3] = {set(ray.axis[0]), set(ray.axis[1]), set(ray.axis[2])};
      V middle = hn::Mul(n[0], w[0]);
      middle = mul_add(n[1], w[1], middle);
      middle = mul_add(n[2], w[2], middle);
      hn::Store(middle, k_lanes, heights + i);
      gap = hn::Add(hn::Add(middle, lowest(n, radius, normal, slab_offset, slab_half)), set(axis_lowest));
    }
    if (hn::AllTrue(k_lanes, hn::Gt(gap, enough))) {
      hn::Store(gap, k_lanes, gaps + i);
      continue;
    }
    V later = zero;  // how much farther B goes until the centres are nearest
    for (std::size_t k = 0; k < 3; ++k) later = sub_mul(later, w[k], set(ray.u[k]));
    later = hn::Max(later, zero);
    {  // From centre to centre at the nearest travel.
      V near[3];
      V length2 = set(k_tiny_square);
      for (std::size_t k = 0; k < 3; ++k) {
        near[k] = mul_add(later, set(ray.u[k]), w[k]);
        length2 = mul_add(near[k], near[k], length2);
      }
      const V length = hn::Sqrt(length2);
      const V inverse = hn::Div(set(static_cast<float>(k_axis_length)), length);
      const V n[3] = {hn::Mul(near[0], inverse), hn::Mul(near[1], inverse), hn::Mul(near[2], inverse)};
      const V fixed_normal[3] = {set(fixed.normal[0]), set(fixed.normal[1]), set(fixed.normal[2])};
      V centers = hn::Add(length, lowest(n, radius, normal, slab_offset, slab_half));
      centers = hn::Add(centers,
                        lowest(n, set(fixed.ball_radius), fixed_normal, set(fixed.slab_offset), set(fixed.slab_half)));
      gap = hn::Max(gap, hn::Sub(centers, aim));
    }
    {  // From box to box at the nearest travel.
      V squared = zero;
      V up_box = zero;
      for (std::size_t k = 0; k < 3; ++k) {
        const V half = hn::Add(hn::Load(k_lanes, node.half[k] + i), set(fixed.half[k]));
        const V across = mul_add(later, set(ray.u[k]), hn::Add(hn::Load(k_lanes, node.center[k] + i), set(box_at[k])));
        const V apart = hn::Max(hn::Sub(hn::Abs(across), half), zero);
        squared = mul_add(apart, apart, squared);
        up_box = mul_add(hn::CopySign(apart, across), set(ray.u[k]), up_box);
      }
      // That is at the travel where the centres are nearest; from cast.travel on it is less by the way there.
      const V length = hn::Sqrt(hn::Max(squared, set(k_tiny_square)));
      const V from_now_on = hn::Sub(length, hn::Div(hn::Mul(later, up_box), length));
      const V boxes = hn::IfThenElseZero(hn::Ge(up_box, zero), from_now_on);
      gap = hn::Max(gap, hn::Sub(boxes, aim));
    }
    {  // The slabs' normals.
      const V fixed_n[3] = {set(sign * fixed.normal[0]), set(sign * fixed.normal[1]), set(sign * fixed.normal[2])};
      V middle = zero;
      V child_up = zero;
      V child_middle = slab_offset;
      for (std::size_t k = 0; k < 3; ++k) {
        middle = mul_add(fixed_n[k], w[k], middle);
        child_up = mul_add(normal[k], set(ray.u[k]), child_up);
        child_middle = mul_add(normal[k], w[k], child_middle);
      }
      middle = hn::Add(middle, hn::Add(lowest(fixed_n, radius, normal, slab_offset, slab_half), set(fixed_lowest)));
      const V turned = hn::IfThenElse(hn::Lt(child_up, zero), hn::Neg(child_middle), child_middle);
      const V fixed_normal[3] = {set(fixed.normal[0]), set(fixed.normal[1]), set(fixed.normal[2])};
      const V flip = hn::CopySign(set(1.0f), child_up);
      const V child_n[3] = {hn::Mul(flip, normal[0]), hn::Mul(flip, normal[1]), hn::Mul(flip, normal[2])};
      const V over =
          lowest(child_n, set(fixed.ball_radius), fixed_normal, set(fixed.slab_offset), set(fixed.slab_half));
      gap = hn::Max(gap, hn::Max(middle, hn::Sub(hn::Add(hn::Sub(turned, slab_half), over), aim)));
    }
    hn::Store(gap, k_lanes, gaps + i);
  }
}

/// Some pairs of triangles of two leaves.
struct LeafPair {
  static constexpr std::size_t k_pairs = 8;
  HWY_ALIGN float a[3][3][k_pairs];  // [corner][axis][pair]
  HWY_ALIGN float b[3][3][k_pairs];
  HWY_ALIGN float gaps[k_pairs];
};

/// By how much each pair's distance surely exceeds the aim from cast.travel on: Frank-Wolfe steps towards the point of
/// S + {t u, t >= cast.travel} that is nearest to the origin.
HWY_INLINE void bound_triangles(LeafPair& pairs, const Ray& ray) {
  constexpr int k_steps = 5;
  const V zero = hn::Zero(k_lanes);
  const V tiny = set(k_tiny_square);
  const V enough = set(ray.slack);
  for (std::size_t i = 0; i < LeafPair::k_pairs; i += hn::Lanes(k_lanes)) {
    const auto load = [i](const float* p) { return hn::Load(k_lanes, p + i); };
    V x[3] = {set(ray.axis[0]), set(ray.axis[1]), set(ray.axis[2])};
    V best = set(-Tree::k_empty);
    for (int step = 0; step <= k_steps; ++step) {
      // The corners that lie lowest along x.
      V low_a, low_b;
      V p[3], q[3];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        V along_a = hn::Mul(x[0], load(pairs.a[corner][0]));
        V along_b = hn::Mul(x[0], load(pairs.b[corner][0]));
        for (std::size_t k = 1; k < 3; ++k) {
          along_a = mul_add(x[k], load(pairs.a[corner][k]), along_a);
          along_b = mul_add(x[k], load(pairs.b[corner][k]), along_b);
        }
        if (corner == 0) {
          low_a = along_a;
          low_b = along_b;
          for (std::size_t k = 0; k < 3; ++k) {
            p[k] = load(pairs.a[0][k]);
            q[k] = load(pairs.b[0][k]);
          }
        } else {
          const auto lower_a = hn::Lt(along_a, low_a);
          const auto lower_b = hn::Lt(along_b, low_b);
          low_a = hn::Min(along_a, low_a);
          low_b = hn::Min(along_b, low_b);
          for (std::size_t k = 0; k < 3; ++k) {
            p[k] = hn::IfThenElse(lower_a, load(pairs.a[corner][k]), p[k]);
            q[k] = hn::IfThenElse(lower_b, load(pairs.b[corner][k]), q[k]);
          }
        }
      }
      V length2 = hn::Mul(x[0], x[0]);
      for (std::size_t k = 1; k < 3; ++k) length2 = mul_add(x[k], x[k], length2);
      const V length = hn::Sqrt(hn::Max(length2, tiny));
      const V gap = hn::Sub(hn::Div(hn::Add(low_a, low_b), length), set(ray.aim));
      best = hn::Max(best, gap);
      if (step == k_steps || hn::AllTrue(k_lanes, hn::Gt(best, enough))) break;
      V d[3];
      for (std::size_t k = 0; k < 3; ++k) d[k] = hn::Add(p[k], q[k]);
      if (step == 0) {  // the axis is no point of S; d is
        for (std::size_t k = 0; k < 3; ++k) x[k] = d[k];
      } else {
        V down = zero;
        V norm = tiny;
        for (std::size_t k = 0; k < 3; ++k) {
          d[k] = hn::Sub(d[k], x[k]);
          down = sub_mul(down, x[k], d[k]);
          norm = mul_add(d[k], d[k], norm);
        }
        const V t = hn::Min(hn::Max(hn::Div(down, norm), zero), set(1.0f));
        for (std::size_t k = 0; k < 3; ++k) x[k] = mul_add(t, d[k], x[k]);
      }
      V up = zero;
      for (std::size_t k = 0; k < 3; ++k) up = sub_mul(up, x[k], set(ray.u[k]));
      up = hn::Max(up, zero);
      for (std::size_t k = 0; k < 3; ++k) x[k] = mul_add(up, set(ray.u[k]), x[k]);
    }
    hn::Store(best, k_lanes, pairs.gaps + i);
  }
}

struct Descent {
  Cast& cast;
  const CastTree& tree_a;
  const CastTree& tree_b;
  Ray ray;
  float shift[3];
  const double tie;

  explicit Descent(Cast& c) : cast(c), tree_a(c.a), tree_b(c.b), tie(k_cast_tie * c.size()) {
    for (int k = 0; k < 3; ++k) ray.u[k] = static_cast<float>(cast.direction[k]);
    ray.aim = static_cast<float>(cast.aim);
    ray.slack = static_cast<float>(k_slack * cast.size());
    update();
  }

  /// After a change of travel and axis.
  void update() {
    for (int k = 0; k < 3; ++k) {
      ray.axis[k] = static_cast<float>(k_axis_length * cast.axis[k]);
      shift[k] = static_cast<float>(cast.travel * cast.direction[k]);
    }
  }

  /// What is opened next is not far.
  static void prefetch(const CastTree& tree, CastChild child) {
    constexpr std::size_t k_cache_line = 64;  // bytes
    const bool leaf = child.is_leaf();
    const char* begin = leaf ? reinterpret_cast<const char*>(&tree.leaves()[child.index()])
                             : reinterpret_cast<const char*>(&tree.nodes()[child.index()]);
    const std::size_t size = leaf ? sizeof(CastLeaf) : sizeof(CastNode);
    for (std::size_t offset = 0; offset < size; offset += k_cache_line) hwy::Prefetch(begin + offset);
  }

  static const CastVolume& volume_of(const CastTree& tree, std::uint32_t child) {
    return child == Cast::Open::k_root ? tree.root_volume() : tree.volume(child);
  }

  static CastChild child_of(const CastTree& tree, std::uint32_t child) {
    return child == Cast::Open::k_root ? CastChild::node(0) : tree.nodes()[child / k_width].child[child % k_width];
  }

  /// Whether slab `x` and slab `y` with a box around are apart by the aim, up to a tie, from cast.travel on.
  bool slabs_apart(const CastSlab& x, const CastSlab& y, const CastVolume& box) const {
    const double up = x.normal.dot(cast.direction);
    const double sign = up < 0.0 ? -1.0 : 1.0;
    const Eigen::Vector3d n = sign * x.normal;
    const double along = n.dot(y.normal);
    double low = sign * x.middle - x.half + along * y.middle - std::abs(along) * y.half;
    const Eigen::Vector3d rest = n - along * y.normal;
    for (int k = 0; k < 3; ++k) {
      const double half = static_cast<double>(box.half[k]) + static_cast<double>(ray.slack);
      low += rest[k] * static_cast<double>(box.center[k]) - std::abs(rest[k]) * half;
    }
    return low + cast.travel * std::abs(up) >= cast.aim - tie;
  }

  /// Whether two flat patches tie with what was found: in double precision, where floats cannot tell.
  bool ties(std::uint32_t a, std::uint32_t b) const {
    if (a == Cast::Open::k_root || b == Cast::Open::k_root) return false;
    const CastSlab slab_a = tree_a.slab(a);
    const CastSlab slab_b = tree_b.slab(b);
    return slabs_apart(slab_a, slab_b, tree_b.volume(b)) || slabs_apart(slab_b, slab_a, tree_a.volume(a));
  }

  /// Of each triangle, how low its lowest corner lies along the axis.
  void lowest_corners(const CastLeaf& leaf, float* HWY_RESTRICT low) const {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto& p = leaf.corner[corner];
      for (std::size_t i = 0; i < k_leaf_triangles; ++i) {
        const float x = ray.axis[0] * p[0][i] + ray.axis[1] * p[1][i] + ray.axis[2] * p[2][i];
        low[i] = corner == 0 ? x : std::min(low[i], x);
      }
    }
  }

  void look_into_leaves(std::uint32_t leaf_a, std::uint32_t leaf_b) {
    ++cast.counts.leaf_pairs;
    const CastLeaf& a = tree_a.leaves()[leaf_a];
    const CastLeaf& b = tree_b.leaves()[leaf_b];
    const Tree::Child child_a = tree_a.mesh().leaf_children()[leaf_a];
    const Tree::Child child_b = tree_b.mesh().leaf_children()[leaf_b];

    // Along the axis found so far, all pairs at once.
    float low_a[k_leaf_triangles], low_b[k_leaf_triangles];
    lowest_corners(a, low_a);
    lowest_corners(b, low_b);
    const float along = ray.axis[0] * shift[0] + ray.axis[1] * shift[1] + ray.axis[2] * shift[2] - ray.aim;
    std::uint32_t left[k_leaf_triangles * k_leaf_triangles];  // 4 i + j for pair (i, j)
    float gap[k_leaf_triangles * k_leaf_triangles];
    std::size_t left_count = 0;
    for (std::uint32_t i = 0; i < child_a.count(); ++i) {
      for (std::uint32_t j = 0; j < child_b.count(); ++j) {
        left[left_count] = static_cast<std::uint32_t>(k_leaf_triangles) * i + j;
        left_count += along + low_a[i] + low_b[j] > ray.slack ? 0 : 1;
      }
    }

    std::uint32_t order[k_leaf_triangles * k_leaf_triangles];
    std::size_t count = 0;
    LeafPair pairs;
    for (std::size_t first = 0; first < left_count; first += LeafPair::k_pairs) {
      const std::size_t chunk = std::min(LeafPair::k_pairs, left_count - first);
      for (std::size_t k = 0; k < 3; ++k) {
        // Relative to one corner, so that only the floats given round.
        const float origin = a.corner[0][k][0];
        const float b_shift = origin + shift[k];
        for (std::size_t corner = 0; corner < 3; ++corner) {
          for (std::size_t n = 0; n < LeafPair::k_pairs; ++n) {
            const std::uint32_t pair = left[first + (n < chunk ? n : 0)];
            pairs.a[corner][k][n] = a.corner[corner][k][pair / k_leaf_triangles] - origin;
            pairs.b[corner][k][n] = b.corner[corner][k][pair % k_leaf_triangles] + b_shift;
          }
        }
      }
      bound_triangles(pairs, ray);
      for (std::size_t n = 0; n < chunk; ++n) {
        if (pairs.gaps[n] > ray.slack) continue;
        const std::uint32_t pair = left[first + n];
        gap[pair] = pairs.gaps[n];
        std::size_t at = count++;
        for (; at > 0 && gap[order[at - 1]] > gap[pair]; --at) order[at] = order[at - 1];
        order[at] = pair;
      }
    }
    for (std::size_t n = 0; n < count; ++n) {
      const std::uint32_t i = order[n] / k_leaf_triangles;
      const std::uint32_t j = order[n] % k_leaf_triangles;
      if (offer_pair(cast, {child_a.first() + i, child_b.first() + j})) update();
    }
  }

  void run() {
    std::vector<Cast::Open>& open = cast.open;
    open.clear();
    open.push_back({Cast::Open::k_root, Cast::Open::k_root, 0.0f});
    while (!open.empty()) {
      const Cast::Open top = open.back();
      open.pop_back();
      const CastChild child_a = child_of(tree_a, top.a);
      const CastChild child_b = child_of(tree_b, top.b);
      if (child_a.is_leaf() && child_b.is_leaf()) {
        look_into_leaves(child_a.index(), child_b.index());
        continue;
      }
      const CastVolume& volume_a = volume_of(tree_a, top.a);
      const CastVolume& volume_b = volume_of(tree_b, top.b);
      const bool opens_a = child_b.is_leaf() || (!child_a.is_leaf() && volume_a.size >= volume_b.size);
      const std::uint32_t index = opens_a ? child_a.index() : child_b.index();
      const CastNode& node = opens_a ? tree_a.nodes()[index] : tree_b.nodes()[index];
      HWY_ALIGN float gaps[k_width], heights[k_width];
      ++cast.counts.nodes;
      const CastVolume& fixed = opens_a ? volume_b : volume_a;
      bound_children(node, fixed, ray, shift, gaps, heights);

      const std::size_t first = open.size();
      std::uint32_t left = 0;
      for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
        HWY_ALIGN std::uint8_t stored[8] = {};
        hn::StoreMaskBits(k_lanes, hn::Le(hn::Load(k_lanes, gaps + i), set(ray.slack)), stored);
        left |= static_cast<std::uint32_t>(stored[0]) << i;
      }
      left &= (1u << node.child_count) - 1;
      for (; left != 0; left &= left - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
        Cast::Open next{top.a, top.b, heights[lane]};
        (opens_a ? next.a : next.b) = static_cast<std::uint32_t>(index * k_width + lane);
        const bool flat = node.slab_half[lane] <= ray.slack && fixed.slab_half <= ray.slack;
        if (flat && gaps[lane] > -ray.slack && ties(next.a, next.b)) continue;
        prefetch(opens_a ? tree_a : tree_b, node.child[lane]);
        std::size_t at = open.size();
        open.push_back(next);
        for (; at > first && open[at - 1].height < next.height; --at) open[at] = open[at - 1];
        open[at] = next;
      }
    }
  }
};

void find_first_hit(Cast& cast) { Descent(cast).run(); }

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::ray_cast {
namespace {

/// Grazing rays halve the error per step, others square it.
constexpr int k_most_steps = 100;

/// |distance - aim| at which a step changes nothing, in units of Cast::size(): the rounding of the corners.
constexpr double k_settled = 2e-16;

}  // namespace

HWY_EXPORT(find_first_hit);

void find_first_hit(Cast& cast) { HWY_DYNAMIC_DISPATCH(find_first_hit)(cast); }

bool offer_pair(Cast& cast, CastPair pair) {
  const TriangleCorners mirrored = cast.a.triangle(pair.a);
  const TriangleCorners a{-mirrored[0], -mirrored[1], -mirrored[2]};
  const TriangleCorners at_center = cast.b.triangle(pair.b);
  const double size = cast.size();
  const double tie = k_cast_tie * size;
  // Triangles around the corners and edges of the closest pair tie with it along its axis.
  if (cast.pair) {
    double gap = cast.travel * cast.axis.dot(cast.direction);
    gap += std::min({cast.axis.dot(mirrored[0]), cast.axis.dot(mirrored[1]), cast.axis.dot(mirrored[2])});
    gap += std::min({cast.axis.dot(at_center[0]), cast.axis.dot(at_center[1]), cast.axis.dot(at_center[2])});
    if (gap >= cast.aim - tie) return false;
  }
  const MovingPair moving(a, at_center, cast.direction);
  const auto sample_at = [&](double t) {
    ++cast.counts.distances;
    return moving.at(t);
  };
  // The distance is convex in t. Where it reaches the aim at t or beyond, Newton's method ends at the last such place:
  // a step up the slope ends to the right of it, and from there no step goes past it.
  double t = cast.travel;
  MovingPair::Sample sample = sample_at(t);
  if (sample.distance >= cast.aim - tie && sample.slope >= 0.0) return false;
  if (sample.distance >= cast.aim || !(sample.slope > 0.0)) {
    double highest_a = -std::numeric_limits<double>::infinity();
    double lowest_b = -highest_a;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      highest_a = std::max(highest_a, a[corner].dot(cast.direction));
      lowest_b = std::min(lowest_b, at_center[corner].dot(cast.direction));
    }
    t = highest_a - lowest_b + cast.aim;  // apart by the aim along the ray
    if (t <= cast.travel) return false;
    sample = sample_at(t);
  }
  for (int step = 0; step < k_most_steps; ++step) {
    const double above = sample.distance - cast.aim;
    if (std::abs(above) <= k_settled * size) break;
    if (!(sample.slope > 0.0)) return false;  // the least distance is above the aim
    const double next = t - above / sample.slope;
    if (next <= cast.travel) return false;
    if (next == t) break;
    t = next;
    sample = sample_at(t);
  }
  if (!(sample.slope >= 0.0)) return false;
  cast.travel = t;
  cast.pair = pair;
  cast.axis = sample.axis;
  return true;
}

}  // namespace sixdof::ray_cast
#endif
