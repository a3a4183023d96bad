// Part of crossing_sums.cpp, which includes it once per instruction set: it has no include guard.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/crossing_lanes-inl.h>
#include <sixdof/oracle/solid.h>

// Candidates on their way to crossings: batches of eight pairs of triangles, and a queue of those that intersect.

HWY_BEFORE_NAMESPACE();
namespace sixdof::crossings {
namespace HWY_NAMESPACE {

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

/// The corners of `count` pairs of triangles, in A's frame; those of a batch's B in its own until move().
template <std::size_t count>
struct alignas(64) PairCorners {
  double coordinate[2][9][count];  ///< [body][3 corner + axis][pair]

  HWY_INLINE V3 corner(std::size_t body, std::size_t c, std::size_t i) const {
    const auto at = [&](std::size_t k) { return hn::Load(k_lanes, coordinate[body][3 * c + k] + i); };
    return {at(0), at(1), at(2)};
  }
  HWY_INLINE Corners corners(std::size_t body, std::size_t i) const {
    return {{corner(body, 0, i), corner(body, 1, i), corner(body, 2, i)}};
  }
  TriangleCorners triangle(std::size_t body, std::size_t pair) const {
    const auto at = [&](std::size_t c) {
      const auto& x = coordinate[body];
      return Eigen::Vector3d(x[3 * c][pair], x[3 * c + 1][pair], x[3 * c + 2][pair]);
    };
    return {at(0), at(1), at(2)};
  }
};

constexpr std::size_t k_most_batches = 4;  ///< That take a step together.

/// Up to eight pairs of triangles; lanes beyond the count repeat the last.
class alignas(64) Batch {
 public:
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
      gather_four(of_a, corners_.coordinate[0], lane);
      gather_four(of_b, corners_.coordinate[1], lane);
    }
    lanes_ = (1u << count) - 1;
  }

  /// transform_point() of B's corners, and all corners as floats.
  HWY_INLINE void move(const Pose& X_AB) {
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      const V3 origin = corners_.corner(0, 0, i);
      for (std::size_t c = 0; c < 3; ++c) {
        if (c != 0) round(corners_.corner(0, c, i) - origin, 0, c, i);
        const V3 p = corners_.corner(1, c, i);
        const V3 q{transformed(X_AB, p, 0), transformed(X_AB, p, 1), transformed(X_AB, p, 2)};
        const V coordinates[3] = {q.x, q.y, q.z};
        for (std::size_t k = 0; k < 3; ++k) hn::Store(coordinates[k], k_lanes, corners_.coordinate[1][3 * c + k] + i);
        round(q - origin, 1, c, i);
      }
    }
  }

  /// Bits of the lanes whose triangles intersect.
  HWY_INLINE std::uint32_t crossing() const {
    Decision decision;
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_float_lanes)) {
      const FloatCorners a = rounded_corners(0, i), b = rounded_corners(1, i);
      decision.add(Crossing<FloatFilter>(a, b, FloatFilter(greatest_magnitude(a, b))), i);
    }
    const std::uint32_t doubtful = decision.doubtful(lanes_);
    return (decision.certain & lanes_) | (HWY_UNLIKELY(doubtful != 0) ? crossing_closely(doubtful) : 0);
  }

  const PairCorners<k_batch>& corners() const { return corners_; }
  /// Bits of the lanes that hold a pair of their own.
  std::uint32_t lanes() const { return lanes_; }

 private:
  using FloatCorners = CornersOf<FloatV>;

  /// From this many doubtful pairs in a batch on, certainly_apart_lanes() tests all eight at once, which is faster than
  /// one by one. Doubtful pairs are frequent where faces lie in one plane.
  static constexpr int k_many = 2;

  /// Bits of the lanes that intersect, and that do not.
  struct Decision {
    std::uint32_t certain = 0, none = 0;

    template <class Filter>
    HWY_INLINE void add(const Crossing<Filter>& crossing, std::size_t i) {
      constexpr hn::DFromV<typename Filter::Vec> d;
      certain |= bits_of(d, crossing.is_certain(), i);
      none |= bits_of(d, crossing.is_none(), i);
    }
    std::uint32_t doubtful(std::uint32_t lanes) const { return lanes & ~(certain | none); }
  };

  static HWY_INLINE V transformed(const Pose& X_AB, const V3& p, int k) {
    const V xy = hn::Add(hn::Mul(set(X_AB.R(k, 0)), p.x), hn::Mul(set(X_AB.R(k, 1)), p.y));
    const V x = hn::Add(hn::Add(xy, hn::Mul(set(X_AB.R(k, 2)), p.z)), set(X_AB.t[k]));
    return hn::IfThenElseZero(hn::Ge(hn::Abs(x), set(k_smallest_exact_coordinate)), x);
  }

  HWY_INLINE void round(const V3& p, std::size_t body, std::size_t c, std::size_t i) {
    constexpr hn::Rebind<float, Lanes> d;
    const V coordinates[3] = {p.x, p.y, p.z};
    for (std::size_t k = 0; k < 3; ++k) {
      hn::Store(hn::DemoteTo(d, coordinates[k]), d, rounded_[body][3 * c + k] + i);
    }
  }

  HWY_INLINE Vector3<FloatV> rounded_corner(std::size_t body, std::size_t c, std::size_t i) const {
    const auto at = [&](std::size_t k) { return hn::Load(k_float_lanes, rounded_[body][3 * c + k] + i); };
    return {at(0), at(1), at(2)};
  }
  HWY_INLINE FloatCorners rounded_corners(std::size_t body, std::size_t i) const {
    const FloatV zero = number<FloatV>(0);
    const Vector3<FloatV> origin{zero, zero, zero};
    return {{body == 0 ? origin : rounded_corner(1, 0, i), rounded_corner(body, 1, i), rounded_corner(body, 2, i)}};
  }
  static HWY_INLINE FloatV greatest_magnitude(const FloatCorners& a, const FloatCorners& b) {
    FloatV greatest = number<FloatV>(0);
    for (const Vector3<FloatV>& p : {a.corner[1], a.corner[2], b.corner[0], b.corner[1], b.corner[2]}) {
      const Vector3<FloatV> m = abs(p);
      greatest = hn::Max(hn::Max(greatest, m.x), hn::Max(m.y, m.z));
    }
    return greatest;
  }

  /// Of lanes that floats do not decide.
  HWY_NOINLINE std::uint32_t crossing_closely(std::uint32_t lanes) const {
    Decision decision;
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      decision.add(Crossing<DoubleFilter>(corners_.corners(0, i), corners_.corners(1, i), {}), i);
    }
    std::uint32_t crossing = decision.certain & lanes, doubtful = decision.doubtful(lanes);
    if (std::popcount(doubtful) >= k_many) doubtful &= ~certainly_apart_lanes();
    for (; doubtful != 0; doubtful &= doubtful - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(doubtful));
      if (sixdof::cross(corners_.triangle(0, lane), corners_.triangle(1, lane))) crossing |= 1u << lane;
    }
    return crossing;
  }

  HWY_NOINLINE std::uint32_t certainly_apart_lanes() const {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      bits |= bits_of(certainly_apart(corners_.corners(0, i), corners_.corners(1, i)), i);
    }
    return bits;
  }

  PairCorners<k_batch> corners_;
  alignas(64) float rounded_[2][9][k_batch];  ///< Relative to A's corner 0, whose row is not used.
  std::uint32_t lanes_ = 0;                   ///< Bits of the lanes that hold a pair of their own.
};

