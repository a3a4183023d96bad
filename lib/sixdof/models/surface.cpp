#include <sixdof/models/surface.h>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {

std::size_t triangle_budget(const std::string& recipe, std::size_t triangles, std::size_t minimum) {
  if (triangles < minimum || triangles > k_maximum_triangles) {
    throw BadArgument(
        fmt::format("{} has {} to {} triangles; {} were asked for", recipe, minimum, k_maximum_triangles, triangles));
  }
  return triangles + triangles % 2;
}

}  // namespace sixdof
