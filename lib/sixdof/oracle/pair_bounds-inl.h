// Part of distance_bounds-inl.h and of generation/ray_cast_bounds-inl.h: what bounds two volumes of two trees know, and
// the pairs of triangles of two leaves. Taken once per instruction set: the guard is Highway's for that.
#if defined(SIXDOF_ORACLE_PAIR_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_ORACLE_PAIR_BOUNDS_INL_H_
#undef SIXDOF_ORACLE_PAIR_BOUNDS_INL_H_
#else
#define SIXDOF_ORACLE_PAIR_BOUNDS_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <hwy/highway.h>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/lanes-inl.h>

// One volume (the fixed one) against the eight children of a node (the expanded one), one child per SIMD lane.
//
// N is the frame of the expanded node's tree, F that of the fixed volume's tree, both with the origin at the tree's
// centre. w is a unit vector from the body of N to the body of F. The gap between the projections of both volumes on an
// axis is a lower bound on their distance. Axes that are known to be good:
//   - w, the direction between the closest points so far: on smooth surfaces it is close to the normals of all pairs
//     that are nearly as close;
//   - the line through the centres of the boxes: it turns with a pair that lies aside of the closest points, as the
//     direction between its own closest points does;
//   - the normals of the slabs;
//   - the axes of N and of F; where these are apart, the distance of two boxes aligned with N's, or with F's.
// A volume's projection is bounded by its box, and by its slab for the part of the axis along the slab's normal and its
// box for the rest (Reach). On a smooth surface the second shrinks with the square of the volume's size where the axis
// is close to its normal, the first only linearly.
//
// Bounds are floats. With Rounding::unfused they have the same bits on every instruction set.

HWY_BEFORE_NAMESPACE();
namespace sixdof::pair_bounds {
namespace HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

/// Rounding of a bound, relative to the lengths that enter it: fewer than 30 roundings of 6e-8 each.
constexpr float k_slack = 4e-6f;

/// Three coordinates and a zero.
constexpr hn::CappedTag<float, 4> k_vector;

struct Frame {
  HWY_ALIGN float axis[3][4] = {};  // F's axes in N: p_N = sum of axis[k] p_F[k] + translation
  HWY_ALIGN float translation[4] = {};
  double translation_along;  // translation . w
  float direction[3];        // w in N
  float direction_fixed[3];  // w in F
};

/// A pose between the frames of both trees.
struct Frames {
  Eigen::Vector3d shift;  // from A's centre to B's, in A's frame
  Eigen::Matrix3d R;
  Frame expand_a;  // N = A, F = B
  Frame expand_b;  // N = B, F = A

  explicit Frames(const Eigen::Matrix3d& R_AB) : R(R_AB) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        expand_a.axis[k][i] = static_cast<float>(R(i, k));
        expand_b.axis[k][i] = static_cast<float>(R(k, i));
      }
    }
  }

  void set_shift(const Eigen::Vector3d& from_a_to_b) {
    shift = from_a_to_b;
    const Eigen::Vector3d back = -(R.transpose() * shift);
    for (int i = 0; i < 3; ++i) {
      expand_a.translation[i] = static_cast<float>(shift[i]);
      expand_b.translation[i] = static_cast<float>(back[i]);
    }
  }

  /// Sets w, after the shift.
  /// @param from_a_to_b in A's frame
  void set_direction(const Eigen::Vector3d& from_a_to_b) {
    const Eigen::Vector3d in_b = R.transpose() * from_a_to_b;
    for (int i = 0; i < 3; ++i) {
      expand_a.direction[i] = static_cast<float>(from_a_to_b[i]);
      expand_a.direction_fixed[i] = static_cast<float>(in_b[i]);
      expand_b.direction[i] = static_cast<float>(-in_b[i]);
      expand_b.direction_fixed[i] = static_cast<float>(-from_a_to_b[i]);
    }
    expand_a.translation_along = from_a_to_b.dot(shift);
    expand_b.translation_along = from_a_to_b.dot(shift);  // (-R^T w) . (-R^T shift)
  }
};

/// How far volumes reach from the centres of their boxes along an axis x and against it.
struct Reach {
  V up, down;

  /// @param box, rest half widths along x of the box, and along x - (normal . x) normal
  /// @param along normal . x
  /// @param slab_lower, slab_upper of the slab, from the centre of the box
  HWY_INLINE Reach(V box, V rest, V along, V slab_lower, V slab_upper) {
    const V to_lower = hn::Mul(along, slab_lower), to_upper = hn::Mul(along, slab_upper);
    up = hn::Min(box, hn::Add(rest, hn::Max(to_lower, to_upper)));
    down = hn::Min(box, hn::Sub(rest, hn::Min(to_lower, to_upper)));
  }
};

