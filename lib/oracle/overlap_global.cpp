#include <sixdof/oracle/overlap_global.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A convex polygon in the xy plane, counter-clockwise. Clipping a triangle by three half-planes and one more leaves at
/// most seven corners.
struct Polygon {
  std::array<Vector2d, 8> corner;
  std::size_t size = 0;
  void push(const Vector2d& p) { corner[size++] = p; }
};

double cross(const Vector2d& u, const Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

/// Part of the polygon where `height`, linear over the plane, is not negative.
template <class Height>
Polygon clip(const Polygon& polygon, const Height& height) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Vector2d& p = polygon.corner[i];
    const Vector2d& q = polygon.corner[(i + 1) % polygon.size];
    const double at_p = height(p);
    const double at_q = height(q);
    if (at_p >= 0.0) kept.push(p);
    if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0)) kept.push(p + (at_p / (at_p - at_q)) * (q - p));
  }
  return kept;
}

/// A face over its projection: z = offset + slope . (xy - anchor).
struct Face {
  std::array<Vector2d, 3> corner;  // counter-clockwise
  Vector2d low, high;              // box of the projection
  Vector2d slope, anchor;
  double offset = 0.0, sign = 0.0;

  double z(const Vector2d& p) const { return offset + slope.dot(p - anchor); }
};

std::vector<Face> project(const Mesh& mesh, const Pose& pose, const Vector3d& origin) {
  std::vector<Face> faces;
  for (const Triangle& t : mesh.triangles()) {
    std::array<Vector3d, 3> c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = pose * mesh.vertices()[t[k]] - origin;
    const Vector3d n = (c[1] - c[0]).cross(c[2] - c[0]);
    if (n.z() == 0.0) continue;  // upright: no projection
    Face f;
    f.sign = n.z() > 0.0 ? 1.0 : -1.0;
    if (n.z() < 0.0) std::swap(c[1], c[2]);
    for (std::size_t k = 0; k < 3; ++k) f.corner[k] = c[k].head<2>();
    f.low = f.corner[0].cwiseMin(f.corner[1]).cwiseMin(f.corner[2]);
    f.high = f.corner[0].cwiseMax(f.corner[1]).cwiseMax(f.corner[2]);
    f.anchor = f.corner[0];
    f.offset = c[0].z();
    f.slope = Vector2d(-n.x() / n.z(), -n.y() / n.z());
    faces.push_back(f);
  }
  return faces;
}

/// Integral over the polygon of a function linear on it: area times the mean over each triangle of a fan.
template <class Height>
double integrate(const Polygon& polygon, const Height& height) {
  double sum = 0.0;
  for (std::size_t i = 2; i < polygon.size; ++i) {
    const Vector2d &p = polygon.corner[0], &q = polygon.corner[i - 1], &r = polygon.corner[i];
    sum += cross(q - p, r - p) / 6.0 * (height(p) + height(q) + height(r));
  }
  return sum;
}

double column(const Face& f, const Face& g) {
  Polygon common;
  for (const Vector2d& p : f.corner) common.push(p);
  for (std::size_t k = 0; k < 3 && common.size > 2; ++k) {
    const Vector2d& p = g.corner[k];
    const Vector2d side = g.corner[(k + 1) % 3] - p;
    common = clip(common, [&](const Vector2d& x) { return cross(side, x - p); });
  }
  if (common.size < 3) return 0.0;
  const auto f_lower = clip(common, [&](const Vector2d& x) { return g.z(x) - f.z(x); });
  const auto g_lower = clip(common, [&](const Vector2d& x) { return f.z(x) - g.z(x); });
  // Where both are equal everywhere both parts are the whole.
  if (f_lower.size == common.size && g_lower.size == common.size) {
    bool equal = true;
    for (std::size_t i = 0; i < common.size; ++i) equal = equal && f.z(common.corner[i]) == g.z(common.corner[i]);
    if (equal) return integrate(common, [&](const Vector2d& x) { return f.z(x); });
  }
  return integrate(f_lower, [&](const Vector2d& x) { return f.z(x); }) +
         integrate(g_lower, [&](const Vector2d& x) { return g.z(x); });
}

}  // namespace

double overlap_volume_by_columns(const Mesh& a, const Mesh& b, const Pose& X_AB) {
  for (const Mesh* mesh : {&a, &b}) {
    if (!mesh->solid()) throw BadMesh(mesh->name() + ": " + mesh->why_not_solid());
  }
  const Vector3d origin = a.center();
  const std::vector<Face> of_a = project(a, Pose{}, origin);
  std::vector<Face> of_b = project(b, X_AB, origin);
  std::sort(of_b.begin(), of_b.end(), [](const Face& f, const Face& g) { return f.low.x() < g.low.x(); });
  double sum = 0.0;
  double rest = 0.0;  // Neumaier's compensation
  for (const Face& f : of_a) {
    for (const Face& g : of_b) {
      if (g.low.x() >= f.high.x()) break;
      if (g.high.x() <= f.low.x() || g.low.y() >= f.high.y() || g.high.y() <= f.low.y()) continue;
      const double x = f.sign * g.sign * column(f, g);
      const double t = sum + x;
      rest += std::abs(sum) >= std::abs(x) ? (sum - t) + x : (x - t) + sum;
      sum = t;
    }
  }
  return sum + rest;
}

}  // namespace sixdof
