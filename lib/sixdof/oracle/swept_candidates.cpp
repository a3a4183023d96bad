#include <sixdof/oracle/swept_candidates.h>

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/swept_candidates.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/candidates-inl.h>

// Of two triangles each test that could tell them apart at one place of B (boxes along each axis, both planes) says
// between which shares of the way it cannot. The pair may meet where no test can.

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

/// Shares of the way, per lane.
struct Shares {
  V first, last;

  /// Where low <= x * speed <= high. Lanes whose product of speed and any share is lost in rounding are not narrowed.
  HWY_INLINE void narrow(V low, V high, V speed) {
    constexpr float k_lost = 1e-30f;
    const M still = hn::Le(hn::Abs(speed), hn::Set(k_lanes, k_lost));
    const V inverse = hn::Div(hn::Set(k_lanes, 1.0f), hn::IfThenElse(still, hn::Set(k_lanes, 1.0f), speed));
    const V x = hn::Mul(low, inverse), y = hn::Mul(high, inverse);
    first = hn::Max(first, hn::IfThenElse(still, hn::Set(k_lanes, -k_beyond), hn::Min(x, y)));
    last = hn::Min(last, hn::IfThenElse(still, hn::Set(k_lanes, k_beyond), hn::Max(x, y)));
  }
};

/// Lowest and highest of three corners above a plane.
struct Span {
  V low, high;

  HWY_INLINE Span(const V (&normal)[3], const V (&origin)[3], const V (&corner)[3][3]) {
    V height[3];
    for (std::size_t c = 0; c < 3; ++c) {
      height[c] = hn::Mul(normal[0], hn::Sub(corner[c][0], origin[0]));
      height[c] = mul_add(normal[1], hn::Sub(corner[c][1], origin[1]), height[c]);
      height[c] = mul_add(normal[2], hn::Sub(corner[c][2], origin[2]), height[c]);
    }
    low = hn::Min(hn::Min(height[0], height[1]), height[2]);
    high = hn::Max(hn::Max(height[0], height[1]), height[2]);
  }
};

/// Pairs of triangles that may meet on the way: bit 4 i + j; and on which shares of it.
HWY_INLINE std::uint32_t sweeping_triangles(const LeafLanes& a, const LeafLanes& b, const Placement& x, float* first,
                                            float* last) {
  std::uint32_t bits = 0;
  const V zero = hn::Zero(k_lanes);
  const V one = hn::Set(k_lanes, 1.0f);
  const V way[3] = {hn::Set(k_lanes, x.way[0]), hn::Set(k_lanes, x.way[1]), hn::Set(k_lanes, x.way[2])};
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    const auto of_a = [i](const float* p) { return load_of_a(p, i); };
    const auto of_b = [i](const float* p) { return load_of_b(p, i); };
    Shares shares{hn::Set(k_lanes, -k_beyond), hn::Set(k_lanes, k_beyond)};
    // B's boxes have the slack.
    for (std::size_t k = 0; k < 3; ++k) {
      narrow_to_boxes(of_a(a.lower[k]), of_a(a.upper[k]), of_b(b.lower[k]), of_b(b.upper[k]), k, x, shares.first,
                      shares.last);
    }
    const auto meets = [&] {
      const V pad = hn::Set(k_lanes, k_share_rounding);
      const V low = hn::Sub(hn::Max(shares.first, hn::Neg(one)), pad);
      const V high = hn::Add(hn::Min(shares.last, hn::Add(one, one)), pad);
      hn::StoreU(low, k_lanes, first + i);
      hn::StoreU(high, k_lanes, last + i);
      return hn::And(hn::Le(low, high), hn::And(hn::Le(low, one), hn::Ge(high, zero)));
    };
    if (hn::AllFalse(k_lanes, meets())) continue;
    V corner_a[3][3], corner_b[3][3], normal_a[3], normal_b[3];
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        corner_a[c][k] = of_a(a.corner[c][k]);
        corner_b[c][k] = of_b(b.corner[c][k]);
      }
      normal_a[k] = of_a(a.normal[k]);
      normal_b[k] = of_b(b.normal[k]);
    }
    V tolerance_a, tolerance_b;
    height_tolerances(of_a(a.size), of_b(b.size), x.slack, tolerance_a, tolerance_b);
    // Rounding of the products of normals, of up to the square of a size, with differences as long as the way.
    const V rounding = hn::Set(k_lanes, 1e-6f * (std::abs(x.way[0]) + std::abs(x.way[1]) + std::abs(x.way[2])));
    tolerance_a = mul_add(rounding, hn::Mul(of_a(a.size), of_a(a.size)), tolerance_a);
    tolerance_b = mul_add(rounding, hn::Mul(of_b(b.size), of_b(b.size)), tolerance_b);
    const auto along = [&](const V(&normal)[3]) {
      return mul_add(normal[2], way[2], mul_add(normal[1], way[1], hn::Mul(normal[0], way[0])));
    };
    {  // B's corners above A's triangle rise by the speed along the way.
      const Span span(normal_a, corner_a[0], corner_b);
      shares.narrow(hn::Sub(hn::Neg(tolerance_a), span.high), hn::Sub(tolerance_a, span.low), along(normal_a));
    }
    {  // A's corners above B's triangle sink.
      const Span span(normal_b, corner_b[0], corner_a);
      shares.narrow(hn::Sub(span.low, tolerance_b), hn::Add(span.high, tolerance_b), along(normal_b));
    }
    HWY_ALIGN std::uint8_t stored[8] = {};
    hn::StoreMaskBits(k_lanes, meets(), stored);
    bits |= static_cast<std::uint32_t>(stored[0]) << i;
  }
  return bits;
}

void find_swept_candidates_here(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& way,
                                SweptCandidates& found) {
  const Placement placement(a, b, X_AB, way);
  const auto meet = [&](Tree::Child leaf_a, const LeafLanes& of_a, Tree::Child leaf_b, const LeafLanes& of_b) {
    float first[k_pairs], last[k_pairs];
    const std::uint32_t bits = sweeping_triangles(of_a, of_b, placement, first, last);
    for_each_pair(bits, leaf_a, leaf_b, [&](std::uint32_t lane, CandidatePair pair) {
      found.pairs.push_back(pair);
      found.first.push_back(first[lane]);
      found.last.push_back(last[lane]);
    });
  };
  Descent<true, decltype(meet)>(a, b, placement, meet).visit(0, 0, ~0u, ~0u);
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof {

namespace candidates {
HWY_EXPORT(find_swept_candidates_here);
}

void find_swept_candidates(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& way,
                           SweptCandidates& found) {
  found.pairs.clear();
  found.first.clear();
  found.last.clear();
  HWY_DYNAMIC_DISPATCH(candidates::find_swept_candidates_here)(a, b, X_AB, way, found);
}

void select_candidates(const SweptCandidates& swept, double x, std::vector<CandidatePair>& pairs) {
  const auto share = static_cast<float>(x);  // off by less than the shares are padded
  pairs.resize(swept.pairs.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < swept.pairs.size(); ++i) {
    pairs[count] = swept.pairs[i];
    count += swept.first[i] <= share && share <= swept.last[i] ? 1 : 0;
  }
  pairs.resize(count);
}

std::size_t SweptCandidates::bytes() const {
  return pairs.capacity() * sizeof(CandidatePair) + (first.capacity() + last.capacity()) * sizeof(float);
}

}  // namespace sixdof
#endif  // HWY_ONCE
