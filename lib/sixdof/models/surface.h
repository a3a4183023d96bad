#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// A triangle mesh under construction, not validated.
struct Surface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;

  /// Adds a vertex. @return its number
  std::uint32_t add(const Eigen::Vector3d& p) {
    vertices.push_back(p);
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }
};

inline Mesh to_mesh(Surface surface, std::string name) {
  return Mesh::build(std::move(surface.vertices), std::move(surface.triangles), std::move(name));
}

/// Sums in a fixed order: Eigen's reductions depend on the processor, which a model's content hash must not.
inline double dot_in_order(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}

inline double norm_in_order(const Eigen::Vector3d& a) { return std::sqrt(dot_in_order(a, a)); }

/// A closed loop of consecutive vertices of a surface: vertex j lies at (2 j + shift) / (2 count) revolutions about the
/// axis. A single vertex is a pole.
struct Ring {
  std::uint32_t first = 0;
  std::uint32_t count = 1;
  std::uint32_t shift = 0;  ///< 0 or 1 half step: neighbouring rings of equal count are staggered.
};

/// Distance of rings over edge length: sqrt(3) / 2, for equilateral triangles.
inline constexpr double k_row = 0.8660254037844386;

/// Number of triangles between two rings.
inline std::size_t strip_size(std::uint32_t lower, std::uint32_t upper) {
  return (lower == 1 ? 0 : lower) + (upper == 1 ? 0 : upper);
}

/// Joins two rings by triangles in the order of their angles. Both rings are counter-clockwise seen against the
/// direction from `lower` to `upper`; the triangles face away from the axis.
void stitch(Surface& surface, const Ring& lower, const Ring& upper);

/// Most triangles that a recipe or a subdivision makes: a larger number is taken for a typing mistake.
constexpr std::size_t k_maximum_triangles = 20'000'000;

}  // namespace sixdof
