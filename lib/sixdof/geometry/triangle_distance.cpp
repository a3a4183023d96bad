#include <sixdof/geometry/triangle_distance.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <sixdof/geometry/predicates.h>

// Every function works on differences to one corner, so that the distance from the origin has no effect.
//
// The closest points of two triangles lie in the interiors of a pair of faces: vertex-vertex, vertex-edge, edge-edge or
// vertex-face. Vertex-edge with clamping includes vertex-vertex and is well conditioned. The other two need the point
// where w = w0 + s u - t v is normal to u and v. With n = u x v that is
//   s = -(w0 x v) . n / n^2,  t = -(w0 x u) . n / n^2,
// which loses digits as u and v become parallel. Iterative refinement applies the same formula to the w that was
// reached: each step multiplies the error by about (unit roundoff / angle). What small angles leave of it lies along
// the edges; a projection along the longer one removes it, so that w has the accuracy of its own rounding at any angle.
// At an angle of a few roundings the interior is closer than the border by at most a rounding of the length.
//
// Zero is decided by exact predicates, and only where the computed distance is in doubt.

namespace sixdof {
namespace {

using Eigen::Vector3d;
using namespace detail;

/// A step gains four digits at an angle of 1e-12. It gains little at the smallest angles, where the interior gains
/// little over the border.
constexpr int k_refinements = 3;
/// Error of triangle_gap() per size: three products, their sum, and the error of the distance that it bounds.
constexpr double k_gap_error = 5e-15;

/// The closest points so far. `difference` is on_a - on_b, computed without the rounded points.
struct Best {
  double squared = std::numeric_limits<double>::infinity();
  Vector3d difference = Vector3d::Zero();
  Vector3d on_a = Vector3d::Zero();
  Vector3d on_b = Vector3d::Zero();

  void try_update(const Vector3d& w, const Vector3d& a, const Vector3d& b) {
    const double d = w.squaredNorm();
    if (d < squared) {
      squared = d;
      difference = w;
      on_a = a;
      on_b = b;
    }
  }

