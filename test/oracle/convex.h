#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

/// Intersection of two convex bodies by clipping every face with the other body's half-spaces: a closed form that
/// shares nothing with the oracle.
namespace sixdof::convex {

using Polygon = std::vector<Eigen::Vector3d>;

struct HalfSpace {
  Eigen::Vector3d point, normal;  ///< Inside is where normal . (p - point) < 0.
};

struct Common {
  double volume = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();   ///< Integral of p over the intersection.
  Eigen::Vector3d area = Eigen::Vector3d::Zero();    ///< Integral of n over B's faces inside A.
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< Integral of p x n over the same.
};

inline Polygon clip(const Polygon& polygon, const HalfSpace& h) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double at_p = h.normal.dot(p - h.point), at_q = h.normal.dot(q - h.point);
    if (at_p <= 0.0) kept.push_back(p);
    if ((at_p < 0.0) != (at_q < 0.0) && at_p != at_q) kept.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return kept;
}

/// Adds a face's flux terms by Gauss points that are exact for quadratics: the midpoints of a triangle's sides.
inline void integrate(const Polygon& polygon, bool of_b, Common& sum) {
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Eigen::Vector3d &p = polygon[0], &q = polygon[i - 1], &r = polygon[i];
    const Eigen::Vector3d n = 0.5 * (q - p).cross(r - p);
    for (const Eigen::Vector3d& m :
         {Eigen::Vector3d(0.5 * (p + q)), Eigen::Vector3d(0.5 * (q + r)), Eigen::Vector3d(0.5 * (r + p))}) {
      sum.volume += m.dot(n) / 9.0;
      sum.first += 0.5 * m.squaredNorm() * n / 3.0;
      if (of_b) {
        sum.area += n / 3.0;
        sum.moment += m.cross(n) / 3.0;
      }
    }
  }
}

/// Of two convex meshes in general position; everything about the origin of A's frame.
inline Common intersect(const Mesh& a, const Mesh& b, const Pose& X_AB) {
  const auto faces = [](const Mesh& mesh, const Pose& X) {
    std::vector<Polygon> result;
    for (const Triangle& t : mesh.triangles()) {
      result.push_back({X * mesh.vertices()[t[0]], X * mesh.vertices()[t[1]], X * mesh.vertices()[t[2]]});
    }
    return result;
  };
  const auto of_a = faces(a, Pose{}), of_b = faces(b, X_AB);
  const auto planes = [](const std::vector<Polygon>& polygons) {
    std::vector<HalfSpace> result;
    for (const Polygon& f : polygons) {
      const Eigen::Vector3d n = (f[1] - f[0]).cross(f[2] - f[0]).normalized();
      bool is_new = true;  // a box's faces are two triangles each
      for (const HalfSpace& h : result) {
        is_new = is_new && !(h.normal.dot(n) > 1.0 - 1e-12 && std::abs(n.dot(f[0] - h.point)) < 1e-12);
      }
      if (is_new) result.push_back({f[0], n});
    }
    return result;
  };
  const auto planes_a = planes(of_a), planes_b = planes(of_b);
  Common sum;
  const auto add = [&](const std::vector<Polygon>& polygons, const std::vector<HalfSpace>& by, bool is_b) {
    for (Polygon f : polygons) {
      for (const HalfSpace& h : by) f = clip(f, h);
      if (f.size() > 2) integrate(f, is_b, sum);
    }
  };
  add(of_a, planes_b, false);
  add(of_b, planes_a, true);
  return sum;
}

}  // namespace sixdof::convex
