#include <sixdof/oracle/triangle_contact.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <sixdof/geometry/predicates.h>

namespace sixdof {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A triangle by its corners, and the axes onto whose plane it projects to a triangle.
struct Corners {
  std::array<Vector3d, 3> p;

  const Vector3d& operator[](std::size_t k) const { return p[k]; }
  int side(const Vector3d& q) const { return orient3d(p[0], p[1], p[2], q); }
};

int orientation_without(Eigen::Index axis, const Corners& t) {
  const auto flat = [axis](const Vector3d& q) { return Vector2d(q[(axis + 1) % 3], q[(axis + 2) % 3]); };
  return orient2d(flat(t[0]), flat(t[1]), flat(t[2]));
}

/// Projects the plane of a triangle to two axes, one to one.
class Projection {
 public:
  explicit Projection(const Corners& t) {
    const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
    normal.cwiseAbs().maxCoeff(&axis_);
    // The rounded normal may choose badly for a thin triangle; one of the three projections is no line.
    for (int tries = 0; tries < 3; ++tries, axis_ = (axis_ + 1) % 3) {
      orientation_ = orientation_without(axis_, t);
      if (orientation_ != 0) return;
    }
  }

  Vector2d operator()(const Vector3d& p) const { return {p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]}; }
  int orientation() const { return orientation_; }  ///< Of the triangle.

 private:
  Eigen::Index axis_ = 0;
  int orientation_ = 0;
};

/// Whether p, in the plane of t, lies in t or on its border.
bool contains(const Corners& t, const Projection& flat, const Vector3d& p) {
  const Vector2d q = flat(p);
  for (std::size_t k = 0; k < 3; ++k) {
    if (orient2d(flat(t[k]), flat(t[(k + 1) % 3]), q) * flat.orientation() < 0) return false;
  }
  return true;
}

/// A common point of the segments pq and ab in one plane, where p and q lie outside of a triangle with the edge ab.
std::optional<Vector3d> meet_edge(const Projection& flat, const Vector3d& p, const Vector3d& q, const Vector3d& a,
                                  const Vector3d& b) {
  const Vector2d p2 = flat(p), q2 = flat(q), a2 = flat(a), b2 = flat(b);
  const int sa = orient2d(p2, q2, a2), sb = orient2d(p2, q2, b2);
  const int sp = orient2d(a2, b2, p2), sq = orient2d(a2, b2, q2);
  if (sa * sb > 0 || sp * sq > 0) return std::nullopt;
  if (sa == 0 && sb == 0) {  // On one line; p and q are not in ab, so ab is in pq, or they are apart.
    const Vector2d low = p2.cwiseMin(q2), high = p2.cwiseMax(q2);
    const bool inside = (a2.array() >= low.array()).all() && (a2.array() <= high.array()).all();
    return inside ? std::optional(a) : std::nullopt;
  }
  const auto area = [&](const Vector2d& x) {
    return (b2.x() - a2.x()) * (x.y() - a2.y()) - (b2.y() - a2.y()) * (x.x() - a2.x());
  };
  const double from_p = std::abs(area(p2)), from_q = std::abs(area(q2));
  const double t = from_p + from_q > 0.0 ? from_p / (from_p + from_q) : 0.0;
  return Vector3d(p + t * (q - p));
}

std::optional<Vector3d> meet_in_plane(const Vector3d& p, const Vector3d& q, const Corners& t) {
  const Projection flat(t);
  if (contains(t, flat, p)) return p;
  if (contains(t, flat, q)) return q;
  for (std::size_t k = 0; k < 3; ++k) {
    if (const auto point = meet_edge(flat, p, q, t[k], t[(k + 1) % 3])) return point;
  }
  return std::nullopt;
}

/// A common point of the segment pq and the triangle, both with their borders.
std::optional<Vector3d> meet(const Vector3d& p, const Vector3d& q, const Corners& t) {
  const int at_p = t.side(p), at_q = t.side(q);
  if (at_p * at_q > 0) return std::nullopt;
  if (at_p == 0 && at_q == 0) return meet_in_plane(p, q, t);
  if (at_p == 0) return contains(t, Projection(t), p) ? std::optional(p) : std::nullopt;
  if (at_q == 0) return contains(t, Projection(t), q) ? std::optional(q) : std::nullopt;
  bool left = false, right = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const int side = orient3d(p, q, t[k], t[(k + 1) % 3]);
    left = left || side > 0;
    right = right || side < 0;
  }
  if (left && right) return std::nullopt;
  const double from_p = std::abs(orient3d_value(t[0], t[1], t[2], p));
  const double from_q = std::abs(orient3d_value(t[0], t[1], t[2], q));
  return Vector3d(p + from_p / (from_p + from_q) * (q - p));
}

ContactKind kind_of(const Corners& a, const Corners& b) {
  const bool coplanar = std::all_of(b.p.begin(), b.p.end(), [&](const Vector3d& p) { return a.side(p) == 0; });
  return coplanar ? ContactKind::coplanar : ContactKind::crossing;
}

/// Whether all corners of `b` lie strictly on one side of the plane of `a`.
bool on_one_side(const Corners& a, const Corners& b) {
  const int side = a.side(b[0]);
  return side != 0 && a.side(b[1]) == side && a.side(b[2]) == side;
}

