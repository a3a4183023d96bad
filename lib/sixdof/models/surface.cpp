#include <sixdof/models/surface.h>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

std::uint32_t vertex_of(const Ring& ring, std::uint32_t j) { return ring.first + j % ring.count; }

/// Whether the middle of edge i of one ring is before the middle of edge j of the other, by exact integers.
bool comes_first(const Ring& lower, std::uint32_t i, const Ring& upper, std::uint32_t j) {
  const std::uint64_t left = (2ULL * i + lower.shift + 1) * upper.count;
  const std::uint64_t right = (2ULL * j + upper.shift + 1) * lower.count;
  return left <= right;
}

}  // namespace

void stitch(RawMesh& surface, const Ring& lower, const Ring& upper) {
  const std::uint32_t lower_edges = lower.count == 1 ? 0 : lower.count;
  const std::uint32_t upper_edges = upper.count == 1 ? 0 : upper.count;
  std::uint32_t i = 0;
  std::uint32_t j = 0;
  while (i < lower_edges || j < upper_edges) {
    if (j == upper_edges || (i < lower_edges && comes_first(lower, i, upper, j))) {
      surface.triangles.push_back({vertex_of(lower, i), vertex_of(lower, i + 1), vertex_of(upper, j)});
      ++i;
    } else {
      surface.triangles.push_back({vertex_of(lower, i), vertex_of(upper, j + 1), vertex_of(upper, j)});
      ++j;
    }
  }
}

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
