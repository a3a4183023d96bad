#include <sixdof/geometry/sides.h>

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace sixdof {

std::vector<Side> sorted_sides(std::span<const Triangle> triangles) {
  // Placed by their lower vertex first, so that only the few sides of one vertex are left to sort.
  std::uint32_t last = 0;
  for (const Triangle& t : triangles) last = std::max({last, t[0], t[1], t[2]});
  std::vector<std::size_t> begin(std::size_t{last} + 2, 0);
  const auto for_each_side = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t from = triangles[t][k];
        const std::uint32_t to = triangles[t][(k + 1) % 3];
        visit(Side{std::min(from, to), std::max(from, to), 3 * t + k, from < to});
      }
    }
  };
  for_each_side([&](const Side& side) { ++begin[side.low + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());

  std::vector<Side> sides(3 * triangles.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for_each_side([&](const Side& side) { sides[next[side.low]++] = side; });
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    std::sort(sides.begin() + static_cast<std::ptrdiff_t>(begin[v]),
              sides.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]),
              [](const Side& a, const Side& b) { return a.high != b.high ? a.high < b.high : a.corner < b.corner; });
  }
  return sides;
}

}  // namespace sixdof
