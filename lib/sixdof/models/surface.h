#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// A triangle mesh under construction: nothing is checked yet, Mesh::build does that.
struct Surface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
};

/// Most triangles that a recipe makes: above this a typing mistake is likelier than a wish.
constexpr std::size_t k_maximum_triangles = 20'000'000;

/// The number of triangles that a recipe will have: `triangles`, plus one if it is odd, since every closed surface of
/// triangles has an even number of them.
/// @throws BadArgument if `triangles` is below `minimum`, the coarsest form of the recipe, or above
/// k_maximum_triangles.
std::size_t triangle_budget(const std::string& recipe, std::size_t triangles, std::size_t minimum);

/// An edge length h, as long as needed for count(h) <= budget, found by lengthening from the edge of equilateral
/// triangles that share `area` equally. `count` must reach 0 or its minimum <= budget for long edges.
template <class Count>
double fit_edge_length(double area, std::size_t budget, Count count) {
  constexpr double k_equilateral = 2.309401076758503;  // 4 / sqrt(3): edge^2 over area
  constexpr double k_start = 0.95;                     // a little too short at first
  constexpr double k_growth = 1.004;                   // under a percent of triangles a step
  double h = k_start * std::sqrt(k_equilateral * area / static_cast<double>(budget));
  while (count(h) > budget) h *= k_growth;
  return h;
}

/// The whole number nearest to length / step, at least `least`.
inline std::uint32_t whole_steps(double length, double step, std::uint32_t least) {
  const double steps = std::floor(length / step + 0.5);
  return steps > static_cast<double>(least) ? static_cast<std::uint32_t>(steps) : least;
}

}  // namespace sixdof
