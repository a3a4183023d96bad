#include <sixdof/algorithm/ist/sphere.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sixdof::ist {
namespace {

constexpr std::size_t k_size_classes = 40;  // radii down to largest / 2^40; smaller ones are in the last class
constexpr double k_cell_radii = 4.0;        // cell width in largest radii of the class

double class_radius(double largest, std::size_t size_class) {
  return std::ldexp(largest, -static_cast<int>(size_class));
}

std::int64_t cell_of(double coordinate, double width) {
  return static_cast<std::int64_t>(std::floor(coordinate / width));
}

}  // namespace

double overlap_volume(double r1, double r2, double d) {
  if (d >= r1 + r2) return 0.0;
  const double smaller = std::min(r1, r2);
  if (d <= std::abs(r1 - r2)) return Sphere{{}, smaller}.volume();
  const double depth = r1 + r2 - d;
  const double difference = r1 - r2;
  return std::numbers::pi * depth * depth * (d * d + 2.0 * d * (r1 + r2) - 3.0 * difference * difference) / (12.0 * d);
}

double total_volume(std::span<const Sphere> spheres) {
  double volume = 0.0;
  for (const Sphere& s : spheres) volume += s.volume();
  return volume;
}

Sphere enclosing_sphere(std::span<const Sphere> spheres) {
  // Steps of 1/(k+1) towards the farthest point bring the radius within about 1/k of the smallest.
  constexpr int k_steps = 40;
  constexpr double k_rounding_up = 1.0 + 1e-14;  // more than the rounding of a norm and a sum
  if (spheres.size() == 1) return spheres.front();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double weight = 0.0;
  for (const Sphere& s : spheres) {
    center += s.volume() * s.center;
    weight += s.volume();
  }
  center /= weight;
  Sphere best{center, std::numeric_limits<double>::infinity()};
  for (int step = 1; step <= k_steps; ++step) {
    double radius = -1.0;
    const Sphere* farthest = nullptr;
    for (const Sphere& s : spheres) {
      const double reach = (s.center - center).norm() + s.radius;
      if (reach > radius) {
        radius = reach;
        farthest = &s;
      }
    }
    if (radius < best.radius) best = {center, radius};
    const Eigen::Vector3d offset = farthest->center - center;
    const double distance = offset.norm();
    if (distance == 0.0) break;  // concentric with the farthest sphere: nothing smaller contains it
    center += offset * (radius / distance / (step + 1.0));
  }
  best.radius *= k_rounding_up;
  return best;
}

SphereIndex::SphereIndex(double largest) : largest_(largest), class_members_(k_size_classes), cells_(1024) {}

std::uint64_t SphereIndex::key(std::size_t size_class, std::int64_t x, std::int64_t y, std::int64_t z) const {
  // 19 bits per coordinate and 6 for the class; cells whose coordinates wrap to the same bits share a list.
  constexpr std::uint64_t mask = (1u << 19) - 1u;
  return 1u + ((static_cast<std::uint64_t>(size_class) << 57) | ((static_cast<std::uint64_t>(x) & mask) << 38) |
               ((static_cast<std::uint64_t>(y) & mask) << 19) | (static_cast<std::uint64_t>(z) & mask));
}

std::size_t SphereIndex::slot(std::uint64_t wanted) const {
  std::uint64_t h = wanted * 0x9E3779B97F4A7C15ull;
  h ^= h >> 32;
  std::size_t i = static_cast<std::size_t>(h) & (cells_.size() - 1);
  while (cells_[i].key != 0 && cells_[i].key != wanted) i = (i + 1) & (cells_.size() - 1);
  return i;
}

void SphereIndex::grow() {
  std::vector<Cell> old(2 * cells_.size());
  old.swap(cells_);
  for (const Cell& cell : old) {
    if (cell.key != 0) cells_[slot(cell.key)] = cell;
  }
}

void SphereIndex::insert(const Sphere& sphere) {
  int exponent = 0;
  std::frexp(largest_ / sphere.radius, &exponent);  // radius in (largest / 2^exponent, largest / 2^(exponent-1)]
  const auto size_class = static_cast<std::size_t>(std::clamp(exponent - 1, 0, static_cast<int>(k_size_classes) - 1));
  const double width = k_cell_radii * class_radius(largest_, size_class);
  if (2 * (used_ + 1) > cells_.size()) grow();
  const std::uint64_t wanted = key(size_class, cell_of(sphere.center.x(), width), cell_of(sphere.center.y(), width),
                                   cell_of(sphere.center.z(), width));
  Cell& cell = cells_[slot(wanted)];
  if (cell.key == 0) {
    cell.key = wanted;
    ++used_;
  }
  next_.push_back(cell.first);
  cell.first = static_cast<std::int32_t>(spheres_.size());
  spheres_.push_back(sphere);
  class_members_[size_class].push_back(static_cast<std::int32_t>(spheres_.size()) - 1);
}

/// Calls visit(index) for all spheres whose clearance may be below `within`, large ones first. `within` may shrink
/// meanwhile.
template <class Visit>
void SphereIndex::for_candidates(const Eigen::Vector3d& p, const double& within, const Visit& visit) const {
  for (std::size_t size_class = 0; size_class < k_size_classes; ++size_class) {
    const std::vector<std::int32_t>& members = class_members_[size_class];
    if (members.empty()) continue;
    const double radius = class_radius(largest_, size_class);
    const double width = k_cell_radii * radius;
    const double reach = within + radius;  // the centre of a sphere that is near enough is within this
    if (reach <= 0.0) continue;
    std::array<std::int64_t, 3> low, high;
    double cell_count = 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = cell_of(p[static_cast<Eigen::Index>(k)] - reach, width);
      high[k] = cell_of(p[static_cast<Eigen::Index>(k)] + reach, width);
      cell_count *= static_cast<double>(high[k] - low[k] + 1);
    }
    // Far away from small spheres more cells are in reach than the class has spheres.
    if (cell_count > static_cast<double>(members.size())) {
      for (const std::int32_t s : members) visit(s);
      continue;
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const Cell& cell = cells_[slot(key(size_class, x, y, z))];
          for (std::int32_t s = cell.first; s >= 0; s = next_[static_cast<std::size_t>(s)]) visit(s);
        }
      }
    }
  }
}

SphereIndex::Nearest SphereIndex::nearest(const Eigen::Vector3d& p, double within) const {
  Nearest best{within};
  for_candidates(p, best.clearance,
                 [&](std::int32_t s) { best.consider(spheres_[static_cast<std::size_t>(s)], p, s); });
  return best;
}

void SphereIndex::find_near(const Eigen::Vector3d& p, double within, std::vector<Near>& found) const {
  for_candidates(p, within, [&](std::int32_t s) {
    const Sphere& sphere = spheres_[static_cast<std::size_t>(s)];
    const double clearance = (sphere.center - p).norm() - sphere.radius;
    if (clearance < within) found.push_back({sphere, clearance, s});
  });
}

}  // namespace sixdof::ist
