#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <sixdof/algorithm/ist/hierarchy.h>
#include <sixdof/algorithm/ist/sphere.h>
#include <sixdof/geometry/pose.h>

namespace sixdof::ist {

/// Spheres in a box of edge 2 that may overlap, which traversals allow.
inline std::vector<Sphere> random_spheres(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0), log_radius(-4.0, -1.2);
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
    spheres.push_back({{x, y, z}, std::exp(log_radius(random))});
  }
  return spheres;
}

/// Normal axes of a tree's leaves, rotated by R: random unit vectors that depend on the radius, so that they stay with
/// their spheres in another tree. A third of the leaves has none.
inline SphereTree with_axes(SphereTree tree, const Eigen::Matrix3d& R = Eigen::Matrix3d::Identity()) {
  tree.axes.clear();
  for (const Sphere& s : tree.leaves) {
    std::mt19937_64 random(static_cast<std::uint64_t>(1e12 * s.radius));
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    const bool none = random() % 3 == 0;
    tree.axes.push_back(none ? Eigen::Vector3d::Zero() : Eigen::Vector3d(R * Eigen::Vector3d(x, y, z).normalized()));
  }
  return tree;
}

inline Pose random_pose(std::mt19937_64& random, double reach) {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  q.normalize();
  const double x = normal(random), y = normal(random), z = normal(random);
  return {q.toRotationMatrix(), reach * Eigen::Vector3d(x, y, z)};
}

/// Numbers and points of a seed.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Eigen::Vector3d point(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
    return {x, y, z};
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace sixdof::ist
