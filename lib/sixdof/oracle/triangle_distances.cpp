#include <sixdof/oracle/triangle_distances.h>

#include <algorithm>
#include <limits>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/triangle_distances.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/proximity/double_lanes-inl.h>

// The same operations in the same order as triangle_distance.cpp, which says why they are these.

HWY_BEFORE_NAMESPACE();
namespace sixdof::triangle_distances {
namespace HWY_NAMESPACE {

using namespace double_lanes::HWY_NAMESPACE;

/// Whether 0 < x < 1.
HWY_INLINE M is_inside(V x) { return hn::And(hn::Gt(x, hn::Zero(k_lanes)), hn::Lt(x, set(1.0))); }

struct Best {
  V squared;
  V3 difference;  ///< Point of a less point of b.

  HWY_INLINE Best()
      : squared(set(std::numeric_limits<double>::infinity())),
        difference{hn::Zero(k_lanes), hn::Zero(k_lanes), hn::Zero(k_lanes)} {}

  /// @param w a difference of points, where `found`
  HWY_INLINE void update(const V3& w, M found) {
    const V d = dot(w, w);
    const M closer = hn::And(found, hn::Lt(d, squared));
    squared = select(closer, d, squared);
    difference = select(closer, w, difference);
  }
};

struct Edge {
  V3 from, to, along;
  V squared;
  HWY_INLINE Edge(const V3& p, const V3& q) : from(p), to(q), along(q - p), squared(dot(along, along)) {}
};

/// From a point to the closest point of an edge.
HWY_INLINE V3 point_to_edge(const V3& p, const Edge& edge) {
  const V3 from = p - edge.from;
  const V along = dot(from, edge.along);
  const V3 inside = from - hn::Div(along, edge.squared) * edge.along;
  const V3 near = select(hn::Gt(along, hn::Zero(k_lanes)), inside, from);
  return select(hn::Ge(along, edge.squared), p - edge.to, near);
}

/// A normal of u and v, by which w = w0 + s u - t v is made normal to both.
struct CommonNormal {
  V3 u, v, n;
  V squared;
  M is_wide;      ///< u and v are clearly not parallel.
  M is_doubtful;  ///< Nearly parallel.

  HWY_INLINE CommonNormal(const V3& along_u, V uu, const V3& along_v, V vv)
      : u(along_u), v(along_v), n(cross(u, v)), squared(dot(n, n)) {
    const auto exceeds = [&](double sine) { return hn::Gt(squared, hn::Mul(hn::Mul(set(sine * sine), uu), vv)); };
    is_wide = exceeds(detail::k_wide_sine);
    is_doubtful = hn::AndNot(is_wide, exceeds(detail::k_parallel_sine));
  }
};

struct Solution {
  V s, t;
  V3 w;
  M found;

  HWY_INLINE Solution(const V3& w0, const CommonNormal& normal)
      : s(hn::Zero(k_lanes)), t(hn::Zero(k_lanes)), w(w0), found(normal.is_wide) {
    refine(w0, normal);
    found = hn::And(found, hn::And(is_near(s), is_near(t)));
    if (hn::AllFalse(k_lanes, found)) return;
    refine(w0, normal);
  }

 private:
  HWY_INLINE void refine(const V3& w0, const CommonNormal& normal) {
    s = hn::Sub(s, hn::Div(dot(cross(w, normal.v), normal.n), normal.squared));
    t = hn::Sub(t, hn::Div(dot(cross(w, normal.u), normal.n), normal.squared));
    w = (w0 + s * normal.u) - t * normal.v;
  }
  static HWY_INLINE M is_near(V x) {
    return hn::And(hn::Gt(x, set(-detail::k_margin)), hn::Lt(x, set(1.0 + detail::k_margin)));
  }
};

/// A triangle's edges, and its plane: spanned by -(edge 0) and the edge from corner 0 to corner 2.
struct Face {
  Edge edge[3];
  CommonNormal normal;

  HWY_INLINE explicit Face(const Corners& t)
      : Face(t, Edge(t.corner[0], t.corner[1]), Edge(t.corner[0], t.corner[2])) {}

  /// Of a point to this triangle: the points are those of a if `sign` is 1, of b if it is -1.
  template <int sign>
  HWY_INLINE void update(const V3& p, Best& best) const {
    const auto keep = [&](const V3& w, M found) { best.update(sign > 0 ? w : -w, found); };
    for (const Edge& e : edge) keep(point_to_edge(p, e), hn::Not(no_lane()));
    const Solution x(p - edge[0].from, normal);
    const M inside = hn::And(hn::And(hn::Gt(x.s, hn::Zero(k_lanes)), hn::Gt(x.t, hn::Zero(k_lanes))),
                             hn::Lt(hn::Add(x.s, x.t), set(1.0)));
    keep(x.w, hn::And(x.found, inside));
  }

