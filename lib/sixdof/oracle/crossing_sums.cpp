#include <sixdof/oracle/crossing_sums.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/crossing_sums.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/crossing_batch-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::crossings {
namespace HWY_NAMESPACE {

using detail::CrossingSums;
using Eigen::Vector3d;

/// Where the triangles of eight pairs that intersect do so.
struct alignas(64) BatchSegments {
  double start[3][k_batch], end[3][k_batch];
  double start_side[k_batch], end_side[k_batch];

  /// @param corners of the pairs from `first` on, of which those in `lanes` (bits) matter
  HWY_INLINE void find(const auto& corners, std::size_t first, std::uint32_t lanes) {
    std::uint32_t accurate = 0;
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      const Crossing<DoubleFilter> crossing(corners.corners(0, first + i), corners.corners(1, first + i), {});
      store(crossing.start(), start, i);
      store(crossing.end(), end, i);
      hn::Store(crossing.start_side(), k_lanes, start_side + i);
      hn::Store(crossing.end_side(), k_lanes, end_side + i);
      accurate |= bits_of(crossing.is_accurate(), i);
    }
    for (std::uint32_t bits = lanes & ~accurate; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      take(sixdof::cross(corners.triangle(0, first + lane), corners.triangle(1, first + lane)).value(), lane);
    }
  }

 private:
  HWY_NOINLINE void take(const Segment& segment, std::size_t lane) {
    put(segment.start, start, lane);
    put(segment.end, end, lane);
    start_side[lane] = segment.start_side;
    end_side[lane] = segment.end_side;
  }
};

/// Multiples of triangle_moments() in lanes.
struct Moments {
  static constexpr double k_volume = 6.0, k_first = 48.0;  ///< These multiples.
  V3 area;                                                 ///< Twice the triangle's.
  V volume;
  V3 first;

