// Part of candidates.cpp, which includes it once per instruction set: it has no include guard.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include <Eigen/Core>

#include <hwy/highway.h>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/cross_axes.h>
#include <sixdof/oracle/lanes-inl.h>

// Separating-axis tests between the children of a node of A and those of a node of B, one child of A per SIMD lane; and
// what tests of triangles need: the 4 x 4 pairs of triangles of two leaves, one pair per lane. Lane 4 i + j is that of
// triangle i of A's leaf and triangle j of B's.
//
// B may be translated by a displacement meanwhile; the tests then hold for all fractions x in 0 .. 1 of it. For that,
// B's boxes are taken at x = 1/2 and enlarged by half of the displacement.
//
// Coordinates are floats relative to the centre of A's tree; half extents include the rounding, so a test never
// separates volumes that intersect. No multiplication is fused and nothing is summed across lanes, so every instruction
// set finds the same pairs.

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

HWY_INLINE M no_lane() { return hn::Lt(hn::Zero(k_lanes), hn::Zero(k_lanes)); }

/// The motion of B in the frames of the trees: p_A - center_A = rotation (p_B - center_B) + shift + x displacement.
struct TreeMotion {
  float rotation[3][3];
  float shift[3];
  float displacement[3];
  float slack;                 ///< Largest error of a transformed coordinate.
  float middle[3];             ///< shift + displacement / 2
  float half_displacement[3];  ///< displacement / 2
  float half_sweep_in_b[3];    ///< Half extents of the displacement along B's axes.
  float inverse[3];  ///< 1 / displacement, per axis of A; 1 / slack where the displacement is below the slack.
  float pad[3];      ///< 0; the slack where the displacement is below the slack.

  TreeMotion(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement_A) {
    const Eigen::Vector3d d = X_AB.R * b.center() + X_AB.t - a.center();
    // A coordinate is the sum of seven products and sums of lengths of this size, each rounded by 6e-8.
    constexpr double k_float_rounding = 6e-7;
    // Rounding of the doubles, which matters where the bodies are far from their origins.
    constexpr double k_double_rounding = 1e-14;
    const double size =
        a.radius() + b.radius() + d.lpNorm<Eigen::Infinity>() + displacement_A.lpNorm<Eigen::Infinity>();
    slack =
        static_cast<float>(k_float_rounding * size +
                           k_double_rounding * (X_AB.t.lpNorm<1>() + b.center().lpNorm<1>() + a.center().lpNorm<1>()));
    const Eigen::Vector3d displacement_B = X_AB.R.transpose() * displacement_A;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) rotation[i][k] = static_cast<float>(X_AB.R(i, k));
      shift[i] = static_cast<float>(d[i]);
      displacement[i] = static_cast<float>(displacement_A[i]);
      half_displacement[i] = 0.5f * displacement[i];
      middle[i] = static_cast<float>(d[i] + 0.5 * displacement_A[i]);
      half_sweep_in_b[i] = static_cast<float>(0.5 * std::abs(displacement_B[i]));
      const bool moves = std::abs(displacement[i]) > slack;
      inverse[i] = 1.0f / (moves ? displacement[i] : slack);
      pad[i] = moves ? 0.0f : slack;
    }
  }
};

/// Volumes of a node's children in their own frame and in the other tree's; boxes as centre and half extents.
struct alignas(64) Children {
  float center[3][k_width], half[3][k_width];              // in the own frame
  float other_center[3][k_width], other_half[3][k_width];  // box around it in the other frame, for all fractions
  float unswept_half[3][k_width];                          // of that box at one fraction; like other_half with slack
  float normal[3][k_width];                                // in the other frame
  float slab_lower[k_width], slab_upper[k_width];          // along the normals, from A's centre, with slack
};

