#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/save.h>

/// Mesh files with defects, for tests that type commands.
namespace sixdof::test {

/// A box with edges along the axes, as vertices and triangles.
inline void add_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, std::vector<Eigen::Vector3d>& vertices,
                    std::vector<Triangle>& triangles) {
  const auto n = static_cast<std::uint32_t>(vertices.size());
  for (unsigned i = 0; i < 8; ++i) {
    vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                          (i & 4) != 0 ? high.z() : low.z());
  }
  for (const Triangle& t : std::vector<Triangle>{{0, 2, 1},
                                                 {1, 2, 3},
                                                 {4, 5, 6},
                                                 {5, 7, 6},
                                                 {0, 1, 4},
                                                 {1, 5, 4},
                                                 {2, 6, 3},
                                                 {3, 6, 7},
                                                 {0, 4, 2},
                                                 {2, 4, 6},
                                                 {1, 3, 5},
                                                 {3, 7, 5}}) {
    triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
}

/// Two boxes of volume 8 that have a cube of volume 1 in common: solid() is true and volume() is 16.
inline void save_crossing_boxes(const std::filesystem::path& file) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  add_box({0, 0, 0}, {2, 2, 2}, vertices, triangles);
  add_box({1, 1, 1}, {3, 3, 3}, vertices, triangles);
  save_mesh(Mesh::build(std::move(vertices), std::move(triangles), "crossing"), file);
}

}  // namespace sixdof::test
