#include <sixdof/stability/reference.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace sixdof::stability {
namespace {

using Real = long double;
using Point = Eigen::Matrix<Real, 3, 1>;
using Corners = std::array<Point, 3>;

Real clamp_unit(Real x) { return std::clamp(x, Real{0}, Real{1}); }

Real point_segment_square(const Point& p, const Point& a, const Point& b) {
  const Point u = b - a;
  const Real length = u.squaredNorm();
  const Real s = length > 0 ? clamp_unit((p - a).dot(u) / length) : Real{0};
  return (a + s * u - p).squaredNorm();
}

/// Ends against segments, and the points where the common normal of the lines meets them. Where lines are nearly
/// parallel these points are inaccurate along the lines, but they lie on the segments, so the error of the distance is
/// theirs times the angle.
Real segment_segment_square(const Point& a, const Point& b, const Point& c, const Point& d) {
  Real least = std::min({point_segment_square(a, c, d), point_segment_square(b, c, d), point_segment_square(c, a, b),
                         point_segment_square(d, a, b)});
  const Point u = b - a, v = d - c, n = u.cross(v), w = c - a;
  const Real square = n.squaredNorm();
  if (square > 0) {
    const Point on_first = a + clamp_unit(w.cross(v).dot(n) / square) * u;
    const Point on_second = c + clamp_unit(w.cross(u).dot(n) / square) * v;
    least = std::min({least, point_segment_square(on_first, c, d), point_segment_square(on_second, a, b)});
  }
  return least;
}

/// Whether the foot of p on the triangle's plane lies inside.
bool over_face(const Point& p, const Corners& t, const Point& n) {
  for (std::size_t k = 0; k < 3; ++k) {
    if ((t[(k + 1) % 3] - t[k]).cross(p - t[k]).dot(n) < 0) return false;
  }
  return true;
}

Real point_face_square(const Point& p, const Corners& t) {
  const Point n = (t[1] - t[0]).cross(t[2] - t[0]);
  const Real square = n.squaredNorm();
  if (!(square > 0) || !over_face(p, t, n)) return std::numeric_limits<Real>::infinity();
  const Real height = (p - t[0]).dot(n);
  return height * height / square;
}

bool pierces(const Point& p, const Point& q, const Corners& t) {
  const Point n = (t[1] - t[0]).cross(t[2] - t[0]);
  const Real above = (p - t[0]).dot(n), below = (q - t[0]).dot(n);
  if ((above > 0) == (below > 0) || above == below) return false;
  return over_face(p + above / (above - below) * (q - p), t, n);
}

Real square_distance(const Corners& s, const Corners& t) {
  Real least = std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &p = s[i], &q = s[(i + 1) % 3];
    if (pierces(p, q, t) || pierces(t[i], t[(i + 1) % 3], s)) return 0;
    least = std::min({least, point_face_square(p, t), point_face_square(t[i], s)});
    for (std::size_t j = 0; j < 3; ++j) least = std::min(least, segment_segment_square(p, q, t[j], t[(j + 1) % 3]));
  }
  return least;
}

/// A triangle with a ball around it.
struct Face {
  Corners corners;
  Point center;
  Real radius;
};

std::vector<Face> faces_of(const Mesh& mesh, const Pose& X) {
  std::vector<Point> points;
  for (const Eigen::Vector3d& p : mesh.vertices()) {
    points.push_back(X.R.cast<Real>() * p.cast<Real>() + X.t.cast<Real>());
  }
  std::vector<Face> faces;
  for (const auto& [i, j, k] : mesh.triangles()) {
    Face face{
        .corners = {points[i], points[j], points[k]}, .center = (points[i] + points[j] + points[k]) / 3, .radius = 0};
    for (const Point& p : face.corners) face.radius = std::max(face.radius, (p - face.center).norm());
    faces.push_back(face);
  }
  return faces;
}

/// Whether two balls are farther apart than the square root of `square`, with room for rounding.
bool beyond(const Face& s, const Face& t, Real square) {
  constexpr Real k_room = 1 - 1e-15L;
  const Real gap = k_room * (s.center - t.center).norm() - s.radius - t.radius;
  return gap > 0 && gap * gap > square;
}

}  // namespace

long double reference_distance(const Mesh& a, const Mesh& b, const Pose& X_AB) {
  const std::vector<Face> of_a = faces_of(a, {}), of_b = faces_of(b, X_AB);
  Real least = std::numeric_limits<Real>::infinity();
  for (const Face& s : of_a) {
    for (const Face& t : of_b) {
      if (!beyond(s, t, least)) least = std::min(least, square_distance(s.corners, t.corners));
    }
    if (least == 0) return 0;
  }
  return std::sqrt(least);
}

}  // namespace sixdof::stability
