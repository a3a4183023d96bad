#include <sixdof/algorithm/vps/distance_transform.h>

#include <algorithm>
#include <limits>

#include <sixdof/base/parallel.h>

namespace sixdof::vps {
namespace {

constexpr std::int32_t k_infinite = std::numeric_limits<std::int32_t>::max();

/// s.output[i] = min over j of (i - j)^2 + s.values[j], without the j where the value is k_infinite. Exact, in
/// integers.
void lower_envelope(int n, DistanceTransform::Scratch& s) {
  const auto at = [](std::vector<std::int32_t>& v, int i) -> std::int32_t& { return v[static_cast<std::size_t>(i)]; };
  int top = -1;
  for (int j = 0; j < n; ++j) {
    if (at(s.values, j) == k_infinite) continue;
    std::int32_t from = 0;  // parabola j is the lowest at i >= from
    while (top >= 0) {
      const std::int32_t i = at(s.centers, top);
      // Parabola j lies below parabola i at x > (j^2 - i^2 + values[j] - values[i]) / (2 (j - i)).
      const std::int32_t rise = j * j - i * i + at(s.values, j) - at(s.values, i), run = 2 * (j - i);
      const std::int32_t crossing = rise >= 0 ? rise / run : -((-rise + run - 1) / run);
      if (crossing >= at(s.bounds, top)) {
        from = crossing + 1;
        break;
      }
      --top;
    }
    if (from >= n) continue;
    ++top;
    at(s.centers, top) = j;
    at(s.bounds, top) = from;
  }
  if (top < 0) {
    std::fill_n(s.output.begin(), n, k_infinite);
    return;
  }
  for (int k = 0; k <= top; ++k) {
    const std::int32_t center = at(s.centers, k), value = at(s.values, center);
    const std::int32_t end = k < top ? at(s.bounds, k + 1) : n;
    for (std::int32_t i = at(s.bounds, k); i < end; ++i) at(s.output, i) = (i - center) * (i - center) + value;
  }
}

}  // namespace

DistanceTransform::DistanceTransform(const SurfaceVoxels& surface) : n_(surface.grid().voxels()) {
  const auto nx = static_cast<std::size_t>(n_.x()), ny = static_cast<std::size_t>(n_.y());
  along_z_.resize(nx * ny * static_cast<std::size_t>(n_.z()));
  parallel::for_each(ny, [&](std::size_t row) {
    const auto y = static_cast<int>(row);
    const auto line = [&](int z) { return along_z_.data() + (static_cast<std::size_t>(z) * ny + row) * nx; };
    const auto sweep = [&](int z, const std::uint16_t* previous) {
      std::uint16_t* const here = line(z);
      for (std::size_t x = 0; x < nx; ++x) {
        const auto next = static_cast<std::uint16_t>(previous[x] == k_none ? k_none : previous[x] + 1);
        here[x] = std::min(here[x], next);
      }
    };
    for (int z = 0; z < n_.z(); ++z) {
      const std::span<const std::uint64_t> bits = surface.row(y, z);
      std::uint16_t* const here = line(z);
      for (std::size_t x = 0; x < nx; ++x) here[x] = (bits[x / 64] >> (x % 64) & 1u) != 0 ? 0 : k_none;
      if (z > 0) sweep(z, line(z - 1));
    }
    for (int z = n_.z() - 2; z >= 0; --z) sweep(z, line(z + 1));
  });
}

void DistanceTransform::slice(int z, Scratch& scratch, std::vector<std::int32_t>& squared) const {
  const auto nx = static_cast<std::size_t>(n_.x()), ny = static_cast<std::size_t>(n_.y());
  const std::size_t longest = std::max(nx, ny);
  for (auto* buffer : {&scratch.values, &scratch.centers, &scratch.bounds, &scratch.output}) buffer->resize(longest);
  squared.resize(nx * ny);
  const std::uint16_t* const g = along_z_.data() + static_cast<std::size_t>(z) * nx * ny;
  for (std::size_t x = 0; x < nx; ++x) {
    for (std::size_t y = 0; y < ny; ++y) {
      const std::int32_t distance = g[y * nx + x];
      scratch.values[y] = distance == k_none ? k_infinite : distance * distance;
    }
    lower_envelope(n_.y(), scratch);
    for (std::size_t y = 0; y < ny; ++y) squared[y * nx + x] = scratch.output[y];
  }
  for (std::size_t y = 0; y < ny; ++y) {
    const auto row = squared.begin() + static_cast<std::ptrdiff_t>(y * nx);
    std::copy_n(row, nx, scratch.values.begin());
    lower_envelope(n_.x(), scratch);
    std::copy_n(scratch.output.begin(), nx, row);
  }
}

}  // namespace sixdof::vps
