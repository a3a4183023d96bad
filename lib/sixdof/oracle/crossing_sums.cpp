#include <sixdof/oracle/crossing_sums.h>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/crossing.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/crossing_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/cache_control.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/crossing_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::crossings {
namespace HWY_NAMESPACE {

using Eigen::Vector3d;
using detail::CrossingSums;

HWY_INLINE V3 load(const double (&p)[3][k_batch], std::size_t i) {
  return {hn::Load(k_lanes, p[0] + i), hn::Load(k_lanes, p[1] + i), hn::Load(k_lanes, p[2] + i)};
}
HWY_INLINE Corners load(const double (&p)[3][3][k_batch], std::size_t i) {
  return {{load(p[0], i), load(p[1], i), load(p[2], i)}};
}
HWY_INLINE void store(const V3& v, double (&p)[3][k_batch], std::size_t i) {
  hn::Store(v.x, k_lanes, p[0] + i);
  hn::Store(v.y, k_lanes, p[1] + i);
  hn::Store(v.z, k_lanes, p[2] + i);
}

HWY_INLINE void prefetch(const Tree::Corners& corners) {
  hwy::Prefetch(corners.data());
  hwy::Prefetch(corners.data() + 2);
}

/// One lane.
HWY_INLINE Vector3d point(const double (&p)[3][k_batch], std::size_t lane) { return {p[0][lane], p[1][lane], p[2][lane]}; }
HWY_INLINE void put(const Vector3d& x, double (&p)[3][k_batch], std::size_t lane) {
  for (int k = 0; k < 3; ++k) p[k][lane] = x[k];
}

/// Up to eight pairs of triangles; lanes beyond the count repeat the last.
struct alignas(64) Batch {
  double corner_a[3][3][k_batch];  ///< [corner][axis][pair], in A's frame.
  double corner_b[3][3][k_batch];  ///< In B's mesh frame until move_to_a().
  std::uint32_t lanes = 0;         ///< Bits of the lanes that hold a pair of their own.

  void gather(const Tree& a, const Tree& b, std::span<const TrianglePair> pairs) {
    for (std::size_t lane = 0; lane < k_batch; ++lane) {
      const TrianglePair pair = pairs[std::min(lane, pairs.size() - 1)];
      put(a.corners()[pair.a], lane, corner_a);
      put(b.corners()[pair.b], lane, corner_b);
    }
    lanes = (1u << pairs.size()) - 1;
  }

  /// transform_point() of B's corners.
  HWY_INLINE void move_to_a(const Pose& X_AB) {
    for (auto& corner : corner_b) {
      for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
        const V3 p = load(corner, i);
        const auto coordinate = [&](int k) {
          const V xy = hn::Add(hn::Mul(set(X_AB.R(k, 0)), p.x), hn::Mul(set(X_AB.R(k, 1)), p.y));
          const V x = hn::Add(hn::Add(xy, hn::Mul(set(X_AB.R(k, 2)), p.z)), set(X_AB.t[k]));
          return hn::IfThenElseZero(hn::Ge(hn::Abs(x), set(k_smallest_exact_coordinate)), x);
        };
        store({coordinate(0), coordinate(1), coordinate(2)}, corner, i);
      }
    }
  }

  Vector3d point_a(std::size_t corner, std::size_t lane) const { return point(corner_a[corner], lane); }
  Vector3d point_b(std::size_t corner, std::size_t lane) const { return point(corner_b[corner], lane); }

 private:
  static void put(const Tree::Corners& from, std::size_t lane, double (&to)[3][3][k_batch]) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (int k = 0; k < 3; ++k) to[c][k][lane] = from[c][k];
    }
  }
};

/// The segments of a batch.
struct alignas(64) BatchSegments {
  double start[3][k_batch], end[3][k_batch];
  double start_side[k_batch], end_side[k_batch];
  std::uint32_t lanes = 0;  ///< Bits of the lanes that have one.

  HWY_INLINE explicit BatchSegments(const Batch& batch) {
    std::uint32_t doubtful = 0;
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      const Crossing crossing(load(batch.corner_a, i), load(batch.corner_b, i));
      store(crossing.start, start, i);
      store(crossing.end, end, i);
      hn::Store(crossing.start_side, k_lanes, start_side + i);
      hn::Store(crossing.end_side, k_lanes, end_side + i);
      lanes |= bits_of(crossing.crosses, i);
      doubtful |= bits_of(crossing.is_doubtful, i);
    }
    lanes &= batch.lanes;
    for (doubtful &= batch.lanes; doubtful != 0; doubtful &= doubtful - 1) {
      decide(batch, static_cast<std::size_t>(std::countr_zero(doubtful)));
    }
  }

  Segment segment(std::size_t lane) const {
    return {point(start, lane), point(end, lane), static_cast<int>(start_side[lane]),
            static_cast<int>(end_side[lane])};
  }

 private:
  void decide(const Batch& batch, std::size_t lane) {
    const std::optional<Segment> segment =
        sixdof::cross({batch.point_a(0, lane), batch.point_a(1, lane), batch.point_a(2, lane)},
                      {batch.point_b(0, lane), batch.point_b(1, lane), batch.point_b(2, lane)});
    if (!segment) return;
    lanes |= 1u << lane;
    put(segment->start, start, lane);
    put(segment->end, end, lane);
    start_side[lane] = segment->start_side;
    end_side[lane] = segment->end_side;
  }
};

