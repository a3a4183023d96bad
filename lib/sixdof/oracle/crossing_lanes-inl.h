// Part of crossing_sums.cpp, which includes it once per instruction set: it has no include guard.

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/predicates.h>
#include <sixdof/oracle/crossing.h>
#include <sixdof/proximity/double_lanes-inl.h>

// Eight pairs of triangles at once, one per lane: which pairs cross, and where. Signs of determinants are those of
// predicates.h where a filter decides them. A pair for which one does not is doubtful.
//
// Written for lanes of floats and of doubles. Floats decide nearly all pairs, twice as many at once; pairs that they
// leave in doubt are left to doubles, and what these leave to cross().
//
// No multiplication is fused, so every instruction set finds the same bits.

HWY_BEFORE_NAMESPACE();
namespace sixdof::crossings {
namespace HWY_NAMESPACE {

using namespace double_lanes::HWY_NAMESPACE;

/// Eight lanes of floats. Where a vector holds fewer, loops take several.
using FloatLanes = hn::CappedTag<float, k_batch>;
using FloatV = hn::Vec<FloatLanes>;
constexpr FloatLanes k_float_lanes;

template <class Vec>
HWY_INLINE Vec number(int x) {
  return hn::Set(hn::DFromV<Vec>(), static_cast<hn::TFromV<Vec>>(x));
}

/// A cross product, and the sums of the magnitudes of its products.
template <class Vec>
struct Minors {
  Vector3<Vec> value, magnitude;

  HWY_INLINE Minors(const Vector3<Vec>& u, const Vector3<Vec>& v)
      : Minors(hn::Mul(u.y, v.z), hn::Mul(u.z, v.y), hn::Mul(u.z, v.x), hn::Mul(u.x, v.z), hn::Mul(u.x, v.y),
               hn::Mul(u.y, v.x)) {}

 private:
  HWY_INLINE Minors(Vec yz, Vec zy, Vec zx, Vec xz, Vec xy, Vec yx)
      : value{hn::Sub(yz, zy), hn::Sub(zx, xz), hn::Sub(xy, yx)},
        magnitude(abs(Vector3<Vec>{yz, zx, xy}) + abs(Vector3<Vec>{zy, xz, yx})) {}
};

/// The largest error of a determinant of three differences of points given in doubles: detail::Filtered in lanes.
struct DoubleFilter {
  using Vec = V;

  HWY_INLINE V bound(const V3& u, const Minors<V>& minors) const {
    return hn::Add(hn::Mul(set(detail::k_orient3d_bound), dot(abs(u), minors.magnitude)),
                   set(detail::k_underflow_bound));
  }
};

/// The same for points that are rounded to floats, relative to a point near them. With m the greatest magnitude of a
/// coordinate and e = 2^-24, a difference is at most 2 m and off by 4 e m. So a product of three is off by 48 e m^3,
/// and the six by 288 e m^3; a minor, at most 8 m^2, is rounded by 16 e m^2, which adds 3 * 32 e m^3; the three
/// products, at most 16 m^3, are rounded by 48 e m^3, and their sums by 80 e m^3. That is 512 e m^3, taken twice.
class FloatFilter {
 public:
  using Vec = FloatV;

  /// @param greatest magnitude of a coordinate: m
  HWY_INLINE explicit FloatFilter(FloatV greatest) {
    // Beyond these, products leave the range of floats, or what underflows is not small. NaN is in no range.
    constexpr float k_least = 0x1p-33f, k_most = 0x1p+40f;
    constexpr float k_relative_bound = 0x1p-14f;
    const auto set = [](float x) { return hn::Set(k_float_lanes, x); };
    const auto is_in_range = hn::And(hn::Ge(greatest, set(k_least)), hn::Le(greatest, set(k_most)));
    const FloatV cube = hn::Mul(greatest, hn::Mul(greatest, greatest));
    bound_ = hn::IfThenElse(is_in_range, hn::Mul(set(k_relative_bound), cube), hn::Inf(k_float_lanes));
  }

  HWY_INLINE FloatV bound(const Vector3<FloatV>&, const Minors<FloatV>&) const { return bound_; }

 private:
  FloatV bound_;
};

/// A determinant of three differences of points, and its largest error.
template <class Filter>
struct Filtered {
  using Vec = typename Filter::Vec;
  Vec value, bound;

  /// Of u and the two vectors of the minors.
  HWY_INLINE Filtered(const Vector3<Vec>& u, const Minors<Vec>& minors, const Filter& filter)
      : value(dot(u, minors.value)), bound(filter.bound(u, minors)) {}

  HWY_INLINE auto positive() const { return hn::Gt(value, bound); }
  HWY_INLINE auto negative() const { return hn::Lt(value, hn::Neg(bound)); }
  HWY_INLINE auto is_clear() const { return hn::Gt(hn::Abs(value), bound); }
  /// Its relative error is below k_orient3d_relative_error; of doubles.
  HWY_INLINE auto is_accurate() const { return hn::Gt(hn::Mul(hn::Abs(value), set(k_orient3d_relative_error)), bound); }
};

/// Distances of a triangle's corners from the plane of the other triangle, times twice that triangle's area.
template <class Filter>
struct PlaneSides {
  using Vec = typename Filter::Vec;
  Filtered<Filter> distance[3];

