#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <Eigen/Core>

#include <sixdof/geometry/raw_mesh.h>
#include <sixdof/geometry/sides.h>

namespace sixdof {

inline Mesh to_mesh(RawMesh made, std::string name) {
  return Mesh::build(std::move(made.vertices), std::move(made.triangles), std::move(name));
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

/// Joins two rings by triangles in the order of their angles. Both rings are counter-clockwise seen against the
/// direction from `lower` to `upper`; the triangles face away from the axis.
void stitch(RawMesh& surface, const Ring& lower, const Ring& upper);

/// Most triangles that a recipe or a subdivision makes: a larger number is taken for a typing mistake.
constexpr std::size_t k_maximum_triangles = 20'000'000;

/// @throws BadArgument with "RECIPE: MESSAGE" unless `holds`.
void check_shape(bool holds, const std::string& recipe, const std::string& message);

/// @throws BadArgument unless `value` is positive and finite: "cone: radius is -1, but must be positive and finite".
void check_length(const std::string& recipe, const std::string& which, double value);

/// The number of triangles that a recipe will have: `triangles`, plus one if it is odd, since every closed surface of
/// triangles has an even number of them.
/// @throws BadArgument if `triangles` is below `minimum`, that of the recipe's coarsest form, or above
/// k_maximum_triangles.
std::size_t triangle_budget(const std::string& recipe, std::size_t triangles, std::size_t minimum);

/// An edge length h with count(h) <= budget, nearly the shortest: the search starts at the edge of equilateral
/// triangles of `area` in total. `count` must fall to `budget` or below for long edges.
template <class Count>
double fit_edge_length(double area, std::size_t budget, Count count) {
  constexpr double k_equilateral = 2.309401076758503;  // 4 / sqrt(3): edge^2 over area
  constexpr double k_start = 0.95;                     // a little too short at first
  constexpr double k_growth = 1.004;                   // less than a percent of the triangles per step
  double h = k_start * std::sqrt(k_equilateral * area / static_cast<double>(budget));
  while (count(h) > budget) h *= k_growth;
  return h;
}

/// The whole number nearest to length / step, at least `least`.
inline std::uint32_t whole_steps(double length, double step, std::uint32_t least) {
  const double steps = std::floor(length / step + 0.5);
  return steps > static_cast<double>(least) ? static_cast<std::uint32_t>(steps) : least;
}

/// 3 * triangle + corner, as Side::corner: the side from that corner to the next.
using HalfEdge = std::uint32_t;

/// An edge by its end points, low < high, and one of its half-edges.
struct Edge {
  double length_squared;
  std::uint32_t low, high;
  HalfEdge half_edge;

  bool joins_same(const Edge& other) const { return low == other.low && high == other.high; }
};

/// The edge of a half-edge. From the lower number to the higher: the length has the same bits on both sides.
inline Edge edge_of(const RawMesh& surface, HalfEdge h) {
  const HalfEdge next = next_corner(h);
  const auto [low, high] = std::minmax(surface.triangles[h / 3][h % 3], surface.triangles[next / 3][next % 3]);
  const Eigen::Vector3d along = surface.vertices[high] - surface.vertices[low];
  return {dot_in_order(along, along), low, high, h};
}

}  // namespace sixdof