/// @tparam of_b true for children of B (the other frame is A's), false for those of A.
template <bool of_b>
HWY_INLINE void load_children(const Tree::Node& node, const TreeMotion& x, Children& out) {
  const V half = set(0.5f);
  const V slack = set(x.slack);
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V c[3], h[3], n[3], from[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const V lower = load(node.lower[k] + i), upper = load(node.upper[k] + i);
      c[k] = hn::Mul(half, hn::Add(lower, upper));
      h[k] = hn::Mul(half, hn::Sub(upper, lower));
      n[k] = load(node.normal[k] + i);
      hn::Store(c[k], k_lanes, out.center[k] + i);
      hn::Store(h[k], k_lanes, out.half[k] + i);
      from[k] = of_b ? c[k] : hn::Sub(c[k], set(x.middle[k]));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      V center = of_b ? set(x.middle[k]) : hn::Zero(k_lanes);
      V extent = slack;
      V normal = hn::Zero(k_lanes);
      for (std::size_t j = 0; j < 3; ++j) {
        const V r = set(of_b ? x.rotation[k][j] : x.rotation[j][k]);
        center = unfused_mul_add(r, from[j], center);
        extent = unfused_mul_add(hn::Abs(r), h[j], extent);
        normal = unfused_mul_add(r, n[j], normal);
      }
      hn::Store(center, k_lanes, out.other_center[k] + i);
      hn::Store(extent, k_lanes, out.unswept_half[k] + i);
      const V swept = hn::Add(extent, set(of_b ? std::abs(x.half_displacement[k]) : x.half_sweep_in_b[k]));
      hn::Store(swept, k_lanes, out.other_half[k] + i);
      hn::Store(normal, k_lanes, out.normal[k] + i);
    }
    // Slabs: a scalar product has three coordinates that are off by the slack, and moves by half of the displacement
    // along the normal.
    V along_displacement = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      const V normal = of_b ? load(out.normal[k] + i) : n[k];
      along_displacement = unfused_mul_add(normal, set(x.half_displacement[k]), along_displacement);
    }
    const V slab_slack = unfused_mul_add(set(3.0f), slack, hn::Abs(along_displacement));
    V lower = hn::Sub(load(node.slab_lower + i), slab_slack);
    V upper = hn::Add(load(node.slab_upper + i), slab_slack);
    if (of_b) {
      for (std::size_t k = 0; k < 3; ++k) {
        const V along = hn::Mul(load(out.normal[k] + i), set(x.middle[k]));
        lower = hn::Add(lower, along);
        upper = hn::Add(upper, along);
      }
    }
    hn::Store(lower, k_lanes, out.slab_lower + i);
    hn::Store(upper, k_lanes, out.slab_upper + i);
  }
}

/// Lanes of A's children that are separated from B's child j by an axis perpendicular to the displacement and to an
/// axis of A.
HWY_INLINE M separated_across_displacement(const Children& a, const Children& b, std::size_t j, std::size_t i,
                                           const TreeMotion& x) {
  M apart = no_lane();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    const V move_l = set(x.displacement[l]), move_m = set(x.displacement[m]);
    const V l_off = hn::Sub(load(a.center[l] + i), set(b.other_center[l][j]));
    const V m_off = hn::Sub(load(a.center[m] + i), set(b.other_center[m][j]));
    const V l_half = hn::Add(load(a.half[l] + i), set(b.unswept_half[l][j]));
    const V m_half = hn::Add(load(a.half[m] + i), set(b.unswept_half[m][j]));
    const V across = hn::Sub(hn::Mul(l_off, move_m), hn::Mul(m_off, move_l));
    const V radius = unfused_mul_add(l_half, hn::Abs(move_m), hn::Mul(m_half, hn::Abs(move_l)));
    apart = hn::Or(apart, hn::Gt(hn::Abs(across), radius));
  }
  return apart;
}