/// Above the rounding of a product of two differences, relative to its factors.
constexpr double k_rounding = 1e-14;

/// Whether a plane across the line of the triangles' middles separates them: true only if it surely does. Spares the
/// exact predicates in flat regions, where neighbours lie in one plane.
bool separated_by_middles(const Corners& a, const Corners& b) {
  const Vector3d& origin = a[0];
  const Vector3d axis = (a[0] - b[0]) + (a[1] - b[1]) + (a[2] - b[2]);
  double lowest_a = 0.0, highest_b = (b[0] - origin).dot(axis), size = (b[0] - origin).lpNorm<1>();
  for (std::size_t k = 1; k < 3; ++k) {
    const Vector3d to_a = a[k] - origin, to_b = b[k] - origin;
    lowest_a = std::min(lowest_a, to_a.dot(axis));
    highest_b = std::max(highest_b, to_b.dot(axis));
    size = std::max({size, to_a.lpNorm<1>(), to_b.lpNorm<1>()});
  }
  return lowest_a - highest_b > k_rounding * size * axis.lpNorm<1>();
}

std::optional<TriangleContact> contact_of_apart(const Corners& a, const Corners& b) {
  if (separated_by_middles(a, b)) return std::nullopt;
  if (on_one_side(a, b) || on_one_side(b, a)) return std::nullopt;
  for (const auto& [edges, face] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (const auto point = meet((*edges)[k], (*edges)[(k + 1) % 3], *face)) {
        return TriangleContact{kind_of(a, b), *point};
      }
    }
  }
  return std::nullopt;
}

/// Whether a plane through the common corner 0 separates the rest of the triangles: true only if it surely does.
bool separated_at_corner(const Corners& a, const Corners& b) {
  std::array<Vector3d, 4> ray{a[1] - a[0], a[2] - a[0], b[1] - a[0], b[2] - a[0]};
  for (Vector3d& r : ray) r.normalize();
  const Vector3d axis = ray[0] + ray[1] - ray[2] - ray[3];
  return ray[0].dot(axis) > k_rounding && ray[1].dot(axis) > k_rounding && ray[2].dot(axis) < -k_rounding &&
         ray[3].dot(axis) < -k_rounding;
}

/// Of triangles that share their corners 0.
std::optional<TriangleContact> contact_at_vertex(const Corners& a, const Corners& b) {
  if (separated_at_corner(a, b)) return std::nullopt;
  if (a.side(b[1]) * a.side(b[2]) > 0 || b.side(a[1]) * b.side(a[2]) > 0) return std::nullopt;
  auto point = meet(a[1], a[2], b);
  if (!point) point = meet(b[1], b[2], a);
  if (!point) return std::nullopt;
  return TriangleContact{kind_of(a, b), *point};
}

/// Of triangles that share their corners 0 and 1, in either direction.
std::optional<TriangleContact> contact_at_edge(const Corners& a, const Corners& b) {
  const Vector3d along = a[1] - a[0], to_a = a[2] - a[0], to_b = b[2] - a[0];
  // Negative if the dihedral angle is above 90 degrees, as nearly everywhere: spares the exact predicate.
  const double scale = along.squaredNorm() * to_a.norm() * to_b.norm();
  if (along.cross(to_a).dot(along.cross(to_b)) < -k_rounding * scale) return std::nullopt;
  if (a.side(b[2]) != 0) return std::nullopt;
  const Projection flat(a);
  if (orient2d(flat(a[0]), flat(a[1]), flat(b[2])) != flat.orientation()) return std::nullopt;
  return TriangleContact{ContactKind::coplanar, 0.5 * (a[0] + a[1])};
}

/// The triangle's vertices with those that `other` has first, in ascending order. @return how many those are
int shared_first(Triangle& t, const Triangle& other) {
  const auto shared = [&](std::uint32_t v) { return std::find(other.begin(), other.end(), v) != other.end(); };
  const auto middle = std::partition(t.begin(), t.end(), shared);
  std::sort(t.begin(), middle);
  return static_cast<int>(middle - t.begin());
}

}  // namespace

bool is_collinear(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Corners t{{a, b, c}};
  for (int axis = 0; axis < 3; ++axis) {
    if (orientation_without(axis, t) != 0) return false;
  }
  return true;
}

std::optional<TriangleContact> find_contact(std::span<const Vector3d> vertices, const Triangle& a, const Triangle& b) {
  Triangle first = a, second = b;
  const int shared = shared_first(first, b);
  shared_first(second, a);
  const auto corners = [&](const Triangle& t) { return Corners{{vertices[t[0]], vertices[t[1]], vertices[t[2]]}}; };
  const Corners of_a = corners(first), of_b = corners(second);
  switch (shared) {
    case 0:
      return contact_of_apart(of_a, of_b);
    case 1:
      return contact_at_vertex(of_a, of_b);
    case 2:
      return contact_at_edge(of_a, of_b);
    default:
      return TriangleContact{ContactKind::coincident, (of_a[0] + of_a[1] + of_a[2]) / 3.0};
  }
}

}  // namespace sixdof
