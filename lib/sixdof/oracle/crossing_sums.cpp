#include <sixdof/oracle/crossing_sums.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/crossing.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/crossing_sums.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/crossing_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::crossings {
namespace HWY_NAMESPACE {

using detail::CrossingSums;
using Eigen::Vector3d;

HWY_INLINE void prefetch(const Solid& solid, std::uint32_t triangle) {
  const Tree::Corners& corners = solid.tree().corners()[triangle];
  hwy::Prefetch(corners.data());
  hwy::Prefetch(corners.data() + 2);
  hwy::Prefetch(&solid.order(triangle));
}

/// Up to eight pairs of triangles; lanes beyond the count repeat the last.
struct alignas(64) Batch {
  double corner[2][3][3][k_batch];  ///< [body][corner][axis][pair], in A's frame; B's in its own until move_to_a().
  std::uint32_t lanes = 0;          ///< Bits of the lanes that hold a pair of their own.

  /// Takes the first pairs, and prefetches those after them.
  void gather(const Solid& a, const Solid& b, std::span<const TrianglePair> pairs) {
    const std::size_t count = std::min(pairs.size(), k_batch);
    for (std::size_t lane = 0; lane < k_batch; ++lane) {
      if (lane + k_batch < pairs.size()) {
        prefetch(a, pairs[lane + k_batch].a);
        prefetch(b, pairs[lane + k_batch].b);
      }
      const TrianglePair pair = pairs[std::min(lane, count - 1)];
      put(a.tree().corners()[pair.a], lane, corner[0]);
      put(b.tree().corners()[pair.b], lane, corner[1]);
    }
    lanes = (1u << count) - 1;
  }

  /// transform_point() of B's corners.
  HWY_INLINE void move_to_a(const Pose& X_AB) {
    for (auto& of_b : corner[1]) {
      for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
        const V3 p = load(of_b, i);
        const auto coordinate = [&](int k) {
          const V xy = hn::Add(hn::Mul(set(X_AB.R(k, 0)), p.x), hn::Mul(set(X_AB.R(k, 1)), p.y));
          const V x = hn::Add(hn::Add(xy, hn::Mul(set(X_AB.R(k, 2)), p.z)), set(X_AB.t[k]));
          return hn::IfThenElseZero(hn::Ge(hn::Abs(x), set(k_smallest_exact_coordinate)), x);
        };
        store({coordinate(0), coordinate(1), coordinate(2)}, of_b, i);
      }
    }
  }

  TriangleCorners triangle(std::size_t body, std::size_t lane) const {
    return {point(corner[body][0], lane), point(corner[body][1], lane), point(corner[body][2], lane)};
  }

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

  HWY_INLINE void find(const Batch& batch) {
    std::uint32_t doubtful = 0;
    lanes = 0;
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      const Crossing crossing(load(batch.corner[0], i), load(batch.corner[1], i));
      store(crossing.start, start, i);
      store(crossing.end, end, i);
      hn::Store(crossing.start_side, k_lanes, start_side + i);
      hn::Store(crossing.end_side, k_lanes, end_side + i);
      lanes |= bits_of(crossing.crosses, i);
      doubtful |= bits_of(crossing.is_doubtful, i);
    }
    lanes &= batch.lanes;
    doubtful &= batch.lanes;
    if (std::popcount(doubtful) >= k_many) doubtful &= ~certainly_apart_lanes(batch);
    for (; doubtful != 0; doubtful &= doubtful - 1) {
      decide(batch, static_cast<std::size_t>(std::countr_zero(doubtful)));
    }
  }

 private:
  /// So many doubtful pairs take longer one by one than eight at once. They abound where faces lie in one plane.
  static constexpr int k_many = 2;

  static HWY_NOINLINE std::uint32_t certainly_apart_lanes(const Batch& batch) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      bits |= bits_of(certainly_apart(load(batch.corner[0], i), load(batch.corner[1], i)), i);
    }
    return bits;
  }

  HWY_NOINLINE void decide(const Batch& batch, std::size_t lane) {
    const std::optional<Segment> segment = sixdof::cross(batch.triangle(0, lane), batch.triangle(1, lane));
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
  Vector3d vector(std::size_t quantity) const { return {scalar(quantity), scalar(quantity + 1), scalar(quantity + 2)}; }

 private:
  alignas(64) double sum_[count][k_batch] = {};
};

/// Eight segments whose terms are added together. Points are relative to the origin of the moments.
struct alignas(64) SegmentTerms {
  double start[3][k_batch], end[3][k_batch];
  double low_a[3][k_batch], low_b[3][k_batch];  ///< Lowest corners of both triangles.
  double start_from_anchor[3][k_batch], end_from_anchor[3][k_batch];

  /// Zeros add nothing.
  void clear(std::size_t lane) {
    for (auto* points : {&start, &end, &low_a, &low_b, &start_from_anchor, &end_from_anchor}) {
      put(Vector3d::Zero(), *points, lane);
    }
  }

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

  void clear(std::size_t lane) {
    for (auto& points : corner) put(Vector3d::Zero(), points, lane);
  }

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

  /// The terms, and the lane to fill. The lane is free again unless it is kept.
  std::pair<Terms&, std::size_t> next() {
    if (size_ == k_batch) {
      terms_.add_to(sums_);
      size_ = 0;
    }
    return {terms_, size_};
  }
  void keep(bool is_kept = true) { size_ += is_kept ? 1 : 0; }

  void finish() {
    for (; size_ < k_batch; ++size_) terms_.clear(size_);
    terms_.add_to(sums_);
  }