  HWY_INLINE PlaneSides(const CornersOf<Vec>& triangle, const CornersOf<Vec>& plane, const Filter& filter)
      : PlaneSides(triangle, plane.corner[0],
                   Minors<Vec>(plane.corner[1] - plane.corner[0], plane.corner[2] - plane.corner[0]), filter) {}

  /// Lanes with a corner in front of the plane; meaningful where are_clear().
  HWY_INLINE auto front(std::size_t corner) const { return hn::Gt(distance[corner].value, number<Vec>(0)); }
  /// Lanes in which every sign is certain,
  HWY_INLINE auto are_clear() const {
    return hn::And(hn::And(distance[0].is_clear(), distance[1].is_clear()), distance[2].is_clear());
  }
  /// and in which every value is accurate.
  HWY_INLINE auto are_accurate() const {
    return hn::And(hn::And(distance[0].is_accurate(), distance[1].is_accurate()), distance[2].is_accurate());
  }
  /// Lanes in which all corners are certainly on one side.
  HWY_INLINE auto on_one_side() const {
    return hn::AndNot(hn::Or(hn::Xor(front(0), front(1)), hn::Xor(front(1), front(2))), are_clear());
  }

 private:
  HWY_INLINE PlaneSides(const CornersOf<Vec>& triangle, const Vector3<Vec>& origin, const Minors<Vec>& normal,
                        const Filter& filter)
      : distance{{triangle.corner[0] - origin, normal, filter},
                 {triangle.corner[1] - origin, normal, filter},
                 {triangle.corner[2] - origin, normal, filter}} {}
};

/// One of the two sides of a triangle that cross a plane. It runs from the corner that is alone on its side of the
/// plane, or to it.
template <class Vec>
struct CrossingSide {
  Vector3<Vec> end;        ///< Its other corner,
  Vec at_end;              ///< with its distance from the plane.
  Vector3<Vec> direction;  ///< Along the triangle's border.
  Vec number;              ///< 0, 1 or 2: of side 0 from corner 0 to 1, and so on.
};

/// A triangle whose corners lie on both sides of a plane.
template <class Vec>
struct CrossingSides {
  Vector3<Vec> lone;  ///< The corner that is alone on its side,
  Vec at_lone;
  CrossingSide<Vec> up, down;  ///< From the plane's back to its front, and from front to back.

  template <class Filter>
  HWY_INLINE CrossingSides(const CornersOf<Vec>& t, const PlaneSides<Filter>& sides) {
    const auto differ_01 = hn::Xor(sides.front(0), sides.front(1)), differ_12 = hn::Xor(sides.front(1), sides.front(2));
    const auto is_1 = hn::And(differ_01, differ_12), is_2 = hn::Not(differ_01);
    const Vec indices[3] = {number<Vec>(0), number<Vec>(1), number<Vec>(2)};
    const Vec distance[3] = {sides.distance[0].value, sides.distance[1].value, sides.distance[2].value};
    const auto pick = [&](const auto& of, std::size_t offset) {
      return select(is_2, of[(2 + offset) % 3], select(is_1, of[(1 + offset) % 3], of[offset % 3]));
    };
    lone = pick(t.corner, 0);
    at_lone = pick(distance, 0);
    const Vector3<Vec> next = pick(t.corner, 1), previous = pick(t.corner, 2);
    const Vec at_next = pick(distance, 1), at_previous = pick(distance, 2);
    const Vector3<Vec> to_next = next - lone, from_previous = lone - previous;
    const Vec index = pick(indices, 0), index_before = pick(indices, 2);
    const auto front = hn::Gt(at_lone, number<Vec>(0));
    const auto side = [&](auto leaves) {  // to the next corner, or from the previous one
      return CrossingSide<Vec>{select(leaves, next, previous), select(leaves, at_next, at_previous),
                               select(leaves, to_next, from_previous), select(leaves, index, index_before)};
    };
    down = side(front);
    up = side(hn::Not(front));
  }
};

/// Where a side pierces the plane: from its nearer end; if both are as near, from the one in front.
HWY_INLINE V3 pierced_point(const V3& p, V at_p, const V3& q, V at_q) {
  const V size_p = hn::Abs(at_p), size_q = hn::Abs(at_q);
  const M from_p = hn::Or(hn::Lt(size_p, size_q), hn::And(hn::Eq(size_p, size_q), hn::Gt(at_p, at_q)));
  const V3 near = select(from_p, p, q), far = select(from_p, q, p);
  const V at_near = select(from_p, at_p, at_q), at_far = select(from_p, at_q, at_p);
  return near + hn::Div(at_near, hn::Sub(at_near, at_far)) * (far - near);
}

/// What cross() says of pairs of triangles. Both triangles meet the line of intersection of their planes, in intervals.
/// The side on which one line passes another orders their ends, as in cross().
template <class Filter>
class Crossing {
  using Vec = typename Filter::Vec;

