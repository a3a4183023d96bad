#include <sixdof/geometry/sides.h>

#include <algorithm>
#include <tuple>

namespace sixdof {

std::vector<Side> sorted_sides(std::span<const Triangle> triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[t][k];
      const std::uint32_t to = triangles[t][(k + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), 3 * t + k, from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
  });
  return sides;
}

}  // namespace sixdof