/// Children of A (bits) that are not separated from child j of B.
/// @tparam moving the displacement is not zero.
template <bool moving>
HWY_INLINE std::uint32_t overlapping_children(const Children& a, const Tree::Node& node_a, const Children& b,
                                              std::size_t j, const TreeMotion& x) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    M apart = no_lane();
    V middle_a = hn::Zero(k_lanes), radius_a = hn::Zero(k_lanes);  // of A's boxes along the normal of j
    V middle_b = hn::Zero(k_lanes), radius_b = hn::Zero(k_lanes);  // of j's box along A's normals
    for (std::size_t k = 0; k < 3; ++k) {
      const V other = load(a.other_center[k] + i);
      const V gap_in_a =
          hn::Sub(hn::Abs(hn::Sub(load(a.center[k] + i), set(b.other_center[k][j]))), load(a.half[k] + i));
      const V gap_in_b = hn::Sub(hn::Abs(hn::Sub(other, set(b.center[k][j]))), load(a.other_half[k] + i));
      apart = hn::Or(apart, hn::Gt(gap_in_a, set(b.other_half[k][j])));
      apart = hn::Or(apart, hn::Gt(gap_in_b, set(b.half[k][j])));
      const V normal_a = load(a.normal[k] + i);  // of A's child, in B's frame
      const V normal_b = set(b.normal[k][j]);    // of j, in A's frame
      middle_a = unfused_mul_add(normal_b, load(a.center[k] + i), middle_a);
      radius_a = unfused_mul_add(hn::Abs(normal_b), load(a.half[k] + i), radius_a);
      middle_b = unfused_mul_add(load(node_a.normal[k] + i), set(b.other_center[k][j]), middle_b);
      radius_b = unfused_mul_add(hn::Abs(normal_a), set(b.half[k][j]), radius_b);
    }
    apart = hn::Or(apart, hn::Gt(hn::Sub(middle_b, radius_b), load(a.slab_upper + i)));
    apart = hn::Or(apart, hn::Lt(hn::Add(middle_b, radius_b), load(a.slab_lower + i)));
    apart = hn::Or(apart, hn::Gt(hn::Sub(middle_a, radius_a), set(b.slab_upper[j])));
    apart = hn::Or(apart, hn::Lt(hn::Add(middle_a, radius_a), set(b.slab_lower[j])));
    if constexpr (moving) apart = hn::Or(apart, separated_across_displacement(a, b, j, i, x));
    bits |= bits_of(hn::Not(apart), i);
  }
  return bits;
}

/// B's children (bits) whose boxes overlap the box of a node of A, or of its only child in `lanes_a`.
HWY_INLINE std::uint32_t overlapping_node(const Children& b, const Tree::Node& a, std::uint32_t lanes_a) {
  const float* lower[3] = {&a.volume.lower[0], &a.volume.lower[1], &a.volume.lower[2]};
  const float* upper[3] = {&a.volume.upper[0], &a.volume.upper[1], &a.volume.upper[2]};
  if ((lanes_a & (lanes_a - 1)) == 0) {
    const auto i = static_cast<std::size_t>(std::countr_zero(lanes_a));
    for (std::size_t k = 0; k < 3; ++k) {
      lower[k] = &a.lower[k][i];
      upper[k] = &a.upper[k][i];
    }
  }
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    M apart = no_lane();
    for (std::size_t k = 0; k < 3; ++k) {
      const V center = load(b.other_center[k] + i), half = load(b.other_half[k] + i);
      apart = hn::Or(apart, hn::Gt(hn::Sub(center, half), set(*upper[k])));
      apart = hn::Or(apart, hn::Lt(hn::Add(center, half), set(*lower[k])));
    }
    bits |= bits_of(hn::Not(apart), i);
  }
  return bits;
}

/// Children of A (bits), of those in `bits`, that are not separated from child j of B by an axis across an axis of A
/// and one of B.
inline HWY_NOINLINE std::uint32_t overlapping_across_axes(const Children& a, const Children& b, std::size_t j,
                                                          std::uint32_t bits, const detail::CrossAxes& axes,
                                                          const TreeMotion& x) {
  // Off by the slack are the coordinates of B's centre; rounding of the directions, the products and the extents is
  // less than a slack each. A direction of length 1 has components of at most sqrt(3) together.
  constexpr float k_slacks = 6.0f;
  float radius_b[detail::CrossAxes::k_count], middle_b[detail::CrossAxes::k_count];
  for (std::size_t n = 0; n < detail::CrossAxes::k_count; ++n) {
    middle_b[n] = 0.0f;
    radius_b[n] = k_slacks * x.slack;
    for (std::size_t k = 0; k < 3; ++k) {
      middle_b[n] += axes.in_a[n][k] * b.other_center[k][j];
      radius_b[n] += std::abs(axes.in_b[n][k]) * b.half[k][j] + std::abs(axes.in_a[n][k] * x.half_displacement[k]);
    }
  }
  std::uint32_t overlapping = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    M apart = no_lane();
    for (std::size_t n = 0; n < detail::CrossAxes::k_count; ++n) {
      V offset = set(-middle_b[n]), radius = set(radius_b[n]);
      for (std::size_t k = 0; k < 3; ++k) {
        offset = unfused_mul_add(set(axes.in_a[n][k]), load(a.center[k] + i), offset);
        radius = unfused_mul_add(set(std::abs(axes.in_a[n][k])), load(a.half[k] + i), radius);
      }
      apart = hn::Or(apart, hn::Gt(hn::Abs(offset), radius));
    }
    overlapping |= bits_of(hn::Not(apart), i);
  }
  return bits & overlapping;
}