  HWY_INLINE Moments(const V3& a, const V3& b, const V3& c) : area(cross(b - a, c - a)) {
    const V3 sum = a + b + c;
    const V squares = hn::Add(hn::Add(dot(a, a), dot(b, b)), hn::Add(dot(c, c), dot(sum, sum)));
    volume = dot(a, area);
    first = squares * area;
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
HWY_INLINE V only(M mask, V x) { return hn::IfThenElseZero(mask, x); }
HWY_INLINE V3 only(M mask, const V3& a) { return {only(mask, a.x), only(mask, a.y), only(mask, a.z)}; }

/// What a segment adds to the curvature of the volume along a direction d (Overlap::curvature). While B moves, the
/// segment, of length l, sweeps an area l (n_a . d) / |n_a x n_b| of B's triangle; times n_b . d that is what the
/// gradient's component changes. n_a x n_b has the segment's direction, by which its sign is that of the true normals.
/// @param area_a, area_b normals of any length and either sign; where one vanishes, nothing is added
HWY_INLINE V curvature(const V3& segment, const V3& area_a, const V3& area_b, const V3& along) {
  const V sine = dot(segment, cross(area_a, area_b));
  const V change = hn::Div(hn::Mul(hn::Mul(dot(area_a, along), dot(area_b, along)), dot(segment, segment)), sine);
  return hn::IfThenZeroElse(hn::Eq(sine, hn::Zero(k_lanes)), change);
}

/// Integrals along a path.
struct PathSums : Sums<12> {
  enum Quantity : std::size_t {
    area,             // 2 BorderPath::area
    first_order = 3,  // 6 BorderPath::first_order, row by row
  };
};

/// Edges of one body's path: from a triangle's lowest to its middle corner, or back. They wait until their potentials
/// have been fetched from memory.
class PathEdges {
 public:
  /// @param origin of the integrals, in the mesh's frame
  PathEdges(const Solid& solid, const Vector3d& origin) : solid_(solid), origin_(origin) {}

  /// @param goes_back from the middle to the lowest corner
  HWY_INLINE void add(std::uint32_t triangle, bool goes_back) {
    hwy::Prefetch(&solid_.potential(triangle));
    edges_[size_++] = {triangle, goes_back ? 1u : 0u};
    if (HWY_UNLIKELY(size_ == k_batch)) flush();
  }

  detail::BorderPath finish() {
    flush();
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
  struct Edge {
    std::uint32_t triangle, back;
  };

  HWY_NOINLINE void flush() {
    alignas(64) double from[3][k_batch], to[3][k_batch];  // in the mesh's frame
    for (std::size_t lane = 0; lane < size_; ++lane) {
      const auto [triangle, back] = edges_[lane];
      forth_and_back_[back].add(solid_.potential(triangle));
      const Tree::Corners& corners = solid_.tree().corners()[triangle];
      const Solid::Order order = solid_.order(triangle);
      const std::size_t ends[2] = {order.lowest, order.middle()};
      put(corners[ends[back]], from, lane);
      put(corners[ends[1 - back]], to, lane);
    }
    for (; size_ < k_batch; ++size_) {  // these add nothing
      put(origin_, from, size_);
      put(origin_, to, size_);
    }
    size_ = 0;
    const V3 from_origin = in_all_lanes(origin_);
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      const V3 p = load(from, i) - from_origin, q = load(to, i) - from_origin;
      const V3 area = cross(p, q), middle = p + q;
      sums_.add(PathSums::area, area, i);
      sums_.add(PathSums::first_order, middle.x * area, i);
      sums_.add(PathSums::first_order + 3, middle.y * area, i);
      sums_.add(PathSums::first_order + 6, middle.z * area, i);
    }
  }

  const Solid& solid_;
  Vector3d origin_;
  Edge edges_[k_batch];
  std::size_t size_ = 0;
  Solid::Potential forth_and_back_[2];
  PathSums sums_;
};

/// Solid::Order of the triangles of one body.
class Orders {
 public:
  HWY_INLINE void put(Solid::Order order, std::size_t lane) {
    number_[lane] = order.lowest + (order.rises ? k_rises : 0);
  }

  /// In lanes.
  struct Lowest {
    M is_0, is_1, rises;
    V opposite_side;  ///< Solid::Order::opposite_side()

    HWY_INLINE V3 lowest(const Corners& t) const { return pick(t.corner[0], t.corner[1], t.corner[2]); }
    HWY_INLINE V3 middle(const Corners& t) const {
      return select(rises, pick(t.corner[1], t.corner[2], t.corner[0]), pick(t.corner[2], t.corner[0], t.corner[1]));
    }

   private:
    HWY_INLINE V3 pick(const V3& if_0, const V3& if_1, const V3& if_2) const {
      return select(is_0, if_0, select(is_1, if_1, if_2));
    }
  };
  HWY_INLINE Lowest at(std::size_t i) const {
    const V number = hn::Load(k_lanes, number_ + i);
    const M rises = hn::Ge(number, set(k_rises));
    const V lowest = hn::Sub(number, only(rises, set(k_rises)));
    const M is_0 = hn::Eq(lowest, hn::Zero(k_lanes)), is_1 = hn::Eq(lowest, set(1.0));
    return {is_0, is_1, rises, hn::IfThenElseZero(hn::Or(is_0, is_1), hn::Add(lowest, set(1.0)))};
  }

 private:
  static constexpr int k_rises = 4;
  alignas(64) double number_[k_batch];
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
};

/// Takes the pairs that intersect, eight at a time.
class SegmentSums {
 public:
  /// @param origin, along as of sum_crossings()
  SegmentSums(const Solid& a, const Solid& b, const Pose& X_AB, const Vector3d& origin, const Vector3d& along)
      : a_(a),
        b_(b),
        edges_{PathEdges(a, origin), PathEdges(b, X_AB.inverse() * origin)},
        origin_(origin),
        along_(along),
        is_curved_(!along.isZero(0.0)) {}

  /// @param first, count pairs of the queue; count is at most k_batch
  HWY_NOINLINE void add(const CrossingQueue& queue, std::size_t first, std::size_t count) {
    const std::uint32_t lanes = (1u << count) - 1;
    const TrianglePair* const pairs = queue.pairs() + first;
    Orders orders[2];
    for (std::size_t lane = 0; lane < k_batch; ++lane) {
      const TrianglePair pair = pairs[lane < count ? lane : 0];
      orders[0].put(a_.order(pair.a), lane);
      orders[1].put(b_.order(pair.b), lane);
    }
    segments_.find(queue.corners(), first, lanes);
    if (HWY_UNLIKELY(crossings_ == 0)) anchor_ = point(segments_.start, 0);
    crossings_ += count;
    std::uint32_t ends = 0;
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      const M is_used = hn::Lt(hn::Iota(k_lanes, static_cast<double>(i)), set(static_cast<double>(count)));
      const Side of_a(queue.corners().corners(0, first + i), orders[0].at(i), origin_);
      const Side of_b(queue.corners().corners(1, first + i), orders[1].at(i), origin_);
      V volume;
      V3 first_moment;
      add_segments(of_a, of_b, is_used, i, volume, first_moment);
      ends |= add_ends(of_a, of_b, is_used, i, volume, first_moment);
      sums_.add(CurveSums::volume, volume, i);
      sums_.add(CurveSums::first, first_moment, i);
    }
    for (; ends != 0; ends &= ends - 1) {
      const auto end = static_cast<std::size_t>(std::countr_zero(ends));
      const TrianglePair pair = pairs[end % k_batch];
      const bool is_b = (end & k_of_b) != 0, is_start = (end & k_at_start) != 0;
      edges_[is_b ? 1 : 0].add(is_b ? pair.b : pair.a, is_b != is_start);
    }
  }

  CrossingSums finish() {
    return {.crossings = crossings_,
            .anchor = anchor_,
            .area = sums_.vector(CurveSums::area),
            .moment = sums_.vector(CurveSums::moment),
            .beside_paths = {sums_.scalar(CurveSums::volume) / Moments::k_volume,
                             sums_.vector(CurveSums::first) / Moments::k_first},
            .path_a = edges_[0].finish(),
            .path_b = edges_[1].finish(),
            .curvature = sums_.scalar(CurveSums::curvature)};
  }

 private:
  /// Ends of segments on sides opposite the lowest corner, as bits: lane + k_of_b, if that is B's + k_at_start.
  static constexpr std::size_t k_of_b = k_batch, k_at_start = 2 * k_batch;

  /// One body's triangles: two of their corners, from the origin.
  struct Side {
    V3 lowest, middle;
    V opposite_side;

    HWY_INLINE Side(const Corners& t, const Orders::Lowest& order, const Vector3d& origin)
        : lowest(order.lowest(t) - in_all_lanes(origin)),
          middle(order.middle(t) - in_all_lanes(origin)),
          opposite_side(order.opposite_side) {}
  };

  /// On A's triangle a segment has the part inside B on its left; on B's it has the part inside A on its right.
  /// @param volume, first_moment set to those of the triangles (lowest corner, start, end)
  HWY_INLINE void add_segments(const Side& of_a, const Side& of_b, M is_used, std::size_t i, V& volume,
                               V3& first_moment) {
    const V3 p = load(segments_.start, i), q = load(segments_.end, i);
    const V3 u = p - in_all_lanes(anchor_), v = q - in_all_lanes(anchor_);
    sums_.add(CurveSums::area, only(is_used, cross(u, v)), i);
    sums_.add(CurveSums::moment, only(is_used, hn::Add(hn::Add(dot(u, u), dot(u, v)), dot(v, v)) * (v - u)), i);
    const V3 x = p - in_all_lanes(origin_), y = q - in_all_lanes(origin_);
    const Moments on_a(of_a.lowest, x, y), on_b(of_b.lowest, y, x);
    volume = only(is_used, hn::Add(on_a.volume, on_b.volume));
    first_moment = only(is_used, on_a.first + on_b.first);
    if (is_curved_) {
      sums_.add(CurveSums::curvature, only(is_used, curvature(q - p, on_a.area, on_b.area, in_all_lanes(along_))), i);
    }
  }

  /// On A's triangle the border comes in at the start, on B's it leaves there. An end on the side opposite the lowest
  /// corner moves along its side to the triangle's middle corner. Returns these ends.
  /// @param volume, first_moment to which those of the triangles between are added
  HWY_INLINE std::uint32_t add_ends(const Side& of_a, const Side& of_b, M is_used, std::size_t i, V& volume,
                                    V3& first_moment) {
    std::uint32_t ends = 0;
    const V sides[2] = {hn::Load(k_lanes, segments_.end_side + i), hn::Load(k_lanes, segments_.start_side + i)};
    const V3 points[2] = {load(segments_.end, i), load(segments_.start, i)};
    for (std::size_t at_start = 0; at_start < 2; ++at_start) {
      const M on_a = hn::Lt(sides[at_start], set(3.0));
      const M of_opposite_a = hn::And(is_used, hn::Eq(sides[at_start], of_a.opposite_side));
      const M of_opposite_b = hn::And(is_used, hn::Eq(sides[at_start], hn::Add(of_b.opposite_side, set(3.0))));
      const V3 lowest = select(on_a, of_a.lowest, of_b.lowest), middle = select(on_a, of_a.middle, of_b.middle);
      const V3 end = points[at_start] - in_all_lanes(origin_);
      const M comes_in = at_start == 0 ? on_a : hn::Not(on_a);
      const Moments between(lowest, select(comes_in, end, middle), select(comes_in, middle, end));
      const M is_opposite = hn::Or(of_opposite_a, of_opposite_b);
      volume = hn::Add(volume, only(is_opposite, between.volume));
      first_moment = first_moment + only(is_opposite, between.first);
      ends |= bits_of(of_opposite_a, i) << (at_start * k_at_start);
      ends |= bits_of(of_opposite_b, i) << (at_start * k_at_start + k_of_b);
    }
    return ends;
  }

  const Solid& a_;
  const Solid& b_;
  PathEdges edges_[2];
  Vector3d origin_, along_, anchor_ = Vector3d::Zero();
  bool is_curved_;
  std::size_t crossings_ = 0;
  BatchSegments segments_;
  CurveSums sums_;
};

void keep_crossings(const Solid& a, const Solid& b, const Pose& X_AB, std::vector<TrianglePair>& pairs) {
  std::size_t kept = 0;
  for_each_batch(
      a, b, X_AB, pairs, [] {},
      [&](const Batch& batch, std::size_t first) {
        for (std::uint32_t lanes = batch.crossing(); lanes != 0; lanes &= lanes - 1) {
          pairs[kept++] = pairs[first + static_cast<std::size_t>(std::countr_zero(lanes))];
        }
      });
  pairs.resize(kept);
}

CrossingSums sum_crossings(const Solid& a, const Solid& b, const Pose& X_AB, const Vector3d& origin,
                           const detail::PairSource& next, const Vector3d& along) {
  SegmentSums sums(a, b, X_AB, origin, along);
  CrossingQueue queue;
  const auto sum_whole_batches = [&] {
    std::size_t count = 0;
    for (; count + k_batch <= queue.size(); count += k_batch) sums.add(queue, count, k_batch);
    if (count != 0) queue.remove(count);
  };
  for (detail::PairPiece piece = next(); !piece.pairs.empty(); piece = next()) {
    for_each_batch(a, b, X_AB, piece.pairs, sum_whole_batches, [&](const Batch& batch, std::size_t first) {
      const std::uint32_t lanes = piece.intersect ? batch.lanes() : batch.crossing();
      if (lanes != 0) queue.add(batch, piece.pairs.subspan(first), lanes);
    });
  }
  sum_whole_batches();
  if (queue.size() != 0) sums.add(queue, 0, queue.size());
  return sums.finish();
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::crossings
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof {
namespace crossings {
HWY_EXPORT(keep_crossings);
HWY_EXPORT(sum_crossings);

// Calls from within: a dispatch among one instruction set alone (ARM's NEON) knows unqualified names only.
constexpr auto keep_crossings_now = [](auto&&... given) { return HWY_DYNAMIC_DISPATCH(keep_crossings)(given...); };
constexpr auto sum_crossings_now = [](auto&&... given) { return HWY_DYNAMIC_DISPATCH(sum_crossings)(given...); };
}  // namespace crossings

namespace detail {

void keep_crossings(const Solid& a, const Solid& b, const Pose& X_AB, std::vector<TrianglePair>& pairs) {
  crossings::keep_crossings_now(a, b, X_AB, pairs);
}

CrossingSums sum_crossings(const Solid& a, const Solid& b, const Pose& X_AB, const Eigen::Vector3d& origin,
                           const PairSource& next, const Eigen::Vector3d& along) {
  return crossings::sum_crossings_now(a, b, X_AB, origin, next, along);
}

CrossingSums sum_crossings(const Solid& a, const Solid& b, const Pose& X_AB, const Eigen::Vector3d& origin,
                           std::span<const TrianglePair> pairs, const Eigen::Vector3d& along) {
  return sum_crossings(
      a, b, X_AB, origin, [&] { return PairPiece{std::exchange(pairs, {})}; }, along);
}

}  // namespace detail
}  // namespace sixdof
#endif  // HWY_ONCE
