#include <sixdof/configuration/bucket_sample.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace sixdof {
namespace {

/// Fisher-Yates. Not std::shuffle, whose order may differ from one standard library to the next. The bias of the
/// modulo is at most length / 2^64.
std::vector<std::size_t> permutation(std::size_t length, std::mt19937_64& random) {
  std::vector<std::size_t> list(length);
  std::iota(list.begin(), list.end(), std::size_t{0});
  for (std::size_t i = length; i > 1; --i) std::swap(list[i - 1], list[random() % i]);
  return list;
}

}  // namespace

CellOrder::CellOrder(std::size_t rotations, std::size_t directions, std::uint64_t seed)
    : period_(std::lcm(rotations, directions)) {
  std::mt19937_64 random(seed);
  rotations_ = permutation(rotations, random);
  directions_ = permutation(directions, random);
}

/// Within a period no pair of remainders occurs twice, by the Chinese remainder theorem; the shift by one direction
/// after each period gives the pairs of remainders that have not occurred.
std::uint64_t CellOrder::operator[](std::uint64_t t) const {
  const std::size_t rotation = rotations_[t % rotations_.size()];
  return rotation * directions_.size() + directions_[(t + t / period_) % directions_.size()];
}

BucketSample sample_bucket(const ConfigurationSet& set, BucketKey key, const Mesh& a, const Mesh& b, std::size_t count,
                           std::uint64_t seed) {
  const BucketSummary& summary = set.summary(key);
  const Grid& grid = set.grid(key.kind);
  const std::vector<double> translations = set.read(key);
  BucketSample sample{.key = key,
                      .target = summary.target,
                      .tolerance = summary.tolerance,
                      .diagonal = a.diagonal(),
                      .reachable = summary.reachable};
  const std::size_t directions = grid.directions.size();
  const CellOrder order(grid.rotations.size(), directions, seed);
  for (std::uint64_t t = 0; t < order.size(); ++t) {
    if (count > 0 && sample.poses.size() == count) break;
    const std::uint64_t cell = order[t];
    const double s = translations[cell];
    if (std::isnan(s)) continue;  // The target is not met on this ray.
    const ConfigurationRay ray(a, b, grid.rotations[cell / directions], grid.directions[cell % directions]);
    sample.poses.push_back(ray.pose(s));
    sample.cells.push_back(cell);
  }
  return sample;
}

std::vector<std::size_t> grid_order(const BucketSample& sample, std::size_t count) {
  std::vector<std::size_t> order(std::min(count, sample.poses.size()));
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return sample.cells[i]; });
  return order;
}

std::vector<std::size_t> random_order(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  return permutation(count, random);
}

}  // namespace sixdof