/// The interval of the displacement's fraction in which something may hold, per lane.
struct FractionInterval {
  V first, last;

  /// To the fractions at which a box of B overlaps a box of A along an axis of A; bounds are those at fraction 0.
  HWY_INLINE void narrow_to_boxes(V lower_a, V upper_a, V lower_b, V upper_b, std::size_t axis, const TreeMotion& x) {
    const V pad = set(x.pad[axis]);
    const V inverse = set(x.inverse[axis]);
    const V low = hn::Mul(hn::Sub(hn::Sub(lower_a, upper_b), pad), inverse);
    const V high = hn::Mul(hn::Add(hn::Sub(upper_a, lower_b), pad), inverse);
    first = hn::Max(first, x.inverse[axis] < 0.0f ? high : low);
    last = hn::Min(last, x.inverse[axis] < 0.0f ? low : high);
  }
};

/// Rounding of a fraction, a quotient of differences.
constexpr float k_fraction_rounding = 2e-6f;

using LeafLanesTag = hn::CappedTag<float, Tree::k_leaf_triangles>;
using LeafV = hn::Vec<LeafLanesTag>;

constexpr LeafLanesTag k_leaf_lanes;
constexpr std::size_t k_leaf = Tree::k_leaf_triangles;
constexpr std::size_t k_pairs = k_leaf * k_leaf;

/// A leaf's triangles in A's frame, relative to the centre of A's tree. Missing triangles repeat the last.
struct alignas(64) LeafLanes {
  float corner[3][3][k_leaf];  // [corner][axis]
  float normal[3][k_leaf];     // (c1 - c0) x (c2 - c0)
  float offset[k_leaf];        // normal . c0
  float lower[3][k_leaf], upper[3][k_leaf];
  float size[k_leaf];  // sum of the absolute components of both edges from corner 0
};

/// Fills everything but the corners, from the corners. Boxes are enlarged by `slack`.
HWY_INLINE void compute_from_corners(LeafLanes& leaf, float slack) {
  for (std::size_t i = 0; i < k_leaf; i += hn::Lanes(k_leaf_lanes)) {
    LeafV corner[3][3], u[3], v[3];
    LeafV size = hn::Zero(k_leaf_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) corner[c][k] = hn::Load(k_leaf_lanes, leaf.corner[c][k] + i);
      u[k] = hn::Sub(corner[1][k], corner[0][k]);
      v[k] = hn::Sub(corner[2][k], corner[0][k]);
      size = hn::Add(size, hn::Add(hn::Abs(u[k]), hn::Abs(v[k])));
      const LeafV lower = hn::Min(hn::Min(corner[0][k], corner[1][k]), corner[2][k]);
      const LeafV upper = hn::Max(hn::Max(corner[0][k], corner[1][k]), corner[2][k]);
      hn::Store(hn::Sub(lower, hn::Set(k_leaf_lanes, slack)), k_leaf_lanes, leaf.lower[k] + i);
      hn::Store(hn::Add(upper, hn::Set(k_leaf_lanes, slack)), k_leaf_lanes, leaf.upper[k] + i);
    }
    hn::Store(size, k_leaf_lanes, leaf.size + i);
    LeafV offset = hn::Zero(k_leaf_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      const LeafV normal = hn::Sub(hn::Mul(u[l], v[m]), hn::Mul(u[m], v[l]));
      hn::Store(normal, k_leaf_lanes, leaf.normal[k] + i);
      offset = unfused_mul_add(normal, corner[0][k], offset);
    }
    hn::Store(offset, k_leaf_lanes, leaf.offset + i);
  }
}

