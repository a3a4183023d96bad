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

/// Writes the corners of four triangles to the lanes lane .. lane + 3.
HWY_INLINE void gather_four(const double* const (&from)[4], double (&to)[9][k_batch], std::size_t lane) {
#if HWY_TARGET != HWY_SCALAR
  constexpr hn::CappedTag<double, 4> d;
  if constexpr (hn::MaxLanes(d) == 4) {
    for (std::size_t k = 0; k < 8; k += 4) {  // transposed
      const auto row_0 = hn::LoadU(d, from[0] + k), row_1 = hn::LoadU(d, from[1] + k);
      const auto row_2 = hn::LoadU(d, from[2] + k), row_3 = hn::LoadU(d, from[3] + k);
      const auto even_01 = hn::InterleaveLower(d, row_0, row_1), odd_01 = hn::InterleaveUpper(d, row_0, row_1);
      const auto even_23 = hn::InterleaveLower(d, row_2, row_3), odd_23 = hn::InterleaveUpper(d, row_2, row_3);
      hn::Store(hn::ConcatLowerLower(d, even_23, even_01), d, to[k] + lane);
      hn::Store(hn::ConcatLowerLower(d, odd_23, odd_01), d, to[k + 1] + lane);
      hn::Store(hn::ConcatUpperUpper(d, even_23, even_01), d, to[k + 2] + lane);
      hn::Store(hn::ConcatUpperUpper(d, odd_23, odd_01), d, to[k + 3] + lane);
    }
    for (std::size_t i = 0; i < 4; ++i) to[8][lane + i] = from[i][8];
    return;
  }
#endif
  for (std::size_t k = 0; k < 9; ++k) {
    for (std::size_t i = 0; i < 4; ++i) to[k][lane + i] = from[i][k];
  }
}

/// Up to eight pairs of triangles; lanes beyond the count repeat the last.
struct alignas(64) Batch {
  double coordinate[2][9][k_batch];  ///< [body][3 corner + axis][pair], in A's frame; B's in its own until move_to_a().
  std::uint32_t lanes = 0;           ///< Bits of the lanes that hold a pair of their own.

  /// Takes the first pairs, and prefetches those after them.
  HWY_INLINE void gather(const Solid& a, const Solid& b, std::span<const TrianglePair> pairs) {
    const std::size_t count = std::min(pairs.size(), k_batch);
    for (std::size_t lane = k_batch; lane < std::min(pairs.size(), 2 * k_batch); ++lane) {
      prefetch(a, pairs[lane].a);
      prefetch(b, pairs[lane].b);
    }
    const Tree::Corners* const corners_a = a.tree().corners().data();
    const Tree::Corners* const corners_b = b.tree().corners().data();
    for (std::size_t lane = 0; lane < k_batch; lane += 4) {
      const double* of_a[4];
      const double* of_b[4];
      for (std::size_t i = 0; i < 4; ++i) {
        const TrianglePair pair = pairs[std::min(lane + i, count - 1)];
        of_a[i] = corners_a[pair.a][0].data();
        of_b[i] = corners_b[pair.b][0].data();
      }
      gather_four(of_a, coordinate[0], lane);
      gather_four(of_b, coordinate[1], lane);
    }
    lanes = (1u << count) - 1;
  }

