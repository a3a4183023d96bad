#include <sixdof/scenario/parameters.h>

#include <sixdof/base/error.h>

namespace sixdof {

Parameter length_parameter(const std::string& name, const std::string& meaning, const std::string& standard) {
  return {.name = name, .meaning = meaning, .unit = "length", .standard = standard, .low = 1e-6, .high = 1e6};
}

void add_round_parameters(std::vector<Parameter>& parameters) {
  // Below 8 facets a polygon is no round part; above 4096 a sphere has 16 million triangles.
  parameters.push_back({.name = "facets",
                   .meaning = "sides of the polygon that stands for a circle",
                   .unit = "1",
                   .standard = "96",
                   .low = 8,
                   .high = 4096,
                   .integer = true});
  parameters.push_back({.name = "round",
                   .meaning = "polygons with vertices on the circle, or with the circle's area (spheres: volume)",
                   .unit = "1",
                   .standard = "equal_area",
                   .choices = {"equal_area", "inscribed"}});
}

int facets_of(const Settings& settings) { return static_cast<int>(settings.number("facets")); }

RoundParts round_parts_of(const Settings& settings) {
  return settings.choice("round") == "inscribed" ? RoundParts::inscribed : RoundParts::equal_area;
}

void require(bool holds, const std::string& words) {
  if (!holds) throw BadArgument(words);
}

}  // namespace sixdof