HWY_INLINE void load_leaf_of_b(const Tree::Leaf& from, const TreeMotion& x, LeafLanes& out) {
  for (std::size_t i = 0; i < k_leaf; i += hn::Lanes(k_leaf_lanes)) {
    for (std::size_t c = 0; c < 3; ++c) {
      LeafV p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = hn::Load(k_leaf_lanes, from.corner[c][k] + i);
      for (std::size_t k = 0; k < 3; ++k) {
        LeafV q = hn::Set(k_leaf_lanes, x.shift[k]);
        for (std::size_t j = 0; j < 3; ++j) q = unfused_mul_add(hn::Set(k_leaf_lanes, x.rotation[k][j]), p[j], q);
        hn::Store(q, k_leaf_lanes, out.corner[c][k] + i);
      }
    }
  }
  compute_from_corners(out, x.slack);
}

HWY_INLINE void load_leaf_of_a(const Tree::Leaf& from, LeafLanes& out) {
  std::memcpy(out.corner, from.corner, sizeof(out.corner));
  compute_from_corners(out, 0.0f);
}

/// The lanes of leaves, made when they are asked for and kept for a while: the leaves of one node do not displace each
/// other.
class LeafCache {
 public:
  explicit LeafCache(const Tree& tree) : tree_(tree) { std::fill_n(index_, k_width, ~0u); }

  template <class Load>
  HWY_INLINE const LeafLanes& get(std::uint32_t leaf, const Load& load_leaf) {
    const std::size_t slot = leaf % k_width;
    if (index_[slot] != leaf) {
      load_leaf(tree_.leaves()[leaf], lanes_[slot]);
      index_[slot] = leaf;
    }
    return lanes_[slot];
  }

 private:
  const Tree& tree_;
  std::uint32_t index_[k_width];
  LeafLanes lanes_[k_width];
};

/// Values of A's and of B's triangles for the lanes i, i + 1, ... of the pairs.
HWY_INLINE V load_of_a(const float* p, std::size_t i) {
#if HWY_TARGET == HWY_SCALAR
  return set(p[i / k_leaf]);
#else
  if constexpr (hn::MaxLanes(k_lanes) <= k_leaf) {
    return set(p[i / k_leaf]);
  } else {
    const hn::Half<Lanes> half;
    return hn::Combine(k_lanes, hn::Set(half, p[i / k_leaf + 1]), hn::Set(half, p[i / k_leaf]));
  }
#endif
}
HWY_INLINE V load_of_b(const float* p, std::size_t i) {
#if HWY_TARGET == HWY_SCALAR
  return load(p + i % k_leaf);
#else
  (void)i;
  return hn::LoadDup128(k_lanes, p);
#endif
}

/// Corners and normals for the lanes i, i + 1, ... of the pairs, and the tolerances of their plane distances.
struct PairLanes {
  V corner_a[3][3], corner_b[3][3];  // [corner][axis]
  V normal_a[3], normal_b[3];
  V offset_a, offset_b;
  V tolerance_a, tolerance_b;

  /// Tolerances: errors of normal . (corner of the other triangle) - offset, wherever the boxes overlap. A normal is
  /// a sum of products of edges (size E) whose coordinates are off by twice the slack s: 8 s E. A corner of the other
  /// triangle (size E') is at most E + E' + 6 s away, off by 2 s: together below 16 s E (2 E + E' + 6 s), which
  /// includes the rounding of the products with the normal, below s E^2.
  HWY_INLINE PairLanes(const LeafLanes& a, const LeafLanes& b, std::size_t i, float slack) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        corner_a[c][k] = load_of_a(a.corner[c][k], i);
        corner_b[c][k] = load_of_b(b.corner[c][k], i);
      }
      normal_a[k] = load_of_a(a.normal[k], i);
      normal_b[k] = load_of_b(b.normal[k], i);
    }
    offset_a = load_of_a(a.offset, i);
    offset_b = load_of_b(b.offset, i);
    const V size_a = load_of_a(a.size, i), size_b = load_of_b(b.size, i);
    const V s = set(16.0f * slack);
    const V both = hn::Add(hn::Add(size_a, size_b), set(6.0f * slack));
    tolerance_a = hn::Mul(hn::Mul(s, size_a), hn::Add(both, size_a));
    tolerance_b = hn::Mul(hn::Mul(s, size_b), hn::Add(both, size_b));
  }
};