/// Calls take(batch, index of its first pair) for all pairs, in their order. Several batches do each step together.
/// between() uses what was taken in the round before: reading data just after they were written in pieces of another
/// size is slow (no store forwarding).
template <class Between, class Take>
HWY_INLINE void for_each_batch(const Solid& a, const Solid& b, const Pose& X_AB, std::span<const TrianglePair> pairs,
                               const Between& between, const Take& take) {
  Batch batches[k_most_batches];
  for (std::size_t first = 0; first < pairs.size(); first += k_most_batches * k_batch) {
    const std::size_t count = std::min((pairs.size() - first + k_batch - 1) / k_batch, k_most_batches);
    for (std::size_t i = 0; i < count; ++i) batches[i].gather(a, b, pairs.subspan(first + i * k_batch));
    for (std::size_t i = 0; i < count; ++i) batches[i].move(X_AB);
    between();
    for (std::size_t i = 0; i < count; ++i) take(batches[i], first + i * k_batch);
  }
}

/// Pairs that intersect, in their order, whatever others were between them.
class CrossingQueue {
 public:
  std::size_t size() const { return size_; }
  const TrianglePair* pairs() const { return pairs_; }
  const auto& corners() const { return corners_; }

  /// @param lanes bits of those to add
  HWY_INLINE void add(const Batch& batch, std::span<const TrianglePair> pairs, std::uint32_t lanes) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
      pairs_[size_] = pairs[lane];
      for (std::size_t body = 0; body < 2; ++body) {
        for (std::size_t k = 0; k < 9; ++k) {
          corners_.coordinate[body][k][size_] = batch.corners().coordinate[body][k][lane];
        }
      }
      ++size_;
    }
  }

  /// Removes the first `count` pairs, a multiple of k_batch, after which less than k_batch are left.
  HWY_INLINE void remove(std::size_t count) {
    size_ -= count;
    std::copy_n(pairs_ + count, size_, pairs_);
    for (auto& rows : corners_.coordinate) {
      for (auto& row : rows) {
        for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
          hn::Store(hn::Load(k_lanes, row + count + i), k_lanes, row + i);
        }
      }
    }
  }

 private:
  static constexpr std::size_t k_space = (k_most_batches + 1) * k_batch;

  PairCorners<k_space> corners_;
  TrianglePair pairs_[k_space];
  std::size_t size_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::crossings
HWY_AFTER_NAMESPACE();
