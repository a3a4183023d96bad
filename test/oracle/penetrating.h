#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/oracle/convex_hull.h>

#include "bodies.h"

/// Small bodies with known penetration depths.
namespace sixdof::penetrating {

/// The hull of random points, with radii from 0.35 to 0.6.
inline Mesh hull_of_points(std::mt19937_64& random, std::size_t count) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> radius(0.35, 0.6);
  std::vector<Eigen::Vector3d> p;
  std::vector<Triangle> t;
  while (p.size() < count) {
    const Eigen::Vector3d u(normal(random), normal(random), normal(random));
    p.push_back(radius(random) * u.normalized());
  }
  for (std::uint32_t i = 0; i + 2 < count; ++i) t.push_back({i, i + 1, i + 2});
  return convex_hull(Mesh::build(std::move(p), std::move(t), "points"));
}

/// A plate of width 2, from z = -0.3 to 0.3, with a square hole of width 0.8 along z.
inline Mesh plate_with_hole() {
  std::vector<Eigen::Vector3d> p;
  for (const double z : {-0.3, 0.3}) {
    for (const double w : {1.0, 0.4}) {
      p.insert(p.end(), {{-w, -w, z}, {w, -w, z}, {w, w, z}, {-w, w, z}});
    }
  }
  std::vector<Triangle> t;
  const auto quad = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k, std::uint32_t l) {
    t.push_back({i, j, k});
    t.push_back({i, k, l});
  };
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t l = (k + 1) % 4;
    quad(8 + k, 8 + l, 12 + l, 12 + k);  // above
    quad(l, k, 4 + k, 4 + l);            // below
    quad(k, l, 8 + l, 8 + k);            // outer sides
    quad(4 + l, 4 + k, 12 + k, 12 + l);  // the hole
  }
  return Mesh::build(std::move(p), std::move(t), "plate");
}

/// An L: a bar from x = 0 to 1 and one from y = 0 to 1, both 0.3 wide, from z = 0 to 0.4.
inline Mesh l_shape() {
  const std::vector<Eigen::Vector2d> outline{{0, 0}, {1, 0}, {1, 0.3}, {0.3, 0.3}, {0.3, 1}, {0, 1}};
  std::vector<Eigen::Vector3d> p;
  for (const double z : {0.0, 0.4}) {
    for (const Eigen::Vector2d& x : outline) p.emplace_back(x.x(), x.y(), z);
  }
  std::vector<Triangle> t;
  for (const auto& f : {Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}, Triangle{0, 4, 5}}) {
    t.push_back({f[0] + 6, f[1] + 6, f[2] + 6});
    t.push_back({f[0], f[2], f[1]});
  }
  for (std::uint32_t k = 0; k < 6; ++k) {
    const std::uint32_t l = (k + 1) % 6;
    t.push_back({k, l, l + 6});
    t.push_back({k, l + 6, k + 6});
  }
  return Mesh::build(std::move(p), std::move(t), "L");
}

}  // namespace sixdof::penetrating