  /// transform_point() of B's corners.
  HWY_INLINE void move_to_a(const Pose& X_AB) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
        const V3 p = corner(1, c, i);
        for (int k = 0; k < 3; ++k) {
          const V xy = hn::Add(hn::Mul(set(X_AB.R(k, 0)), p.x), hn::Mul(set(X_AB.R(k, 1)), p.y));
          const V x = hn::Add(hn::Add(xy, hn::Mul(set(X_AB.R(k, 2)), p.z)), set(X_AB.t[k]));
          hn::Store(hn::IfThenElseZero(hn::Ge(hn::Abs(x), set(k_smallest_exact_coordinate)), x), k_lanes,
                    coordinate[1][3 * c + static_cast<std::size_t>(k)] + i);
        }
      }
    }
  }

  HWY_INLINE V3 corner(std::size_t body, std::size_t c, std::size_t i) const {
    const auto at = [&](std::size_t k) { return hn::Load(k_lanes, coordinate[body][3 * c + k] + i); };
    return {at(0), at(1), at(2)};
  }
  HWY_INLINE Corners corners(std::size_t body, std::size_t i) const {
    return {{corner(body, 0, i), corner(body, 1, i), corner(body, 2, i)}};
  }
  /// The first coordinate of one corner; the others are k_batch and twice k_batch behind.
  HWY_INLINE const double* point(std::size_t body, std::size_t c, std::size_t lane) const {
    return coordinate[body][3 * c] + lane;
  }
  TriangleCorners triangle(std::size_t body, std::size_t lane) const {
    const auto at = [&](std::size_t c) {
      const double* const p = point(body, c, lane);
      return Vector3d(p[0], p[k_batch], p[2 * k_batch]);
    };
    return {at(0), at(1), at(2)};
  }
};

/// Copies one lane of three arrays of k_batch numbers, one behind the other.
HWY_INLINE void copy(const double* from, double (&to)[3][k_batch], std::size_t lane) {
  for (std::size_t k = 0; k < 3; ++k) to[k][lane] = from[k * k_batch];
}

/// The segments of a batch.
struct alignas(64) BatchSegments {
  double start[3][k_batch], end[3][k_batch];
  double start_side[k_batch], end_side[k_batch];
  std::uint32_t lanes = 0;  ///< Bits of the lanes that have one.