/// The smallest p . w over a fixed volume, p in F. As Reach, but from the origin: the rounding of the slab's distance
/// from the centre of the box would blur layers.
HWY_INLINE float least_along(const Tree::Volume& v, const Frame& f) {
  const float* w = f.direction_fixed;
  const float along = w[0] * v.normal[0] + w[1] * v.normal[1] + w[2] * v.normal[2];
  float over_box = 0.0f;
  float over_rest = std::min(along * v.slab_lower, along * v.slab_upper);
  for (std::size_t k = 0; k < 3; ++k) {
    const float center = 0.5f * (v.lower[k] + v.upper[k]);
    const float half = 0.5f * (v.upper[k] - v.lower[k]);
    over_box += w[k] * center - std::abs(w[k]) * half;
    const float rest = w[k] - along * v.normal[k];
    over_rest += rest * center - std::abs(rest) * half;
  }
  return std::max(over_box, over_rest);
}

/// The fixed volume.
template <Rounding rounding>
struct FixedVolume {
  HWY_ALIGN float center[4];   // of the box, in N
  HWY_ALIGN float half[4];     // half extents of the axis-aligned box around it in N
  HWY_ALIGN float normal[4];   // of the slab, in N
  HWY_ALIGN float axis[3][4];  // axis[k]: half extent along F's axis k, in N
  float half_fixed[3];         // half extents in F
  float normal_on_axis[3];     // normal . axis[k]
  float slab_lower;            // from the centre of the box
  float slab_upper;

  HWY_INLINE FixedVolume(const Tree::Volume& v, const Frame& f) {
    float center_fixed[3];
    float on_normal = 0.0f;  // the centre of the box
    for (std::size_t k = 0; k < 3; ++k) {
      center_fixed[k] = 0.5f * (v.lower[k] + v.upper[k]);
      half_fixed[k] = 0.5f * (v.upper[k] - v.lower[k]);
      normal_on_axis[k] = v.normal[k] * half_fixed[k];
      on_normal += v.normal[k] * center_fixed[k];
    }
    slab_lower = v.slab_lower - on_normal;
    slab_upper = v.slab_upper - on_normal;
    for (std::size_t i = 0; i < 4; i += hn::Lanes(k_vector)) {
      auto center_N = hn::Load(k_vector, f.translation + i);
      auto normal_N = hn::Zero(k_vector), half_N = hn::Zero(k_vector);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis_N = hn::Load(k_vector, f.axis[k] + i);
        center_N = mul_add<rounding>(axis_N, hn::Set(k_vector, center_fixed[k]), center_N);
        normal_N = mul_add<rounding>(axis_N, hn::Set(k_vector, v.normal[k]), normal_N);
        const auto extent = hn::Mul(axis_N, hn::Set(k_vector, half_fixed[k]));
        half_N = hn::Add(half_N, hn::Abs(extent));
        hn::Store(extent, k_vector, axis[k] + i);
      }
      hn::Store(center_N, k_vector, center + i);
      hn::Store(normal_N, k_vector, normal + i);
      hn::Store(half_N, k_vector, half + i);
    }
  }

  /// @param along normal . x
  HWY_INLINE Reach reach(const V (&x)[3], V along) const {
    V box = hn::Zero(k_lanes);
    V rest = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      V on_axis = hn::Zero(k_lanes);
      for (std::size_t j = 0; j < 3; ++j) on_axis = mul_add<rounding>(set(axis[k][j]), x[j], on_axis);
      box = hn::Add(box, hn::Abs(on_axis));
      rest = hn::Add(rest, hn::Abs(sub_mul<rounding>(on_axis, along, set(normal_on_axis[k]))));
    }
    return {box, rest, along, set(slab_lower), set(slab_upper)};
  }
};

/// Children i, i + 1, ... of the expanded node, in N.
template <Rounding rounding>
struct ChildVolumes {
  V center[3], half[3];      // of the boxes
  V normal[3];               // of the slabs
  V slab_lower, slab_upper;  // from the origin
  V below, above;            // from the centres of the boxes