 public:
  HWY_INLINE Crossing(const CornersOf<Vec>& a, const CornersOf<Vec>& b, const Filter& filter)
      : sides_of_a_(a, b, filter),
        sides_of_b_(b, a, filter),
        of_a_(a, sides_of_a_),
        of_b_(b, sides_of_b_),
        up_of_b_(of_b_.lone - of_a_.lone, of_b_.up.direction),
        down_of_b_(of_b_.lone - of_a_.lone, of_b_.down.direction),
        up_up_(of_a_.up.direction, up_of_b_, filter),
        down_down_(of_a_.down.direction, down_of_b_, filter),
        up_down_(of_a_.up.direction, down_of_b_, filter),
        down_up_(of_a_.down.direction, up_of_b_, filter) {}

  /// Lanes whose triangles certainly do not intersect,
  HWY_INLINE auto is_none() const {
    const auto misses = hn::And(are_clear(), hn::Or(up_up_.negative(), down_down_.positive()));
    return hn::Or(misses, hn::Or(sides_of_a_.on_one_side(), sides_of_b_.on_one_side()));
  }
  /// and whose triangles certainly do.
  HWY_INLINE auto is_certain() const {
    const auto alive = hn::AndNot(hn::Or(sides_of_a_.on_one_side(), sides_of_b_.on_one_side()), are_clear());
    return hn::And(alive, hn::And(up_up_.positive(), down_down_.negative()));
  }

  // Lanes of doubles only.

  /// Lanes in which the following are those of cross(), if the triangles intersect.
  HWY_INLINE M is_accurate() const {
    return hn::And(hn::And(sides_of_a_.are_accurate(), sides_of_b_.are_accurate()),
                   hn::And(up_down_.is_clear(), down_up_.is_clear()));
  }
  HWY_INLINE V3 start() const { return point(up_down_.positive(), of_a_.up, of_b_.down); }
  HWY_INLINE V3 end() const { return point(down_up_.negative(), of_a_.down, of_b_.up); }
  /// 0, 1, 2 for A's side that pierces B's triangle; 3, 4, 5 the other way round.
  HWY_INLINE V start_side() const { return side(up_down_.positive(), of_a_.up, of_b_.down); }
  HWY_INLINE V end_side() const { return side(down_up_.negative(), of_a_.down, of_b_.up); }

 private:
  HWY_INLINE auto are_clear() const { return hn::And(sides_of_a_.are_clear(), sides_of_b_.are_clear()); }

  static HWY_INLINE V side(M on_a, const CrossingSide<V>& of_a, const CrossingSide<V>& of_b) {
    return select(on_a, of_a.number, hn::Add(of_b.number, set(3.0)));
  }
  HWY_INLINE V3 point(M on_a, const CrossingSide<V>& on_side_of_a, const CrossingSide<V>& on_side_of_b) const {
    return pierced_point(select(on_a, of_a_.lone, of_b_.lone), select(on_a, of_a_.at_lone, of_b_.at_lone),
                         select(on_a, on_side_of_a.end, on_side_of_b.end),
                         select(on_a, on_side_of_a.at_end, on_side_of_b.at_end));
  }

  PlaneSides<Filter> sides_of_a_, sides_of_b_;
  CrossingSides<Vec> of_a_, of_b_;
  Minors<Vec> up_of_b_, down_of_b_;
  Filtered<Filter> up_up_, down_down_, up_down_, down_up_;
};

/// Sum of the magnitudes of the components.
HWY_INLINE V size_of(const V3& a) {
  const V3 m = abs(a);
  return hn::Add(hn::Add(m.x, m.y), m.z);
}

/// Whether a plane through an edge of t and across it certainly separates t from the other triangle.
HWY_INLINE M edge_separates(const Corners& t, const Corners& other) {
  const V3 normal = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
  M apart = no_lane();
  for (std::size_t i = 0; i < 3; ++i) {
    const V3& from = t.corner[i];
    const V3 edge = t.corner[(i + 1) % 3] - from, third = t.corner[(i + 2) % 3] - from;
    const V3 outwards = cross(edge, normal);
    const V highest = hn::Max(hn::Zero(k_lanes), hn::Max(dot(outwards, edge), dot(outwards, third)));
    V size = hn::Add(size_of(edge), size_of(third)), lowest = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      const V3 p = other.corner[k] - from;
      const V along = dot(outwards, p);
      lowest = k == 0 ? along : hn::Min(lowest, along);
      size = hn::Max(size, size_of(p));
    }
    const V rounding = hn::Mul(hn::Mul(set(detail::k_projection_rounding), size), size_of(outwards));
    apart = hn::Or(apart, hn::Gt(hn::Sub(lowest, highest), hn::Add(rounding, set(detail::k_underflow_bound))));
  }
  return apart;
}

/// sixdof::certainly_apart() in lanes.
HWY_INLINE M certainly_apart(const Corners& a, const Corners& b) {
  return hn::Or(edge_separates(a, b), edge_separates(b, a));
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::crossings
HWY_AFTER_NAMESPACE();
