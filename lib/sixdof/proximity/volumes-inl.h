// Part of the searches of two trees: distances and candidates (oracle/) and the ray cast (generation/). Taken once per
// instruction set: the guard is Highway's for that.
#if defined(SIXDOF_PROXIMITY_VOLUMES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_PROXIMITY_VOLUMES_INL_H_
#undef SIXDOF_PROXIMITY_VOLUMES_INL_H_
#else
#define SIXDOF_PROXIMITY_VOLUMES_INL_H_
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/proximity/cross_axes.h>
#include <sixdof/proximity/frames.h>
#include <sixdof/proximity/lanes-inl.h>

// Volumes of one tree, x, against a volume of the other, y: one of x per SIMD lane.
//
// p is a point of x and q one of y; n . (q - p) over both volumes is an interval for each axis n. Where 0 is not in it,
// the volumes are apart by at least its distance from 0. Axes that are known to be good:
//   - the axes of both trees' frames, along which the boxes lie; where several separate, the distance of the boxes;
//   - the normals of the slabs;
//   - the line through the centres of the boxes: it turns with a pair that lies aside of the closest points, as the
//     direction between its own closest points does;
//   - w, the direction between the closest points so far: on smooth surfaces it is close to the normals of all pairs
//     that are nearly as close;
//   - the nine axes across an axis of each frame, for boxes that cross (CrossAxesUse).
// A volume's projection is bounded by its box, and by its slab for the part of the axis along the slab's normal and its
// box for the rest (Reach). On a smooth surface the second shrinks with the square of the volume's size where the axis
// is close to its normal, the first only linearly.
//
// Volumes are turned into the other frame once for all that they are tested against: what is left for a pair is
// products with constants. Floats; with Rounding::unfused they have the same bits on every instruction set.

HWY_BEFORE_NAMESPACE();
namespace sixdof::volumes {
namespace HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using detail::Frame;
using detail::Frames;

/// Rounding of a bound, relative to the lengths that enter it: fewer than 30 roundings of 6e-8 each.
constexpr float k_slack = 4e-6f;

/// A node's children, as Volumes take them.
struct ChildrenOf {
  const Tree::Node& node;
  HWY_INLINE V lower(std::size_t k, std::size_t i) const { return load(node.lower[k] + i); }
  HWY_INLINE V upper(std::size_t k, std::size_t i) const { return load(node.upper[k] + i); }
  HWY_INLINE V normal(std::size_t k, std::size_t i) const { return load(node.normal[k] + i); }
  HWY_INLINE V slab_lower(std::size_t i) const { return load(node.slab_lower + i); }
  HWY_INLINE V slab_upper(std::size_t i) const { return load(node.slab_upper + i); }
};

/// One volume in all lanes.
struct Whole {
  const Tree::Volume& volume;
  HWY_INLINE V lower(std::size_t k, std::size_t) const { return set(volume.lower[k]); }
  HWY_INLINE V upper(std::size_t k, std::size_t) const { return set(volume.upper[k]); }
  HWY_INLINE V normal(std::size_t k, std::size_t) const { return set(volume.normal[k]); }
  HWY_INLINE V slab_lower(std::size_t) const { return set(volume.slab_lower); }
  HWY_INLINE V slab_upper(std::size_t) const { return set(volume.slab_upper); }
};

/// Volumes of one tree in its own frame and turned into that of the other.
struct alignas(64) Volumes {
  float center[3][k_width], half[3][k_width];              // of the boxes
  float other_center[3][k_width], other_half[3][k_width];  // of the boxes around them in the other frame
  float normal[3][k_width], other_normal[3][k_width];      // of the slabs
  float below[k_width], above[k_width];                    // of the slabs, from the centres of the boxes
  float front[k_width];                                    // greatest p . direction
  float size[k_width];                                     // squares of the boxes' diagonals

  /// Sets what is in the own frame, but for `front`.
  template <Rounding rounding, class Source>
  HWY_INLINE void load_own(const Source& from) {
    for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
      V on_normal = hn::Zero(k_lanes), squared = hn::Zero(k_lanes);
      for (std::size_t k = 0; k < 3; ++k) {
        const V lower = from.lower(k, i), upper = from.upper(k, i), n = from.normal(k, i);
        const V c = hn::Mul(set(0.5f), hn::Add(lower, upper)), edge = hn::Sub(upper, lower);
        on_normal = mul_add<rounding>(n, c, on_normal);
        squared = unfused_mul_add(edge, edge, squared);
        hn::Store(c, k_lanes, center[k] + i);
        hn::Store(hn::Mul(set(0.5f), edge), k_lanes, half[k] + i);
        hn::Store(n, k_lanes, normal[k] + i);
      }
      hn::Store(squared, k_lanes, size + i);
      hn::Store(hn::Sub(from.slab_lower(i), on_normal), k_lanes, below + i);
      hn::Store(hn::Sub(from.slab_upper(i), on_normal), k_lanes, above + i);
    }
  }