 private:
  Sums& sums_;
  Terms terms_;
  std::size_t size_ = 0;
};

/// Edges of both paths. They wait until their potentials have been fetched from memory.
class PathEdges {
 public:
  struct Body {
    const Solid& solid;
    Vector3d origin;  ///< In the mesh's frame.
    detail::BorderPath& path;
  };

  PathEdges(const Body& a, const Body& b) : bodies_{a, b} {}

  /// @param is_kept false: the edge is none
  HWY_INLINE void add(std::size_t body, std::uint32_t triangle, int sign, bool is_kept) {
    if (size_ == k_batch) flush();
    edges_[size_] = {body, triangle, sign};
    const auto* const potential = &bodies_[body].solid.potential(triangle);
    hwy::Prefetch(is_kept ? static_cast<const void*>(potential) : edges_);
    size_ += is_kept ? 1 : 0;
  }
  void flush() {
    for (std::size_t i = 0; i < size_; ++i) {
      const auto& [solid, origin, path] = bodies_[edges_[i].body];
      path.add_edge(solid, origin, edges_[i].triangle, edges_[i].sign);
    }
    size_ = 0;
  }

 private:
  struct Edge {
    std::size_t body;
    std::uint32_t triangle;
    int sign;
  };
  Body bodies_[2];
  Edge edges_[k_batch];
  std::size_t size_ = 0;
};

/// Takes the segments one after the other.
class SegmentSums {
 public:
  SegmentSums(const Solid& a, const Solid& b, const Pose& X_AB, const Vector3d& origin)
      : a_(a),
        b_(b),
        edges_({a, origin, result_.path_a}, {b, X_AB.inverse() * origin, result_.path_b}),
        origin_(origin) {}

  HWY_INLINE void add(TrianglePair pair, const Batch& batch, std::size_t lane, const BatchSegments& segments) {
    const Vector3d start = point(segments.start, lane), end = point(segments.end, lane);
    if (result_.crossings++ == 0) result_.anchor = start;
    const Vector3d x = start - origin_, y = end - origin_;
    const Solid::Order order_a = a_.order(pair.a), order_b = b_.order(pair.b);
    const auto [terms, i] = segments_.next();
    put(x, terms.start, i);
    put(y, terms.end, i);
    put(point(batch.corner[0][order_a.lowest], lane) - origin_, terms.low_a, i);
    put(point(batch.corner[1][order_b.lowest], lane) - origin_, terms.low_b, i);
    put(start - result_.anchor, terms.start_from_anchor, i);
    put(end - result_.anchor, terms.end_from_anchor, i);
    segments_.keep();
    // On A's triangle the border comes in at the start, on B's it leaves there. Ends on other sides are taken like
    // those on the side opposite the lowest corner, but not kept: that costs less than branches no one can predict.
    const auto add_end = [&](double number, const Vector3d& p, int sign_on_a) {
      const auto side = static_cast<std::size_t>(number);
      const std::size_t body = side / 3;
      const Solid::Order order = body == 0 ? order_a : order_b;
      const bool is_opposite = side % 3 == order.opposite_side();
      const int sign = body == 0 ? sign_on_a : -sign_on_a;
      add_triangle(point(batch.corner[body][order.lowest], lane) - origin_,
                   point(batch.corner[body][order.middle()], lane) - origin_, p, sign, is_opposite);
      edges_.add(body, body == 0 ? pair.a : pair.b, sign, is_opposite);
    };
    add_end(segments.end_side[lane], y, 1);
    add_end(segments.start_side[lane], x, -1);
  }

  CrossingSums finish() {
    segments_.finish();
    triangles_.finish();
    edges_.flush();
    result_.area = sums_.vector(Sums::area);
    result_.moment = sums_.vector(Sums::moment);
    result_.beside_paths = {sums_.scalar(Sums::volume), sums_.vector(Sums::first)};
    return result_;
  }

 private:
  /// The end p of a segment moves along the side opposite the lowest corner to the middle corner.
  HWY_INLINE void add_triangle(const Vector3d& low, const Vector3d& middle, const Vector3d& p, int sign, bool is_kept) {
    const auto [terms, i] = triangles_.next();
    put(low, terms.corner[0], i);
    put(p, terms.corner[sign > 0 ? 1 : 2], i);
    put(middle, terms.corner[sign > 0 ? 2 : 1], i);
    triangles_.keep(is_kept);
  }

  CrossingSums result_;
  const Solid& a_;
  const Solid& b_;
  PathEdges edges_;
  Vector3d origin_;
  Sums sums_;
  Collector<SegmentTerms> segments_{sums_};
  Collector<TriangleTerms> triangles_{sums_};
};

CrossingSums sum_crossings(const Solid& a, const Solid& b, const Pose& X_AB, const Vector3d& origin,
                           std::span<const TrianglePair> pairs) {
  // Several batches first, then their segments: neither waits for the other's results.
  constexpr std::size_t k_batches = 8;
  SegmentSums sums(a, b, X_AB, origin);
  Batch batches[k_batches];
  BatchSegments segments[k_batches];
  while (!pairs.empty()) {
    const std::size_t count = std::min((pairs.size() + k_batch - 1) / k_batch, k_batches);
    for (std::size_t i = 0; i < count; ++i) {
      batches[i].gather(a, b, pairs.subspan(i * k_batch));
      batches[i].move_to_a(X_AB);
      segments[i].find(batches[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (std::uint32_t bits = segments[i].lanes; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
        sums.add(pairs[i * k_batch + lane], batches[i], lane, segments[i]);
      }
    }
    pairs = pairs.subspan(std::min(pairs.size(), count * k_batch));
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