/// triangle_moments() in lanes.
struct Moments {
  V volume;
  V3 first;

  HWY_INLINE Moments(const V3& a, const V3& b, const V3& c) {
    const V3 area = set(0.5) * cross(b - a, c - a);
    const V3 sum = a + b + c;
    const V squares = hn::Add(hn::Add(dot(a, a), dot(b, b)), hn::Add(dot(c, c), dot(sum, sum)));
    volume = hn::Mul(set(1.0 / 3.0), dot(a, area));
    first = hn::Mul(set(1.0 / 24.0), squares) * area;
  }
};

/// Eight sums of each quantity, one per lane: the order of additions depends on the order of the segments only.
class Sums {
 public:
  enum Quantity : std::size_t {
    volume,
    first,  // and the next two
    area = first + 3,
    moment = area + 3,
    count = moment + 3
  };

  HWY_INLINE void add(std::size_t quantity, V value, std::size_t i) {
    double* const to = sum_[quantity] + i;
    hn::Store(hn::Add(hn::Load(k_lanes, to), value), k_lanes, to);
  }
  HWY_INLINE void add(std::size_t quantity, const V3& value, std::size_t i) {
    add(quantity, value.x, i);
    add(quantity + 1, value.y, i);
    add(quantity + 2, value.z, i);
  }
  HWY_INLINE void add(const Moments& m, std::size_t i) {
    add(volume, m.volume, i);
    add(first, m.first, i);
  }

  double scalar(std::size_t quantity) const {
    double sum = 0.0;
    for (const double x : sum_[quantity]) sum += x;
    return sum;
  }
  Vector3d vector(std::size_t quantity) const {
    return {scalar(quantity), scalar(quantity + 1), scalar(quantity + 2)};
  }

 private:
  alignas(64) double sum_[count][k_batch] = {};
};

/// Eight segments whose terms are added together. Points are relative to the origin of the moments.
struct alignas(64) SegmentTerms {
  double start[3][k_batch], end[3][k_batch];
  double low_a[3][k_batch], low_b[3][k_batch];                  ///< Lowest corners of both triangles.
  double start_from_anchor[3][k_batch], end_from_anchor[3][k_batch];

  /// On A's triangle a segment has the part inside B on its left; on B's it has the part inside A on its right.
  HWY_INLINE void add_to(Sums& sums) const {
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      const V3 u = load(start_from_anchor, i), v = load(end_from_anchor, i);
      sums.add(Sums::area, cross(u, v), i);
      sums.add(Sums::moment, hn::Add(hn::Add(dot(u, u), dot(u, v)), dot(v, v)) * (v - u), i);
      const V3 x = load(start, i), y = load(end, i);
      sums.add(Moments(load(low_a, i), x, y), i);
      sums.add(Moments(load(low_b, i), y, x), i);
    }
  }
};

/// Eight triangles between the curves and the paths, relative to the origin of the moments.
struct alignas(64) TriangleTerms {
  double corner[3][3][k_batch];

  HWY_INLINE void add_to(Sums& sums) const {
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      sums.add(Moments(load(corner[0], i), load(corner[1], i), load(corner[2], i)), i);
    }
  }
};

/// Collects terms and adds eight at a time.
template <class Terms>
class Collector {
 public:
  explicit Collector(Sums& sums) : sums_(sums) {}

  /// The terms to fill, and the lane.
  std::pair<Terms&, std::size_t> next() {
    if (size_ == k_batch) flush();
    return {terms_, size_++};
  }
  void flush() {
    terms_.add_to(sums_);
    terms_ = {};
    size_ = 0;
  }

 private:
  Sums& sums_;
  Terms terms_{};  // zeros add nothing
  std::size_t size_ = 0;
};

/// Takes the segments one after the other.
class SegmentSums {
 public:
  SegmentSums(const Solid& a, const Solid& b, const Pose& X_AB, const Vector3d& origin)
      : body_a_{a, origin, result_.path_a}, body_b_{b, X_AB.inverse() * origin, result_.path_b}, origin_(origin) {}

