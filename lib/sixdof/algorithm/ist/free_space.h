#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <sixdof/algorithm/ist/sphere.h>
#include <sixdof/geometry/tree.h>

namespace sixdof::ist {

/// An inserted sphere, or the tangent plane of the surface at the closest point.
struct Obstacle {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< Centre of the sphere, or point on the surface.
  Eigen::Vector3d normal =
      Eigen::Vector3d::Zero();  ///< Plane: unit normal towards the point that asks. Sphere: unused.
  double radius = 0.0;          ///< Sphere: > 0. Plane: 0.

  double distance(const Eigen::Vector3d& p) const {
    return radius > 0.0 ? (p - point).norm() - radius : normal.dot(p - point);
  }
  Eigen::Vector3d away(const Eigen::Vector3d& p) const {
    return radius > 0.0 ? Eigen::Vector3d((p - point).normalized()) : normal;
  }
};

/// The space inside a mesh and outside of spheres.
struct FreeSpace {
  const Tree& tree;
  SphereIndex spheres;
};

/// Answers how far points are from the obstacles of a free space. Points that are asked one after the other lie near
/// each other: the obstacles around them are looked up once, for many of them.
class ClearanceQuery {
 public:
  explicit ClearanceQuery(const FreeSpace& space) : space_(&space) {}

  struct Clearance {
    double value = 0.0;  ///< Distance to the closest obstacle; `bound` if none is nearer than that.
    Obstacle obstacle;   ///< The closest one. Of equally near ones the surface, then the sphere that came first.
  };

  /// @param bound upper bound on the clearance; it changes by at most the length of a step
  Clearance operator()(const Eigen::Vector3d& p, double bound);

  /// Forgets what was looked up: to be called after a sphere was inserted.
  void reset() { reach_ = -1.0; }

 private:
  struct NearTriangle {
    double least;  ///< Lower bound on the distance from place_.
    std::uint32_t position;
  };

  void look_around(const Eigen::Vector3d& p, double reach);
  void find_triangles(double reach);
  SphereIndex::Nearest nearest_sphere(const Eigen::Vector3d& p, double moved, double within) const;
  bool nearest_on_surface(const Eigen::Vector3d& p, double moved, double within, Eigen::Vector3d& point,
                          double& distance) const;

  const FreeSpace* space_;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();  ///< Where the obstacles were looked up.
  double reach_ = -1.0;                              ///< All obstacles with a smaller clearance at place_ are known.
  bool few_triangles_ = false;                       ///< If not, each query searches the tree.
  std::vector<SphereIndex::Near> spheres_;           ///< By increasing clearance.
  std::vector<NearTriangle> triangles_;              ///< By increasing bound.
};

}  // namespace sixdof::ist