/// Range of normal . p over three corners p.
struct Projection {
  V low, high;

  HWY_INLINE Projection(const V (&normal)[3], const V (&corner)[3][3]) {
    const V x = dot(normal, corner[0]), y = dot(normal, corner[1]), z = dot(normal, corner[2]);
    low = hn::Min(hn::Min(x, y), z);
    high = hn::Max(hn::Max(x, y), z);
  }
};

/// Projections of both triangles of a pair on one of the nine directions across an edge of each, and their rounding.
struct EdgeAxis {
  V low_a, high_a, low_b, high_b;
  V speed;  // of B's, per fraction of the displacement
  V tolerance;

  /// Whatever its own rounding, the direction n separates the triangles if their projections on it are apart: corners
  /// are off by the slack along each axis, and the rounding of a scalar product and of the way along the displacement is
  /// less than that. Products that underflow are off by less than the smallest normal float.
  HWY_INLINE EdgeAxis(const PairLanes& p, std::size_t edge, const TreeMotion& x) {
    const auto& a = p.corner_a;
    const auto& b = p.corner_b;
    const std::size_t i = edge % 3, j = edge / 3;
    V u[3], v[3], n[3];
    for (std::size_t k = 0; k < 3; ++k) {
      u[k] = hn::Sub(a[(i + 1) % 3][k], a[i][k]);
      v[k] = hn::Sub(b[(j + 1) % 3][k], b[j][k]);
    }
    V sum = hn::Zero(k_lanes);
    speed = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      n[k] = hn::Sub(hn::Mul(u[l], v[m]), hn::Mul(u[m], v[l]));
      sum = hn::Add(sum, hn::Abs(n[k]));
      speed = unfused_mul_add(n[k], set(x.displacement[k]), speed);
    }
    tolerance = unfused_mul_add(sum, set(8.0f * x.slack), set(std::numeric_limits<float>::min()));
    const Projection of_a(n, a), of_b(n, b);
    low_a = of_a.low;
    high_a = of_a.high;
    low_b = of_b.low;
    high_b = of_b.high;
  }
};

/// Pairs of triangles (bits), of those in `bits`, that no axis across an edge of each separates. With the tests before,
/// by both planes, they intersect but for rounding.
inline HWY_NOINLINE std::uint32_t overlapping_across_edges(const LeafLanes& a, const LeafLanes& b, std::uint32_t bits,
                                                           const TreeMotion& x) {
  std::uint32_t overlapping = 0;
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    const PairLanes p(a, b, i, x.slack);
    M apart = no_lane();
    for (std::size_t edge = 0; edge < 9; ++edge) {
      const EdgeAxis axis(p, edge, x);
      apart = hn::Or(apart, hn::Gt(hn::Sub(axis.low_b, axis.high_a), axis.tolerance));
      apart = hn::Or(apart, hn::Gt(hn::Sub(axis.low_a, axis.high_b), axis.tolerance));
    }
    overlapping |= bits_of(hn::Not(apart), i);
  }
  return bits & overlapping;
}

/// Calls take(lane, pair) for the pairs of triangles whose bits are set, but for lanes without a triangle.
template <class Take>
HWY_INLINE void for_each_pair(std::uint32_t bits, Tree::Child leaf_a, Tree::Child leaf_b, const Take& take) {
  for (; bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
    const std::uint32_t t = lane / k_leaf, u = lane % k_leaf;
    if (t < leaf_a.count() && u < leaf_b.count()) take(lane, TrianglePair{leaf_a.first() + t, leaf_b.first() + u});
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();