  /// Sets what is in the other frame.
  /// @param f whose N is the other frame
  template <Rounding rounding>
  HWY_INLINE void turn(const Frame& f) {
    for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
      for (std::size_t k = 0; k < 3; ++k) {
        V c = set(f.translation[k]), h = hn::Zero(k_lanes), n = hn::Zero(k_lanes);
        for (std::size_t m = 0; m < 3; ++m) {
          const V r = set(f.axis[m][k]);
          c = mul_add<rounding>(r, load(center[m] + i), c);
          h = mul_add<rounding>(hn::Abs(r), load(half[m] + i), h);
          n = mul_add<rounding>(r, load(normal[m] + i), n);
        }
        hn::Store(c, k_lanes, other_center[k] + i);
        hn::Store(h, k_lanes, other_half[k] + i);
        hn::Store(n, k_lanes, other_normal[k] + i);
      }
    }
  }

  /// Sets `front`. Computed like a reach, but from the origin: relative to the centre of the box, rounding would hide
  /// the gap between close layers.
  /// @param f whose N is the own frame
  template <Rounding rounding, class Source>
  HWY_INLINE void set_front(const Source& from, const Frame& f) {
    const V w[3] = {set(f.direction[0]), set(f.direction[1]), set(f.direction[2])};
    for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
      const V n[3] = {load(normal[0] + i), load(normal[1] + i), load(normal[2] + i)};
      const V along = dot<rounding>(w, n);
      V over_box = hn::Zero(k_lanes);
      V over_rest = hn::Max(hn::Mul(along, from.slab_lower(i)), hn::Mul(along, from.slab_upper(i)));
      for (std::size_t k = 0; k < 3; ++k) {
        const V c = load(center[k] + i), h = load(half[k] + i);
        over_box = mul_add<rounding>(w[k], c, mul_add<rounding>(hn::Abs(w[k]), h, over_box));
        const V rest = sub_mul<rounding>(w[k], along, n[k]);
        over_rest = mul_add<rounding>(rest, c, mul_add<rounding>(hn::Abs(rest), h, over_rest));
      }
      hn::Store(hn::Min(over_box, over_rest), k_lanes, front + i);
    }
  }
};

/// How far volumes reach from the centres of their boxes along an axis and against it.
struct Reach {
  V up, down;
};

/// Volumes as seen from the centres of their boxes, in their own frame.
template <Rounding rounding>
struct Shape {
  V half[3], normal[3];
  V below, above;

  /// Volumes i, i + 1, ...
  static HWY_INLINE Shape lanes(const Volumes& x, std::size_t i) {
    return {{load(x.half[0] + i), load(x.half[1] + i), load(x.half[2] + i)},
            {load(x.normal[0] + i), load(x.normal[1] + i), load(x.normal[2] + i)},
            load(x.below + i),
            load(x.above + i)};
  }
  /// Volume j in all lanes.
  static HWY_INLINE Shape one(const Volumes& y, std::size_t j) {
    return {{set(y.half[0][j]), set(y.half[1][j]), set(y.half[2][j])},
            {set(y.normal[0][j]), set(y.normal[1][j]), set(y.normal[2][j])},
            set(y.below[j]),
            set(y.above[j])};
  }

  /// @param n of a length of at most 1, in the own frame
  /// @param along normal . n
  HWY_INLINE Reach reach(const V (&n)[3], V along) const {
    V box = hn::Zero(k_lanes), rest = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      box = mul_add<rounding>(hn::Abs(n[k]), half[k], box);
      rest = mul_add<rounding>(hn::Abs(sub_mul<rounding>(n[k], along, normal[k])), half[k], rest);
    }
    const V to_below = hn::Mul(along, below), to_above = hn::Mul(along, above);
    return {hn::Min(box, hn::Add(rest, hn::Max(to_below, to_above))),
            hn::Min(box, hn::Sub(rest, hn::Min(to_below, to_above)))};
  }
  HWY_INLINE Reach reach(const V (&n)[3]) const { return reach(n, dot<rounding>(normal, n)); }
};