 private:
  HWY_INLINE Face(const Corners& t, const Edge& first, const Edge& second)
      : edge{first, Edge(t.corner[1], t.corner[2]), Edge(t.corner[2], t.corner[0])},
        normal(-first.along, first.squared, second.along, second.squared) {}
};

/// The largest sum of the magnitudes of a corner's coordinates.
HWY_INLINE V size_of(const Corners& a, const Corners& b) {
  V size = hn::Zero(k_lanes);
  for (const Corners* t : {&a, &b}) {
    for (const V3& p : t->corner) size = hn::Max(size, sum(abs(p)));
  }
  return size;
}

struct Distances {
  V distance;
  V3 difference;  ///< From the closest point of b to that of a.
  M is_certain;   ///< Where it is triangle_triangle_distance().

  HWY_INLINE Distances(const Corners& corners_a, const Corners& corners_b) {
    const V3& origin = corners_a.corner[0];
    Corners a, b;
    for (std::size_t i = 0; i < 3; ++i) {
      a.corner[i] = corners_a.corner[i] - origin;
      b.corner[i] = corners_b.corner[i] - origin;
    }
    const Face face_a(a), face_b(b);
    M doubtful = hn::Or(face_a.normal.is_doubtful, face_b.normal.is_doubtful);
    Best best;
    for (const V3& p : a.corner) face_b.update<1>(p, best);
    for (const V3& p : b.corner) face_a.update<-1>(p, best);
    for (const Edge& p : face_a.edge) {
      for (const Edge& q : face_b.edge) {
        const CommonNormal normal(p.along, p.squared, q.along, q.squared);
        doubtful = hn::Or(doubtful, normal.is_doubtful);
        const Solution x(p.from - q.from, normal);
        best.update(x.w, hn::And(x.found, hn::And(is_inside(x.s), is_inside(x.t))));
      }
    }
    distance = hn::Sqrt(best.squared);
    difference = best.difference;
    is_certain = hn::AndNot(doubtful, are_apart(a, b, difference));
  }

 private:
  /// By the projections on the line through the closest points.
  static HWY_INLINE M are_apart(const Corners& a, const Corners& b, const V3& difference) {
    V low = dot(difference, a.corner[0]), high = dot(difference, b.corner[0]);
    for (std::size_t i = 1; i < 3; ++i) {
      low = hn::Min(low, dot(difference, a.corner[i]));
      high = hn::Max(high, dot(difference, b.corner[i]));
    }
    const V3 m = abs(difference);
    const V rounding = hn::Mul(hn::Mul(set(detail::k_safe_gap), size_of(a, b)), hn::Max(m.x, hn::Max(m.y, m.z)));
    return hn::Gt(hn::Sub(low, high), rounding);
  }
};

/// Returns the pairs (bits) whose results hold.
std::uint32_t measure(const TriangleDistances::Corners& corner, std::size_t count, double (&distance)[k_batch],
                      double (&direction)[3][k_batch]) {
  std::uint32_t certain = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(k_lanes)) {
    const Distances x(load(corner[0], i), load(corner[1], i));
    hn::Store(x.distance, k_lanes, distance + i);
    store(-x.difference, direction, i);
    certain |= bits_of(x.is_certain, i);
  }
  return certain;
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::triangle_distances
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof {
namespace triangle_distances {
HWY_EXPORT(measure);

// Calls from within: a dispatch among one instruction set alone (ARM's NEON) knows unqualified names only.
constexpr auto measure_now = [](auto&&... given) { return HWY_DYNAMIC_DISPATCH(measure)(given...); };
}  // namespace triangle_distances

void TriangleDistances::add(const TriangleCorners& a, const TriangleCorners& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      corner_[0][i][k][count_] = a[i][k];
      corner_[1][i][k][count_] = b[i][k];
    }
  }
  ++count_;
}

void TriangleDistances::measure() {
  // The other lanes repeat the first pair.
  for (auto& of_body : corner_) {
    for (auto& of_corner : of_body) {
      for (auto& of_axis : of_corner) std::fill(of_axis + count_, of_axis + k_most, of_axis[0]);
    }
  }
  measured_ = triangle_distances::measure_now(corner_, count_, distance_, direction_);
}

}  // namespace sixdof
#endif  // HWY_ONCE