  /// The same for a point p and a point q of the other triangle, w = p - q. sign = 1: p is of a; -1: of b.
  template <int sign>
  void try_update(const Vector3d& w, const Vector3d& p, const Vector3d& q) {
    if constexpr (sign > 0) {
      try_update(w, p, q);
    } else {
      try_update(-w, q, p);
    }
  }
};

struct Edge {
  Vector3d from;
  Vector3d to;
  Vector3d along;
  double squared;
  Edge(const Vector3d& p, const Vector3d& q) : from(p), to(q), along(q - p), squared(along.squaredNorm()) {}
};

template <int sign>
void try_point_edge(const Vector3d& p, const Edge& edge, Best& best) {
  const Vector3d from = p - edge.from;
  const double along = from.dot(edge.along);
  Vector3d w = from;
  Vector3d q = edge.from;
  if (along >= edge.squared) {
    w = p - edge.to;
    q = edge.to;
  } else if (along > 0.0) {
    const double t = along / edge.squared;
    w = from - t * edge.along;
    q = edge.from + t * edge.along;
  }
  best.try_update<sign>(w, p, q);
}

struct Solution {
  double s = 0.0;
  double t = 0.0;
  Vector3d w;
  bool found = false;
};

/// The s and t for which w = w0 + s u - t v is normal to u and v.
Solution solve_normal(const Vector3d& w0, const Vector3d& u, double uu, const Vector3d& v, double vv) {
  Solution x;
  const Vector3d n = u.cross(v);
  const double nn = n.squaredNorm();
  if (!(nn > k_parallel_sine * k_parallel_sine * uu * vv)) return x;
  x.w = w0;
  const int refinements = nn > k_wide_sine * k_wide_sine * uu * vv ? 1 : k_refinements;
  for (int i = 0; i <= refinements; ++i) {
    x.s -= x.w.cross(v).dot(n) / nn;
    x.t -= x.w.cross(u).dot(n) / nn;
    // At such an angle, a solution this far outside is not in the interior.
    if (i == 0 && refinements == 1 &&
        !(x.s > -k_margin && x.s < 1.0 + k_margin && x.t > -k_margin && x.t < 1.0 + k_margin)) {
      return x;
    }
    x.w = (w0 + x.s * u) - x.t * v;
  }
  if (refinements > 1) {
    if (uu >= vv) {
      x.s -= x.w.dot(u) / uu;
    } else {
      x.t += x.w.dot(v) / vv;
    }
    x.w = (w0 + x.s * u) - x.t * v;
  }
  x.found = true;
  return x;
}

void try_edge_edge(const Edge& a, const Edge& b, Best& best) {
  const Solution x = solve_normal(a.from - b.from, a.along, a.squared, b.along, b.squared);
  if (!x.found || !(x.s > 0.0 && x.s < 1.0 && x.t > 0.0 && x.t < 1.0)) return;
  best.try_update(x.w, a.from + x.s * a.along, b.from + x.t * b.along);
}

/// A point and the interior of a triangle, which is given by two edges from one corner.
template <int sign>
void try_point_face(const Vector3d& p, const Edge& first, const Edge& second, Best& best) {
  const Vector3d from = p - first.from;
  // The point first.from + s first + t second of the triangle, whose difference to p is w = from + s u - t second.
  const Vector3d u = -first.along;
  const Solution x = solve_normal(from, u, first.squared, second.along, second.squared);
  if (!x.found || !(x.s > 0.0 && x.t > 0.0 && x.s + x.t < 1.0)) return;
  const Vector3d q = first.from + x.s * first.along + x.t * second.along;
  best.try_update<sign>(x.w, p, q);
}

struct Edges {
  std::array<Edge, 3> edge;  // from corner i to corner i + 1
  Edge second;               // from corner 0 to corner 2: with edge[0] it spans the triangle
  explicit Edges(const TriangleCorners& t)
      : edge{Edge(t[0], t[1]), Edge(t[1], t[2]), Edge(t[2], t[0])}, second(t[0], t[2]) {}
};

template <int sign>
void try_point_triangle(const Vector3d& p, const Edges& t, Best& best) {
  for (const Edge& edge : t.edge) try_point_edge<sign>(p, edge, best);
  try_point_face<sign>(p, t.edge[0], t.second, best);
}

ClosestPoints finish(const Best& best, const Vector3d& origin) {
  return {std::sqrt(best.squared), origin + best.on_a, origin + best.on_b};
}

TriangleCorners relative(const TriangleCorners& t, const Vector3d& origin) {
  return {t[0] - origin, t[1] - origin, t[2] - origin};
}

/// The largest sum of the magnitudes of a corner's coordinates.
double size_of(const TriangleCorners& a, const TriangleCorners& b) {
  double size = 0.0;
  for (const TriangleCorners* t : {&a, &b}) {
    for (const Vector3d& p : *t) size = std::max(size, p.cwiseAbs().sum());
  }
  return size;
}

Eigen::Vector2d drop(const Vector3d& p, int axis) { return {p[(axis + 1) % 3], p[(axis + 2) % 3]}; }

int orient(const Vector3d& a, const Vector3d& b, const Vector3d& c, int axis) {
  return orient2d(drop(a, axis), drop(b, axis), drop(c, axis));
}

/// Whether x lies in the axis-aligned box of p and q: for collinear points, on the segment.
bool between(const Vector3d& p, const Vector3d& q, const Vector3d& x) {
  for (int k = 0; k < 3; ++k) {
    if (x[k] < std::min(p[k], q[k]) || x[k] > std::max(p[k], q[k])) return false;
  }
  return true;
}

bool on_segment(const Vector3d& p, const Vector3d& q, const Vector3d& x) {
  return between(p, q, x) && orient(p, q, x, 0) == 0 && orient(p, q, x, 1) == 0 && orient(p, q, x, 2) == 0;
}

/// Whether two closed segments meet. Either may be a point.
bool segments_intersect(const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& s) {
  if (on_segment(p, q, r) || on_segment(p, q, s) || on_segment(r, s, p) || on_segment(r, s, q)) return true;
  if (orient3d(p, q, r, s) != 0) return false;
  // In one plane, with no end on the other segment: their interiors cross, or they are disjoint. If p, q, r are
  // collinear, they are disjoint.
  for (int axis = 0; axis < 3; ++axis) {
    if (orient(p, q, r, axis) == 0) continue;
    return orient(p, q, r, axis) * orient(p, q, s, axis) < 0 && orient(r, s, p, axis) * orient(r, s, q, axis) < 0;
  }
  return false;
}

/// Whether none of three signs is opposite to another.
bool agree(int x, int y, int z) { return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0); }

/// Whether closed segment p q and closed triangle t meet.
/// @param side_p, side_q sides of t's plane on which p and q lie
bool edge_meets_triangle(const Vector3d& p, const Vector3d& q, int side_p, int side_q, const TriangleCorners& t) {
  if (side_p * side_q > 0) return false;
  if (side_p != 0 || side_q != 0) {  // the line meets t's plane in one point
    const int o0 = orient3d(p, q, t[0], t[1]);
    const int o1 = orient3d(p, q, t[1], t[2]);
    if (o0 * o1 < 0) return false;
    return agree(o0, o1, orient3d(p, q, t[2], t[0]));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (segments_intersect(p, q, t[i], t[(i + 1) % 3])) return true;
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (orient(t[0], t[1], t[2], axis) == 0) continue;
    // p q does not cross t's border: it is inside or outside as a whole.
    return agree(orient(t[0], t[1], p, axis), orient(t[1], t[2], p, axis), orient(t[2], t[0], p, axis));
  }
  return false;  // t is a segment or a point
}

/// An edge of one triangle that meets the other triangle.
struct Meeting {
  bool found = false;
  bool edge_of_a = false;
  std::size_t edge = 0;
};

Meeting find_meeting(const TriangleCorners& a, const TriangleCorners& b) {
  std::array<int, 3> side_a{};
  std::array<int, 3> side_b{};
  for (std::size_t i = 0; i < 3; ++i) side_a[i] = orient3d(b[0], b[1], b[2], a[i]);
  if (side_a[0] == side_a[1] && side_a[1] == side_a[2] && side_a[0] != 0) return {};
  for (std::size_t i = 0; i < 3; ++i) side_b[i] = orient3d(a[0], a[1], a[2], b[i]);
  if (side_b[0] == side_b[1] && side_b[1] == side_b[2] && side_b[0] != 0) return {};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (edge_meets_triangle(a[i], a[j], side_a[i], side_a[j], b)) return {true, true, i};
    if (edge_meets_triangle(b[i], b[j], side_b[i], side_b[j], a)) return {true, false, i};
  }
  return {};
}