/// n . (q - p) over both volumes.
struct AxisRange {
  V low, high;

  /// How far the volumes are apart along n; negative where they overlap.
  HWY_INLINE V gap() const { return hn::Max(low, hn::Neg(high)); }
};

/// Volumes i, i + 1, ... of x and volume j of y.
template <Rounding rounding>
struct VolumePairs {
  const Volumes& x;
  const Volumes& y;
  const std::size_t i, j;

  /// From the centre of x's box to that of y's: coordinate k in x's frame, and in y's.
  HWY_INLINE V offset_in_x(std::size_t k) const { return hn::Sub(set(y.other_center[k][j]), load(x.center[k] + i)); }
  HWY_INLINE V offset_in_y(std::size_t k) const { return hn::Sub(set(y.center[k][j]), load(x.other_center[k] + i)); }
  /// Half widths of both boxes together along axis k of x's frame, and of y's.
  HWY_INLINE V extent_in_x(std::size_t k) const { return hn::Add(load(x.half[k] + i), set(y.other_half[k][j])); }
  HWY_INLINE V extent_in_y(std::size_t k) const { return hn::Add(load(x.other_half[k] + i), set(y.half[k][j])); }

  /// How far both reach from their centres towards each other.
  /// @param n in x's frame, from x to y
  /// @param f whose N is x's frame
  HWY_INLINE V reach_along(const V (&n)[3], const Frame& f) const {
    V n_y[3];
    for (std::size_t k = 0; k < 3; ++k) {
      n_y[k] = hn::Mul(set(f.axis[k][0]), n[0]);
      for (std::size_t m = 1; m < 3; ++m) n_y[k] = mul_add<rounding>(set(f.axis[k][m]), n[m], n_y[k]);
    }
    return hn::Add(Shape<rounding>::lanes(x, i).reach(n).up, Shape<rounding>::one(y, j).reach(n_y).down);
  }

  /// The ranges along the normals of the slabs of x and of y.
  struct AlongNormals {
    AxisRange of_x, of_y;
  };
  HWY_INLINE AlongNormals along_normals(const V (&offset)[3]) const {
    const Shape shape_x = Shape<rounding>::lanes(x, i), shape_y = Shape<rounding>::one(y, j);
    const V x_in_y[3] = {load(x.other_normal[0] + i), load(x.other_normal[1] + i), load(x.other_normal[2] + i)};
    const V y_in_x[3] = {set(y.other_normal[0][j]), set(y.other_normal[1][j]), set(y.other_normal[2][j])};
    const V normals = dot<rounding>(shape_x.normal, y_in_x);
    const V on_x = dot<rounding>(shape_x.normal, offset), on_y = dot<rounding>(y_in_x, offset);
    const Reach reach_y = shape_y.reach(x_in_y, normals), reach_x = shape_x.reach(y_in_x, normals);
    return {{hn::Sub(hn::Sub(on_x, reach_y.down), shape_x.above), hn::Sub(hn::Add(on_x, reach_y.up), shape_x.below)},
            {hn::Sub(hn::Add(on_y, shape_y.below), reach_x.up), hn::Add(hn::Add(on_y, shape_y.above), reach_x.down)}};
  }

  /// The largest gap of both boxes along the nine axes across an axis of each frame.
  /// @param axes_x, axes_y CrossAxes in both frames
  /// @param sweep half a translation of y, in x's frame: y is all that it passes
  HWY_INLINE V gap_across_axes(const float (&axes_x)[detail::CrossAxes::k_count][3],
                               const float (&axes_y)[detail::CrossAxes::k_count][3], const float (&sweep)[3]) const {
    V widest = set(-Tree::k_empty);
    for (std::size_t n = 0; n < detail::CrossAxes::k_count; ++n) {
      float radius_y = 0.0f;
      for (std::size_t k = 0; k < 3; ++k) {
        radius_y += std::abs(axes_y[n][k]) * y.half[k][j] + std::abs(axes_x[n][k] * sweep[k]);
      }
      V middle = hn::Zero(k_lanes), radius = set(radius_y);
      for (std::size_t k = 0; k < 3; ++k) {
        middle = mul_add<rounding>(set(axes_x[n][k]), offset_in_x(k), middle);
        radius = mul_add<rounding>(set(std::abs(axes_x[n][k])), load(x.half[k] + i), radius);
      }
      widest = hn::Max(widest, hn::Sub(hn::Abs(middle), radius));
    }
    return widest;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::volumes
HWY_AFTER_NAMESPACE();

#endif  // guard per instruction set
