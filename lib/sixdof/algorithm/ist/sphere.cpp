#include <sixdof/algorithm/ist/sphere.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sixdof::ist {

double overlap_volume(double r1, double r2, double d) {
  if (d >= r1 + r2) return 0.0;
  const double smaller = std::min(r1, r2);
  if (d <= std::abs(r1 - r2)) return Sphere{{}, smaller}.volume();
  const double depth = r1 + r2 - d;
  const double difference = r1 - r2;
  return std::numbers::pi * depth * depth * (d * d + 2.0 * d * (r1 + r2) - 3.0 * difference * difference) / (12.0 * d);
}

Sphere enclosing_sphere(std::span<const Sphere> spheres) {
  // Steps of 1/(k+1) towards the farthest point bring the radius within about 1/k of the smallest.
  constexpr int k_steps = 40;
  constexpr double k_rounding_up = 1.0 + 1e-14;  // more than the rounding of a norm and a sum
  if (spheres.size() == 1) return spheres.front();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double weight = 0.0;
  for (const Sphere& s : spheres) {
    center += s.volume() * s.center;
    weight += s.volume();
  }
  center /= weight;
  Sphere best{center, std::numeric_limits<double>::infinity()};
  for (int step = 1; step <= k_steps; ++step) {
    double radius = -1.0;
    const Sphere* farthest = nullptr;
    for (const Sphere& s : spheres) {
      const double reach = (s.center - center).norm() + s.radius;
      if (reach > radius) {
        radius = reach;
        farthest = &s;
      }
    }
    if (radius < best.radius) best = {center, radius};
    const Eigen::Vector3d offset = farthest->center - center;
    const double distance = offset.norm();
    if (distance == 0.0) break;  // concentric with the farthest sphere: nothing smaller contains it
    center += offset * (radius / distance / (step + 1.0));
  }
  best.radius *= k_rounding_up;
  return best;
}

}  // namespace sixdof::ist