  HWY_INLINE void find(const Batch& batch) {
    std::uint32_t doubtful = 0;
    lanes = 0;
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      const Crossing crossing(batch.corners(0, i), batch.corners(1, i));
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
      bits |= bits_of(certainly_apart(batch.corners(0, i), batch.corners(1, i)), i);
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
  V3 area;
  V volume;
  V3 first;

  HWY_INLINE Moments(const V3& a, const V3& b, const V3& c) {
    area = set(0.5) * cross(b - a, c - a);
    const V3 sum = a + b + c;
    const V squares = hn::Add(hn::Add(dot(a, a), dot(b, b)), hn::Add(dot(c, c), dot(sum, sum)));
    volume = hn::Mul(set(1.0 / 3.0), dot(a, area));
    first = hn::Mul(set(1.0 / 24.0), squares) * area;
  }
};

/// Eight sums of each quantity, one per lane: the order of additions depends on the order of the terms only.
template <std::size_t count>
class Sums {
 public:
  HWY_INLINE void add(std::size_t quantity, V value, std::size_t i) {
    double* const to = sum_[quantity] + i;
    hn::Store(hn::Add(hn::Load(k_lanes, to), value), k_lanes, to);
  }
  HWY_INLINE void add(std::size_t quantity, const V3& value, std::size_t i) {
    add(quantity, value.x, i);
    add(quantity + 1, value.y, i);
    add(quantity + 2, value.z, i);
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

HWY_INLINE V3 in_all_lanes(const Vector3d& p) { return {set(p.x()), set(p.y()), set(p.z())}; }

/// Collects terms and adds eight at a time.
/// @tparam Terms with add_to(sums, ...) and clear(lane, point), after which a lane adds nothing
template <class Terms>
class Collector {
 public:
  /// The terms, and the lane to fill. The lane is free again unless it is kept.
  template <class... Arguments>
  HWY_INLINE std::pair<Terms&, std::size_t> next(Arguments&... arguments) {
    if (HWY_UNLIKELY(size_ == k_batch)) {
      terms_.add_to(arguments...);
      size_ = 0;
    }
    return {terms_, size_};
  }
  HWY_INLINE void keep(bool is_kept = true) { size_ += is_kept ? 1 : 0; }

  template <class... Arguments>
  void finish(const Vector3d& point, Arguments&... arguments) {
    for (; size_ < k_batch; ++size_) terms_.clear(size_, point);
    terms_.add_to(arguments...);
  }

 private:
  Terms terms_;
  std::size_t size_ = 0;
};

/// Integrals that follow from the segments, and from the triangles between the curves and the paths.
struct CurveSums : Sums<11> {
  enum Quantity : std::size_t {
    volume,
    first,  // and the next two, as those below
    area = first + 3,
    moment = area + 3,
    curvature = moment + 3
  };
  HWY_INLINE void add_moments(const Moments& m, std::size_t i) {
    add(volume, m.volume, i);
    add(first, m.first, i);
  }
};

/// What a segment adds to the curvature of the volume along a direction d (Overlap::curvature). While B moves, the
/// segment, of length l, sweeps an area l (n_a . d) / |n_a x n_b| of B's triangle; times n_b . d that is what the
/// gradient's component changes. n_a x n_b has the segment's direction, by which its sign is that of the true normals.
/// @param area_a, area_b normals of any length and either sign; where one vanishes, nothing is added
HWY_INLINE V curvature(const V3& segment, const V3& area_a, const V3& area_b, const V3& along) {
  const V sine = dot(segment, cross(area_a, area_b));
  const V change = hn::Div(hn::Mul(hn::Mul(dot(area_a, along), dot(area_b, along)), dot(segment, segment)), sine);
  return hn::IfThenZeroElse(hn::Eq(sine, hn::Zero(k_lanes)), change);
}

/// Eight segments whose terms are added together, in A's frame.
struct alignas(64) SegmentTerms {
  double start[3][k_batch], end[3][k_batch];
  double low_a[3][k_batch], low_b[3][k_batch];  ///< Lowest corners of both triangles.

  void clear(std::size_t lane, const Vector3d& point) {
    for (auto* points : {&start, &end, &low_a, &low_b}) put(point, *points, lane);
  }

  /// On A's triangle a segment has the part inside B on its left; on B's it has the part inside A on its right.
  /// @param anchor, origin of `area` and `moment`, and of the fluxes
  /// @param along of the curvature; zero: none
  HWY_NOINLINE void add_to(CurveSums& sums, const Vector3d& anchor, const Vector3d& origin,
                           const Vector3d& along) const {
    const V3 from_anchor = in_all_lanes(anchor), from_origin = in_all_lanes(origin);
    const bool is_curved = !along.isZero(0.0);
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      const V3 p = load(start, i), q = load(end, i);
      const V3 u = p - from_anchor, v = q - from_anchor;
      sums.add(CurveSums::area, cross(u, v), i);
      sums.add(CurveSums::moment, hn::Add(hn::Add(dot(u, u), dot(u, v)), dot(v, v)) * (v - u), i);
      const V3 x = p - from_origin, y = q - from_origin;
      const Moments of_a(load(low_a, i) - from_origin, x, y), of_b(load(low_b, i) - from_origin, y, x);
      sums.add_moments(of_a, i);
      sums.add_moments(of_b, i);
      if (is_curved) sums.add(CurveSums::curvature, curvature(q - p, of_a.area, of_b.area, in_all_lanes(along)), i);
    }
  }
};

/// Eight triangles between the curves and the paths, in A's frame.
struct alignas(64) TriangleTerms {
  double corner[3][3][k_batch];

  void clear(std::size_t lane, const Vector3d& point) {
    for (auto& points : corner) put(point, points, lane);
  }

  HWY_NOINLINE void add_to(CurveSums& sums, const Vector3d& origin) const {
    const V3 from_origin = in_all_lanes(origin);
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      sums.add_moments(
          Moments(load(corner[0], i) - from_origin, load(corner[1], i) - from_origin, load(corner[2], i) - from_origin),
          i);
    }
  }
};

/// Integrals along a path.
struct PathSums : Sums<12> {
  enum Quantity : std::size_t {
    area,             // 2 BorderPath::area
    first_order = 3,  // 6 BorderPath::first_order, row by row
  };
};

/// Eight edges of a path, in the mesh's frame.
struct alignas(64) EdgeTerms {
  double from[3][k_batch], to[3][k_batch];

