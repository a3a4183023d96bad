// Part of crossing_sums.cpp, which includes it once per instruction set: it has no include guard.

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/predicates.h>
#include <sixdof/oracle/crossing.h>
#include <sixdof/oracle/double_lanes-inl.h>

// Eight pairs of triangles at once, one per lane, in doubles: which pairs cross, and where. Signs of determinants are
// those of predicates.h where its filters decide them. A pair for which one does not is doubtful: cross() decides it.
//
// No multiplication is fused, so every instruction set finds the same bits.

HWY_BEFORE_NAMESPACE();
namespace sixdof::crossings {
namespace HWY_NAMESPACE {

using namespace double_lanes::HWY_NAMESPACE;

HWY_INLINE V dot(const V3& a, const V3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

/// A cross product, and the sums of the magnitudes of its products.
struct Minors {
  V3 value, magnitude;

  HWY_INLINE Minors(const V3& u, const V3& v)
      : Minors(hn::Mul(u.y, v.z), hn::Mul(u.z, v.y), hn::Mul(u.z, v.x), hn::Mul(u.x, v.z), hn::Mul(u.x, v.y),
               hn::Mul(u.y, v.x)) {}

 private:
  HWY_INLINE Minors(V yz, V zy, V zx, V xz, V xy, V yx)
      : value{hn::Sub(yz, zy), hn::Sub(zx, xz), hn::Sub(xy, yx)},
        magnitude(abs(V3{yz, zx, xy}) + abs(V3{zy, xz, yx})) {}
};

HWY_INLINE V3 cross(const V3& u, const V3& v) { return Minors(u, v).value; }

/// A determinant of three differences of points, and the largest error of its sign: detail::Filtered in lanes.
struct Filtered {
  V value, bound;

  /// Of u and the two vectors of the minors.
  HWY_INLINE Filtered(const V3& u, const Minors& minors)
      : value(dot(u, minors.value)),
        bound(hn::Add(hn::Mul(set(detail::k_orient3d_bound), dot(abs(u), minors.magnitude)),
                      set(detail::k_underflow_bound))) {}

  HWY_INLINE M positive() const { return hn::Gt(value, bound); }
  HWY_INLINE M negative() const { return hn::Lt(value, hn::Neg(bound)); }
};

/// Distances of a triangle's corners from the plane of the other triangle, times twice that triangle's area.
struct PlaneSides {
  V value[3];
  M front[3];     ///< Corners in front of the plane; meaningful where `is_clear`.
  M is_clear;     ///< Every sign is certain.
  M is_accurate;  ///< Every value has a relative error below k_orient3d_relative_error.

  HWY_INLINE PlaneSides(const Corners& triangle, const Corners& plane) {
    const V3& origin = plane.corner[0];
    const Minors normal(plane.corner[1] - origin, plane.corner[2] - origin);
    for (std::size_t k = 0; k < 3; ++k) {
      const Filtered f(triangle.corner[k] - origin, normal);
      const V magnitude = hn::Abs(f.value);
      const M clear = hn::Gt(magnitude, f.bound);
      const M accurate = hn::Gt(hn::Mul(magnitude, set(k_orient3d_relative_error)), f.bound);
      value[k] = f.value;
      front[k] = hn::Gt(f.value, hn::Zero(k_lanes));
      is_clear = k == 0 ? clear : hn::And(is_clear, clear);
      is_accurate = k == 0 ? accurate : hn::And(is_accurate, accurate);
    }
  }

  /// Lanes in which all corners are certainly on one side.
  HWY_INLINE M on_one_side() const {
    const M differ = hn::Or(hn::Xor(front[0], front[1]), hn::Xor(front[1], front[2]));
    return hn::AndNot(differ, is_clear);
  }
};

/// One of the two sides of a triangle that cross a plane. It runs from the corner that is alone on its side of the
/// plane, or to it.
struct CrossingSide {
  V3 end;        ///< Its other corner,
  V at_end;      ///< with its distance from the plane.
  V3 direction;  ///< Along the triangle's border.
  V number;      ///< 0, 1 or 2: of side 0 from corner 0 to 1, and so on.
};

/// A triangle whose corners lie on both sides of a plane.
struct CrossingSides {
  V3 lone;  ///< The corner that is alone on its side,
  V at_lone;
  CrossingSide up, down;  ///< From the plane's back to its front, and from front to back.

  HWY_INLINE CrossingSides(const Corners& t, const PlaneSides& sides) {
    const M differ_01 = hn::Xor(sides.front[0], sides.front[1]), differ_12 = hn::Xor(sides.front[1], sides.front[2]);
    const M is_1 = hn::And(differ_01, differ_12), is_2 = hn::Not(differ_01);
    const V indices[3] = {hn::Zero(k_lanes), set(1.0), set(2.0)};
    const auto pick = [&](const auto& of, std::size_t offset) {
      return select(is_2, of[(2 + offset) % 3], select(is_1, of[(1 + offset) % 3], of[offset % 3]));
    };
    lone = pick(t.corner, 0);
    at_lone = pick(sides.value, 0);
    const V3 next = pick(t.corner, 1), previous = pick(t.corner, 2);
    const V at_next = pick(sides.value, 1), at_previous = pick(sides.value, 2);
    const V3 to_next = next - lone, from_previous = lone - previous;
    const V index = pick(indices, 0), index_before = pick(indices, 2);
    const M front = hn::Gt(at_lone, hn::Zero(k_lanes));
    const auto side = [&](M leaves) {  // to the next corner, or from the previous one
      return CrossingSide{select(leaves, next, previous), select(leaves, at_next, at_previous),
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

/// What cross() says of pairs of triangles: Segment in lanes.
struct Crossing {
  M crosses;
  M is_doubtful;  ///< cross() has to say it; never where `crosses`.
  V3 start, end;
  V start_side, end_side;  ///< 0, 1, 2 for A's side that pierces B's triangle; 3, 4, 5 the other way round.

  HWY_INLINE Crossing(const Corners& a, const Corners& b) {
    const PlaneSides sides_of_a(a, b), sides_of_b(b, a);
    const M alive = hn::Not(hn::Or(sides_of_a.on_one_side(), sides_of_b.on_one_side()));
    const CrossingSides of_a(a, sides_of_a), of_b(b, sides_of_b);
    // Both triangles meet the line of intersection of their planes, in intervals. The side on which one line passes
    // another orders their ends, as in cross().
    const V3 between = of_b.lone - of_a.lone;
    const Minors up_of_b(between, of_b.up.direction), down_of_b(between, of_b.down.direction);
    const Filtered up_up(of_a.up.direction, up_of_b), down_down(of_a.down.direction, down_of_b);
    const Filtered up_down(of_a.up.direction, down_of_b), down_up(of_a.down.direction, up_of_b);
    const M misses = hn::Or(up_up.negative(), down_down.positive());
    const M before = hn::And(up_up.positive(), down_down.negative());
    const M start_is_clear = hn::Or(up_down.positive(), up_down.negative());
    const M end_is_clear = hn::Or(down_up.positive(), down_up.negative());
    const M certain = hn::And(hn::And(sides_of_a.is_accurate, sides_of_b.is_accurate),
                              hn::And(before, hn::And(start_is_clear, end_is_clear)));
    const M signs_are_clear = hn::And(sides_of_a.is_clear, sides_of_b.is_clear);
    const M meets = hn::AndNot(hn::And(misses, signs_are_clear), alive);
    crosses = hn::And(meets, certain);
    is_doubtful = hn::AndNot(certain, meets);

    const M start_on_a = up_down.positive(), end_on_a = down_up.negative();
    start_side = side(start_on_a, of_a.up, of_b.down);
    end_side = side(end_on_a, of_a.down, of_b.up);
    start = point(start_on_a, of_a, of_a.up, of_b, of_b.down);
    end = point(end_on_a, of_a, of_a.down, of_b, of_b.up);
  }

 private:
  static HWY_INLINE V side(M on_a, const CrossingSide& of_a, const CrossingSide& of_b) {
    return select(on_a, of_a.number, hn::Add(of_b.number, set(3.0)));
  }
  static HWY_INLINE V3 point(M on_a, const CrossingSides& a, const CrossingSide& of_a, const CrossingSides& b,
                             const CrossingSide& of_b) {
    return pierced_point(select(on_a, a.lone, b.lone), select(on_a, a.at_lone, b.at_lone),
                         select(on_a, of_a.end, of_b.end), select(on_a, of_a.at_end, of_b.at_end));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::crossings
HWY_AFTER_NAMESPACE();
