#include <sixdof/scenario/parameters.h>

#include <sixdof/base/error.h>

namespace sixdof {

Parameter length_parameter(const std::string& name, const std::string& meaning, const std::string& default_value) {
  return {.name = name, .meaning = meaning, .unit = "length", .default_value = default_value, .low = 1e-6, .high = 1e6};
}

void add_round_parameters(std::vector<Parameter>& parameters) {
  // Fewer than 8 facets do not approximate a circle; with 4096 a sphere has 16 million triangles.
  parameters.push_back({.name = "facets",
                        .meaning = "sides of the polygon that stands for a circle",
                        .unit = "1",
                        .default_value = "96",
                        .low = 8,
                        .high = 4096,
                        .integer = true});
  parameters.push_back({.name = "round",
                        .meaning = "polygons with vertices on the circle, or with the circle's area (spheres: volume)",
                        .unit = "1",
                        .default_value = "equal_area",
                        .choices = {"equal_area", "inscribed"}});
}

int facets_of(const Settings& settings) { return static_cast<int>(settings.number("facets")); }

RoundParts round_parts_of(const Settings& settings) {
  return settings.choice("round") == "inscribed" ? RoundParts::inscribed : RoundParts::equal_area;
}

void require(bool holds, const std::string& message) {
  if (!holds) throw BadArgument(message);
}

}  // namespace sixdof