  void clear(std::size_t lane, const Vector3d& point) {
    put(point, from, lane);
    put(point, to, lane);
  }

  HWY_NOINLINE void add_to(PathSums& sums, const Vector3d& origin) const {
    const V3 from_origin = in_all_lanes(origin);
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      const V3 p = load(from, i) - from_origin, q = load(to, i) - from_origin;
      const V3 area = cross(p, q), middle = p + q;
      sums.add(PathSums::area, area, i);
      sums.add(PathSums::first_order, middle.x * area, i);
      sums.add(PathSums::first_order + 3, middle.y * area, i);
      sums.add(PathSums::first_order + 6, middle.z * area, i);
    }
  }
};

/// Edges of one body's path: from a triangle's lowest to its middle corner, or back. They wait until their potentials
/// have been fetched from memory.
class PathEdges {
 public:
  /// @param origin of the integrals, in the mesh's frame
  PathEdges(const Solid& solid, const Vector3d& origin) : solid_(solid), origin_(origin) {}

  /// @param sign -1: from the middle to the lowest corner
  /// @param is_kept false: the edge is none
  HWY_INLINE void add(std::uint32_t triangle, int sign, bool is_kept) {
    if (HWY_UNLIKELY(size_ == k_batch)) flush();
    edges_[size_] = {triangle, sign > 0 ? 0u : 1u};
    hwy::Prefetch(is_kept ? static_cast<const void*>(&solid_.potential(triangle)) : edges_);
    size_ += is_kept ? 1 : 0;
  }

  detail::BorderPath finish() {
    flush();
    terms_.finish(origin_, sums_, origin_);
    detail::BorderPath path;
    path.potential = forth_and_back_[0];
    path.potential.add(forth_and_back_[1], -1);
    path.area = 0.5 * sums_.vector(PathSums::area);
    for (int k = 0; k < 3; ++k) {
      path.first_order.row(k) = sums_.vector(PathSums::first_order + 3 * static_cast<std::size_t>(k)) / 6.0;
    }
    return path;
  }

 private:
  HWY_NOINLINE void flush() {
    for (std::size_t i = 0; i < size_; ++i) {
      const auto [triangle, back] = edges_[i];
      forth_and_back_[back].add(solid_.potential(triangle));
      const Tree::Corners& corners = solid_.tree().corners()[triangle];
      const Solid::Order order = solid_.order(triangle);
      const std::size_t ends[2] = {order.lowest, order.middle()};
      const auto [terms, lane] = terms_.next(sums_, origin_);
      put(corners[ends[back]], terms.from, lane);
      put(corners[ends[1 - back]], terms.to, lane);
      terms_.keep();
    }
    size_ = 0;
  }

  struct Edge {
    std::uint32_t triangle, back;
  };
  const Solid& solid_;
  Vector3d origin_;
  Edge edges_[k_batch];
  std::size_t size_ = 0;
  Solid::Potential forth_and_back_[2];
  PathSums sums_;
  Collector<EdgeTerms> terms_;
};

/// Takes the segments one after the other.
class SegmentSums {
 public:
  SegmentSums(const Solid& a, const Solid& b, const Pose& X_AB, const Vector3d& origin, const Vector3d& along)
      : a_(a),
        b_(b),
        edges_{PathEdges(a, origin), PathEdges(b, X_AB.inverse() * origin)},
        origin_(origin),
        along_(along) {}

