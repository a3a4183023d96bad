#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace sixdof {

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

}  // namespace sixdof