/// A common point: where the edge crosses the other's plane; `otherwise` if it lies in that plane.
Vector3d common_point(const Meeting& meeting, const TriangleCorners& a, const TriangleCorners& b,
                      const Vector3d& otherwise) {
  const TriangleCorners& from = meeting.edge_of_a ? a : b;
  const TriangleCorners& t = meeting.edge_of_a ? b : a;
  const Vector3d& p = from[meeting.edge];
  const Vector3d& q = from[(meeting.edge + 1) % 3];
  const double above = orient3d_value(t[0], t[1], t[2], p);
  const double below = orient3d_value(t[0], t[1], t[2], q);
  if (above == below) return otherwise;
  return p + above / (above - below) * (q - p);
}

}  // namespace

double triangle_gap(const TriangleCorners& a, const TriangleCorners& b) {
  const TriangleCorners local_a = relative(a, a[0]);
  const TriangleCorners local_b = relative(b, a[0]);
  double gap = -std::numeric_limits<double>::infinity();
  for (const Vector3d& normal :
       {Vector3d(local_a[1].cross(local_a[2])), Vector3d((local_b[1] - local_b[0]).cross(local_b[2] - local_b[0]))}) {
    const double length = normal.norm();
    if (!(length > 0.0)) continue;
    const auto [low_a, high_a] = std::minmax({0.0, normal.dot(local_a[1]), normal.dot(local_a[2])});
    const auto [low_b, high_b] = std::minmax({normal.dot(local_b[0]), normal.dot(local_b[1]), normal.dot(local_b[2])});
    gap = std::max(gap, std::max(low_b - high_a, low_a - high_b) / length);
  }
  return gap - k_gap_error * size_of(local_a, local_b);
}

ClosestPoints triangle_triangle_distance(const TriangleCorners& a, const TriangleCorners& b) {
  const TriangleCorners local_a = relative(a, a[0]);
  const TriangleCorners local_b = relative(b, a[0]);
  const Edges edges_a(local_a);
  const Edges edges_b(local_b);
  Best best;
  for (const Vector3d& p : local_a) try_point_triangle<1>(p, edges_b, best);
  for (const Vector3d& p : local_b) try_point_triangle<-1>(p, edges_a, best);
  for (const Edge& edge_a : edges_a.edge) {
    for (const Edge& edge_b : edges_b.edge) try_edge_edge(edge_a, edge_b, best);
  }

  // The triangles are disjoint if their projections on the line through the closest points are.
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Vector3d& p : local_a) low = std::min(low, best.difference.dot(p));
  for (const Vector3d& p : local_b) high = std::max(high, best.difference.dot(p));
  if (low - high > k_safe_gap * size_of(local_a, local_b) * best.difference.cwiseAbs().maxCoeff())
    return finish(best, a[0]);

  const Meeting meeting = find_meeting(a, b);
  if (!meeting.found) {
    ClosestPoints apart = finish(best, a[0]);
    apart.distance = std::max(apart.distance, k_least_distance);
    return apart;
  }
  // Where an edge lies in the other's plane, the closest points are common points up to rounding.
  const Vector3d point = common_point(meeting, a, b, a[0] + best.on_a);
  return {0.0, point, point};
}

bool triangles_intersect(const TriangleCorners& a, const TriangleCorners& b) { return find_meeting(a, b).found; }

}  // namespace sixdof