  HWY_INLINE void add(TrianglePair pair, const Batch& batch, std::size_t lane, const BatchSegments& segments) {
    if (HWY_UNLIKELY(crossings_++ == 0)) anchor_ = point(segments.start, lane);
    const Solid::Order order[2] = {a_.order(pair.a), b_.order(pair.b)};
    const auto [terms, i] = segments_.next(sums_, anchor_, origin_, along_);
    const double* const start = segments.start[0] + lane;
    const double* const end = segments.end[0] + lane;
    copy(start, terms.start, i);
    copy(end, terms.end, i);
    copy(batch.point(0, order[0].lowest, lane), terms.low_a, i);
    copy(batch.point(1, order[1].lowest, lane), terms.low_b, i);
    segments_.keep();
    // On A's triangle the border comes in at the start, on B's it leaves there. Ends on other sides are taken like
    // those on the side opposite the lowest corner, but not kept: that costs less than branches no one can predict.
    const auto add_end = [&](double number, const double* p, int sign_on_a) {
      const auto side = static_cast<std::uint32_t>(static_cast<std::int32_t>(number));
      const std::size_t body = side >= 3 ? 1 : 0;
      const Solid::Order of_body = order[body];
      const bool is_opposite = side - 3 * body == of_body.opposite_side();
      const int sign = body == 0 ? sign_on_a : -sign_on_a;
      // The end moves along its side to the triangle's middle corner.
      const auto [triangle, j] = triangles_.next(sums_, origin_);
      copy(batch.point(body, of_body.lowest, lane), triangle.corner[0], j);
      copy(p, triangle.corner[sign > 0 ? 1 : 2], j);
      copy(batch.point(body, of_body.middle(), lane), triangle.corner[sign > 0 ? 2 : 1], j);
      triangles_.keep(is_opposite);
      edges_[body].add(body == 0 ? pair.a : pair.b, sign, is_opposite);
    };
    add_end(segments.end_side[lane], end, 1);
    add_end(segments.start_side[lane], start, -1);
  }

  CrossingSums finish() {
    segments_.finish(origin_, sums_, anchor_, origin_, along_);
    triangles_.finish(origin_, sums_, origin_);
    return {.crossings = crossings_,
            .anchor = anchor_,
            .area = sums_.vector(CurveSums::area),
            .moment = sums_.vector(CurveSums::moment),
            .beside_paths = {sums_.scalar(CurveSums::volume), sums_.vector(CurveSums::first)},
            .path_a = edges_[0].finish(),
            .path_b = edges_[1].finish(),
            .curvature = sums_.scalar(CurveSums::curvature)};
  }

 private:
  const Solid& a_;
  const Solid& b_;
  PathEdges edges_[2];
  Vector3d origin_, along_, anchor_ = Vector3d::Zero();
  std::size_t crossings_ = 0;
  CurveSums sums_;
  Collector<SegmentTerms> segments_;
  Collector<TriangleTerms> triangles_;
};

CrossingSums sum_crossings(const Solid& a, const Solid& b, const Pose& X_AB, const Vector3d& origin,
                           std::span<const TrianglePair> pairs, const Vector3d& along) {
  // Several batches first, then their segments: neither waits for the other's results.
  constexpr std::size_t k_batches = 8;
  SegmentSums sums(a, b, X_AB, origin, along);
  Batch batches[k_batches];
  BatchSegments segments[k_batches];
  while (!pairs.empty()) {
    const std::size_t count = std::min((pairs.size() + k_batch - 1) / k_batch, k_batches);
    for (std::size_t i = 0; i < count; ++i) batches[i].gather(a, b, pairs.subspan(i * k_batch));
    for (std::size_t i = 0; i < count; ++i) {
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

CrossingSums sum_crossings(const Solid& a, const Solid& b, const Pose& X_AB, const Eigen::Vector3d& origin,
                           std::span<const TrianglePair> pairs, const Eigen::Vector3d& along) {
  return HWY_DYNAMIC_DISPATCH(crossings::sum_crossings)(a, b, X_AB, origin, pairs, along);
}

}  // namespace detail
}  // namespace sixdof
#endif  // HWY_ONCE