  HWY_INLINE void add(TrianglePair pair, const Batch& batch, std::size_t lane, const Segment& segment) {
    if (result_.crossings++ == 0) result_.anchor = segment.start;
    const Vector3d x = segment.start - origin_, y = segment.end - origin_;
    const Solid::Order order_a = body_a_.solid.order(pair.a), order_b = body_b_.solid.order(pair.b);
    const Vector3d low_a = batch.point_a(order_a.lowest, lane) - origin_;
    const Vector3d low_b = batch.point_b(order_b.lowest, lane) - origin_;
    const auto [terms, i] = segments_.next();
    put(x, terms.start, i);
    put(y, terms.end, i);
    put(low_a, terms.low_a, i);
    put(low_b, terms.low_b, i);
    put(segment.start - result_.anchor, terms.start_from_anchor, i);
    put(segment.end - result_.anchor, terms.end_from_anchor, i);
    // On A's triangle the border comes in at the start.
    const auto add_end = [&](int side, const Vector3d& p, int sign) {
      if (side < 3) {
        if (side != order_a.opposite_side()) return;
        add_triangle(low_a, batch.point_a(order_a.middle(), lane) - origin_, p, sign);
        body_a_.defer(pair.a, sign);
      } else {
        if (side - 3 != order_b.opposite_side()) return;
        add_triangle(low_b, batch.point_b(order_b.middle(), lane) - origin_, p, -sign);
        body_b_.defer(pair.b, -sign);
      }
    };
    add_end(segment.end_side, y, 1);
    add_end(segment.start_side, x, -1);
  }

  CrossingSums finish() {
    segments_.flush();
    triangles_.flush();
    body_a_.add_edges();
    body_b_.add_edges();
    result_.area = sums_.vector(Sums::area);
    result_.moment = sums_.vector(Sums::moment);
    result_.beside_paths = {sums_.scalar(Sums::volume), sums_.vector(Sums::first)};
    return result_;
  }

 private:
  /// A path's edges wait until their potentials have been fetched from memory.
  struct Body {
    const Solid& solid;
    Vector3d origin;  // in the mesh's frame
    detail::BorderPath& path;
    std::array<std::pair<std::uint32_t, int>, 8> edges{};  // triangle, sign
    std::size_t size = 0;

    void defer(std::uint32_t triangle, int sign) {
      if (size == edges.size()) add_edges();
      hwy::Prefetch(&solid.potential(triangle));
      edges[size++] = {triangle, sign};
    }
    void add_edges() {
      for (std::size_t i = 0; i < size; ++i) path.add_edge(solid, origin, edges[i].first, edges[i].second);
      size = 0;
    }
  };

  /// The end p of a segment moves along the side opposite the lowest corner to the middle corner.
  void add_triangle(const Vector3d& low, const Vector3d& middle, const Vector3d& p, int sign) {
    const auto [terms, i] = triangles_.next();
    put(low, terms.corner[0], i);
    put(sign > 0 ? p : middle, terms.corner[1], i);
    put(sign > 0 ? middle : p, terms.corner[2], i);
  }

  CrossingSums result_;
  Body body_a_, body_b_;
  Vector3d origin_;
  Sums sums_;
  Collector<SegmentTerms> segments_{sums_};
  Collector<TriangleTerms> triangles_{sums_};
};

CrossingSums sum_crossings(const Solid& a, const Solid& b, const Pose& X_AB, const Vector3d& origin,
                           std::span<const TrianglePair> pairs) {
  SegmentSums sums(a, b, X_AB, origin);
  Batch batch;
  for (; !pairs.empty(); pairs = pairs.subspan(std::min(pairs.size(), k_batch))) {
    for (std::size_t i = k_batch; i < std::min(pairs.size(), 2 * k_batch); ++i) {
      prefetch(a.tree().corners()[pairs[i].a]);
      prefetch(b.tree().corners()[pairs[i].b]);
    }
    batch.gather(a.tree(), b.tree(), pairs.first(std::min(pairs.size(), k_batch)));
    batch.move_to_a(X_AB);
    const BatchSegments segments(batch);
    for (std::uint32_t bits = segments.lanes; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      sums.add(pairs[lane], batch, lane, segments.segment(lane));
    }
  }
  return sums.finish();
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::crossings
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof {
namespace crossings {
HWY_EXPORT(sum_crossings);
}  // namespace crossings

namespace detail {

void BorderPath::add_edge(const Solid& solid, const Eigen::Vector3d& origin, std::uint32_t triangle, int sign) {
  potential.add(solid.potential(triangle), sign);
  const Tree::Corners& corners = solid.tree().corners()[triangle];
  const Solid::Order order = solid.order(triangle);
  const Eigen::Vector3d low = corners[order.lowest] - origin;
  const Eigen::Vector3d middle = corners[order.middle()] - origin;
  const Eigen::Vector3d cross = low.cross(middle);
  area += (0.5 * sign) * cross;
  first_order += (sign / 6.0) * (low + middle) * cross.transpose();
}

CrossingSums sum_crossings(const Solid& a, const Solid& b, const Pose& X_AB, const Eigen::Vector3d& origin,
                           std::span<const TrianglePair> pairs) {
  return HWY_DYNAMIC_DISPATCH(crossings::sum_crossings)(a, b, X_AB, origin, pairs);
}

}  // namespace detail
}  // namespace sixdof
#endif  // HWY_ONCE
