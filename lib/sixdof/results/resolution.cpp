#include <sixdof/results/resolution.h>

#include <array>
#include <cstddef>
#include <iterator>

#include <fmt/format.h>

namespace sixdof::results {

std::string count_text(double count) {
  std::string text = fmt::format("{:.0f}", count);
  const std::ptrdiff_t first = text.starts_with('-') ? 1 : 0;
  for (std::ptrdiff_t at = std::ssize(text) - 3; at > first; at -= 3) text.insert(static_cast<std::size_t>(at), ",");
  return text;
}

std::string resolution_text(const RowGroup& group) {
  const std::array voxels{group.value("voxels_x"), group.value("voxels_y"), group.value("voxels_z")};
  const auto points = group.value("points"), a = group.value("spheres_a"), b = group.value("spheres_b");
  if (voxels[0] && voxels[1] && voxels[2] && points) {
    return fmt::format("{:.0f}x{:.0f}x{:.0f}, {}", *voxels[0], *voxels[1], *voxels[2], count_text(*points));
  }
  if (!a) return {};
  return !b || *a == *b ? count_text(*a) : fmt::format("{} and {}", count_text(*a), count_text(*b));
}

}  // namespace sixdof::results
