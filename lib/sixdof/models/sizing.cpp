#include <sixdof/models/sizing.h>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/models/surface.h>

namespace sixdof {

void check_shape(bool holds, const std::string& recipe, const std::string& message) {
  if (!holds) throw BadArgument(recipe + ": " + message);
}

void check_length(const std::string& recipe, const std::string& which, double value) {
  check_shape(std::isfinite(value) && value > 0.0, recipe,
              fmt::format("{} is {}, but must be positive and finite", which, value));
}

std::size_t triangle_budget(const std::string& recipe, std::size_t triangles, std::size_t minimum) {
  if (triangles < minimum || triangles > k_maximum_triangles) {
    throw BadArgument(
        fmt::format("{} has {} to {} triangles; {} were asked for", recipe, minimum, k_maximum_triangles, triangles));
  }
  return triangles + triangles % 2;
}

}  // namespace sixdof