  HWY_INLINE ChildVolumes(const Tree::Node& node, std::size_t i) {
    V on_normal = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      const V lower = load(node.lower[k] + i);
      const V upper = load(node.upper[k] + i);
      center[k] = hn::Mul(set(0.5f), hn::Add(lower, upper));
      half[k] = hn::Mul(set(0.5f), hn::Sub(upper, lower));
      normal[k] = load(node.normal[k] + i);
      on_normal = mul_add<rounding>(normal[k], center[k], on_normal);
    }
    slab_lower = load(node.slab_lower + i);
    slab_upper = load(node.slab_upper + i);
    below = hn::Sub(slab_lower, on_normal);
    above = hn::Sub(slab_upper, on_normal);
  }

  /// The largest p . w over the volumes: as reach(), but from the origin.
  HWY_INLINE V greatest_along(const V (&w)[3]) const {
    const V along = dot<rounding>(w, normal);
    V over_box = hn::Zero(k_lanes);
    V over_rest = hn::Max(hn::Mul(along, slab_lower), hn::Mul(along, slab_upper));
    for (std::size_t k = 0; k < 3; ++k) {
      over_box = mul_add<rounding>(w[k], center[k], mul_add<rounding>(hn::Abs(w[k]), half[k], over_box));
      const V rest = sub_mul<rounding>(w[k], along, normal[k]);
      over_rest = mul_add<rounding>(rest, center[k], mul_add<rounding>(hn::Abs(rest), half[k], over_rest));
    }
    return hn::Min(over_box, over_rest);
  }

  /// @param along normal . x
  HWY_INLINE Reach reach(const V (&x)[3], V along) const {
    V box = hn::Zero(k_lanes);
    V rest = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      box = mul_add<rounding>(hn::Abs(x[k]), half[k], box);
      rest = mul_add<rounding>(hn::Abs(sub_mul<rounding>(x[k], along, normal[k])), half[k], rest);
    }
    return {box, rest, along, below, above};
  }
};

constexpr std::uint32_t k_leaf = Tree::k_leaf_triangles;

/// All pairs of triangles of two leaves, in A's frame relative to its centre. Lane 4 i + j holds pair (i, j).
struct LeafPair {
  static constexpr std::size_t k_pairs = k_leaf * k_leaf;
  HWY_ALIGN float a[3][3][k_pairs];  // [corner][axis][pair]
  HWY_ALIGN float b[3][3][k_pairs];
  HWY_ALIGN float lower[k_pairs];  // bounds on the distance
  HWY_ALIGN float upper[k_pairs];  // but for rounding; set for pairs whose lower bound is not above the best
};

/// Lower bounds by the axis w alone, less `slack`. Returns the least; if that is above `best` it sets none.
template <Rounding rounding>
HWY_INLINE float bound_along_direction(const Tree::Leaf& a, const Tree::Leaf& b, const Frame& f, float slack,
                                       float best, float* HWY_RESTRICT lower) {
  const hn::CappedTag<float, k_leaf> d;
  HWY_ALIGN float greatest_a[k_leaf];
  HWY_ALIGN float least_b[k_leaf];
  for (std::size_t i = 0; i < k_leaf; i += hn::Lanes(d)) {
    auto greatest = hn::Set(d, -Tree::k_empty);
    auto least = hn::Set(d, Tree::k_empty);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      auto along_a = hn::Zero(d);
      auto along_b = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k) {
        along_a = mul_add<rounding>(hn::Set(d, f.direction[k]), hn::Load(d, a.corner[corner][k] + i), along_a);
        along_b = mul_add<rounding>(hn::Set(d, f.direction_fixed[k]), hn::Load(d, b.corner[corner][k] + i), along_b);
      }
      greatest = hn::Max(greatest, along_a);
      least = hn::Min(least, along_b);
    }
    hn::Store(greatest, d, greatest_a + i);
    hn::Store(least, d, least_b + i);
  }
  const double shift = f.translation_along - static_cast<double>(slack);
  const float least = std::min(std::min(least_b[0], least_b[1]), std::min(least_b[2], least_b[3]));
  const float greatest = std::max(std::max(greatest_a[0], greatest_a[1]), std::max(greatest_a[2], greatest_a[3]));
  const auto least_bound = static_cast<float>(static_cast<double>(least - greatest) + shift);
  if (least_bound > best) return least_bound;
  for (std::size_t i = 0; i < k_leaf; ++i) {
    for (std::size_t j = 0; j < k_leaf; ++j) {
      lower[k_leaf * i + j] = static_cast<float>(static_cast<double>(least_b[j] - greatest_a[i]) + shift);
    }
  }
  return least_bound;
}

/// Writes the corners of all pairs; those of B are transformed to A's frame.
template <Rounding rounding>
HWY_INLINE void load_pairs(const Tree::Leaf& a, const Tree::Leaf& b, const Frame& f, LeafPair& pairs) {
  const hn::CappedTag<float, k_leaf> d;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < k_leaf; j += hn::Lanes(d)) {
        auto p = hn::Set(d, f.translation[k]);
        for (std::size_t m = 0; m < 3; ++m) {
          p = mul_add<rounding>(hn::Set(d, f.axis[m][k]), hn::Load(d, b.corner[corner][m] + j), p);
        }
        for (std::size_t i = 0; i < k_leaf; ++i) {
          hn::Store(p, d, pairs.b[corner][k] + k_leaf * i + j);
          hn::Store(hn::Set(d, a.corner[corner][k][i]), d, pairs.a[corner][k] + k_leaf * i + j);
        }
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::pair_bounds
HWY_AFTER_NAMESPACE();

#endif  // guard per instruction set
