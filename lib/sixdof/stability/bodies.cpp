#include <sixdof/stability/bodies.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <sixdof/models/cos_sin.h>

namespace sixdof::stability {
namespace {

double signed_volume(const Points& p, const std::vector<Triangle>& triangles) {
  double volume = 0.0;
  for (const auto& [i, j, k] : triangles) volume += (p[i] - p[0]).dot((p[j] - p[0]).cross(p[k] - p[0]));
  return volume;
}

/// Facing outwards.
MeshPointer closed(Points points, std::vector<Triangle> triangles) {
  if (signed_volume(points, triangles) < 0.0) {
    for (Triangle& t : triangles) std::swap(t[1], t[2]);
  }
  return built(std::move(points), std::move(triangles));
}

}  // namespace

MeshPointer built(Points points, std::vector<Triangle> triangles, std::string name) {
  return std::make_shared<const Mesh>(Mesh::build(std::move(points), std::move(triangles), std::move(name)));
}

MeshPointer hexahedron(const std::array<Eigen::Vector3d, 8>& corners) {
  // Two triangles for each face, in the order low x, high x, low y, high y, low z, high z.
  std::vector<Triangle> triangles{{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                                  {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return closed({corners.begin(), corners.end()}, std::move(triangles));
}

MeshPointer box(const Eigen::Vector3d& size) {
  std::array<Eigen::Vector3d, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      corners[i][axis] = (i >> k & 1) != 0 ? 0.5 * size[axis] : -0.5 * size[axis];
    }
  }
  return hexahedron(corners);
}

MeshPointer tetrahedron(const std::array<Eigen::Vector3d, 4>& corners) {
  return closed({corners.begin(), corners.end()}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

MeshPointer triangles(const Points& corners) {
  std::vector<Triangle> faces;
  for (std::uint32_t i = 0; i + 2 < corners.size(); i += 3) faces.push_back({i, i + 1, i + 2});
  return built(corners, std::move(faces));
}

MeshPointer revolved(const std::vector<Level>& levels, std::size_t sides) {
  std::vector<Level> rings = levels;
  if (rings.front().radius > 0.0) rings.insert(rings.begin(), {0.0, rings.front().z});
  if (rings.back().radius > 0.0) rings.push_back({0.0, rings.back().z});
  const auto n = static_cast<std::uint32_t>(sides);
  Points points{{0.0, 0.0, rings.front().z}};
  for (std::size_t i = 1; i + 1 < rings.size(); ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const Eigen::Vector2d c = rings[i].radius * cos_sin(j, n);
      points.emplace_back(c.x(), c.y(), rings[i].z);
    }
  }
  points.emplace_back(0.0, 0.0, rings.back().z);
  const auto top = static_cast<std::uint32_t>(points.size() - 1);
  const auto count = static_cast<std::uint32_t>(rings.size() - 2);
  std::vector<Triangle> faces;
  for (std::uint32_t j = 0; j < n; ++j) {
    const std::uint32_t next = (j + 1) % n;
    faces.push_back({0, 1 + next, 1 + j});
    for (std::uint32_t i = 0; i + 1 < count; ++i) {
      const std::uint32_t low = 1 + i * n, high = low + n;
      faces.push_back({low + j, low + next, high + next});
      faces.push_back({low + j, high + next, high + j});
    }
    faces.push_back({top, 1 + (count - 1) * n + j, 1 + (count - 1) * n + next});
  }
  return closed(std::move(points), std::move(faces));
}

MeshPointer sphere(double radius, std::size_t sides) { return capsule(radius, 0.0, sides); }

MeshPointer cylinder(double radius, double half_height, std::size_t sides) {
  return revolved({{radius, -half_height}, {radius, half_height}}, sides);
}

MeshPointer capsule(double radius, double half_height, std::size_t sides) {
  const std::size_t rows = std::max<std::size_t>(2, sides / 4);  // of each half
  std::vector<Level> levels;
  for (std::size_t i = 0; i <= 2 * rows; ++i) {
    if (i == rows && half_height > 0.0) levels.push_back({radius, -half_height});
    // From the pole at -1/4 revolution to that at 1/4.
    const Eigen::Vector2d c = cos_sin((i + 3 * rows) % (4 * rows), 4 * rows);
    const double shift = i < rows ? -half_height : half_height;
    levels.push_back({std::max(0.0, radius * c.x()), radius * c.y() + shift});
  }
  return revolved(levels, sides);
}

MeshPointer transformed(const Mesh& mesh, const Placement& motion, double factor) {
  const Pose X = motion.pose();
  Points points;
  for (const Eigen::Vector3d& p : mesh.vertices()) points.push_back(X * (factor * p));
  return built(std::move(points), mesh.triangles(), mesh.name());
}

Placement z_to(const Eigen::Vector3d& direction, const Eigen::Vector3d& t) {
  return {t, Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), direction)};
}

}  // namespace sixdof::stability
