// Part of distance_search.cpp: volumes of the children of two nodes of two trees, and bounds on their distances. Taken once per instruction set: the guard is Highway's for that.
#if defined(SIXDOF_ORACLE_CHILDREN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_ORACLE_CHILDREN_INL_H_
#undef SIXDOF_ORACLE_CHILDREN_INL_H_
#else
#define SIXDOF_ORACLE_CHILDREN_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/pair_bounds-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::pair_bounds {
namespace HWY_NAMESPACE {

/// Where the volumes of a node's children come from.
struct NodeLanes {
  const Tree::Node& node;
  HWY_INLINE V lower(std::size_t k, std::size_t i) const { return load(node.lower[k] + i); }
  HWY_INLINE V upper(std::size_t k, std::size_t i) const { return load(node.upper[k] + i); }
  HWY_INLINE V normal(std::size_t k, std::size_t i) const { return load(node.normal[k] + i); }
  HWY_INLINE V slab_lower(std::size_t i) const { return load(node.slab_lower + i); }
  HWY_INLINE V slab_upper(std::size_t i) const { return load(node.slab_upper + i); }
};

/// One volume, in all lanes.
struct SameInAllLanes {
  const Tree::Volume& volume;
  HWY_INLINE V lower(std::size_t k, std::size_t) const { return set(volume.lower[k]); }
  HWY_INLINE V upper(std::size_t k, std::size_t) const { return set(volume.upper[k]); }
  HWY_INLINE V normal(std::size_t k, std::size_t) const { return set(volume.normal[k]); }
  HWY_INLINE V slab_lower(std::size_t) const { return set(volume.slab_lower); }
  HWY_INLINE V slab_upper(std::size_t) const { return set(volume.slab_upper); }
};

/// Volumes of one tree in its own frame and in that of the other tree.
struct alignas(64) Volumes {
  float center[3][k_width], half[3][k_width];              // of the boxes
  float other_center[3][k_width], other_half[3][k_width];  // of the boxes around them in the other frame
  float normal[3][k_width], other_normal[3][k_width];      // of the slabs
  float below[k_width], above[k_width];                    // of the slabs, from the centres of the boxes
  float front[k_width];                                    // greatest p . w, w towards the other body

  /// @param own, other frames whose N is the own and the other tree's
  template <Rounding rounding, class Source>
  HWY_INLINE void load_from(const Source& from, const Frame& own, const Frame& other) {
    const V w[3] = {set(own.direction[0]), set(own.direction[1]), set(own.direction[2])};
    for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
      V c[3], h[3], n[3];
      V on_normal = hn::Zero(k_lanes);
      for (std::size_t k = 0; k < 3; ++k) {
        const V lower = from.lower(k, i), upper = from.upper(k, i);
        c[k] = hn::Mul(set(0.5f), hn::Add(lower, upper));
        h[k] = hn::Mul(set(0.5f), hn::Sub(upper, lower));
        n[k] = from.normal(k, i);
        on_normal = mul_add<rounding>(n[k], c[k], on_normal);
        hn::Store(c[k], k_lanes, center[k] + i);
        hn::Store(h[k], k_lanes, half[k] + i);
        hn::Store(n[k], k_lanes, normal[k] + i);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        V c_other = set(other.translation[k]), h_other = hn::Zero(k_lanes), n_other = hn::Zero(k_lanes);
        for (std::size_t m = 0; m < 3; ++m) {
          const V r = set(other.axis[m][k]);
          c_other = mul_add<rounding>(r, c[m], c_other);
          h_other = mul_add<rounding>(hn::Abs(r), h[m], h_other);
          n_other = mul_add<rounding>(r, n[m], n_other);
        }
        hn::Store(c_other, k_lanes, other_center[k] + i);
        hn::Store(h_other, k_lanes, other_half[k] + i);
        hn::Store(n_other, k_lanes, other_normal[k] + i);
      }
      const V slab_lower = from.slab_lower(i), slab_upper = from.slab_upper(i);
      hn::Store(hn::Sub(slab_lower, on_normal), k_lanes, below + i);
      hn::Store(hn::Sub(slab_upper, on_normal), k_lanes, above + i);
      // As a reach, but from the origin: the rounding of the slab's distance from the centre of the box would blur
      // layers.
      const V along = dot<rounding>(w, n);
      V over_box = hn::Zero(k_lanes);
      V over_rest = hn::Max(hn::Mul(along, slab_lower), hn::Mul(along, slab_upper));
      for (std::size_t k = 0; k < 3; ++k) {
        over_box = mul_add<rounding>(w[k], c[k], mul_add<rounding>(hn::Abs(w[k]), h[k], over_box));
        const V rest = sub_mul<rounding>(w[k], along, n[k]);
        over_rest = mul_add<rounding>(rest, c[k], mul_add<rounding>(hn::Abs(rest), h[k], over_rest));
      }
      hn::Store(hn::Min(over_box, over_rest), k_lanes, front + i);
    }
  }
};

/// What reaches from the centres of boxes.
template <Rounding rounding>
struct Shape {
  V half[3], normal[3];
  V below, above;

  /// Lanes i, i + 1, ...
  static HWY_INLINE Shape lanes(const Volumes& x, std::size_t i) {
    return {{load(x.half[0] + i), load(x.half[1] + i), load(x.half[2] + i)},
            {load(x.normal[0] + i), load(x.normal[1] + i), load(x.normal[2] + i)},
            load(x.below + i),
            load(x.above + i)};
  }
  /// Volume j, in all lanes.
  static HWY_INLINE Shape one(const Volumes& x, std::size_t j) {
    return {{set(x.half[0][j]), set(x.half[1][j]), set(x.half[2][j])},
            {set(x.normal[0][j]), set(x.normal[1][j]), set(x.normal[2][j])},
            set(x.below[j]),
            set(x.above[j])};
  }

  /// @param x unit vector in the own frame
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

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::pair_bounds
HWY_AFTER_NAMESPACE();

#endif  // guard per instruction set
