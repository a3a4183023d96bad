#include <sixdof/configuration/bucket_sample.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace sixdof {
namespace {

/// Fisher-Yates. Not std::shuffle, whose order may differ from one standard library to the next. The bias of the
/// modulo is at most length / 2^64.
template <class T>
void shuffle(std::vector<T>& list, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[random() % i]);
}

}  // namespace

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
  const bool all = count == 0 || summary.reachable <= count;

  const std::size_t directions = grid.directions.size();
  const std::size_t runs_per_rotation = (directions + BucketSample::k_run - 1) / BucketSample::k_run;
  std::vector<std::uint64_t> runs(grid.rotations.size() * runs_per_rotation);
  std::iota(runs.begin(), runs.end(), std::uint64_t{0});
  if (!all) shuffle(runs, seed);
  for (const std::uint64_t run : runs) {
    if (!all && sample.poses.size() >= count) break;
    const std::size_t r = run / runs_per_rotation;
    const std::size_t first = run % runs_per_rotation * BucketSample::k_run;
    for (std::size_t u = first; u < std::min(first + BucketSample::k_run, directions); ++u) {
      const double s = translations[r * directions + u];
      if (std::isnan(s)) continue;  // The target is not met on this ray.
      sample.poses.push_back(ConfigurationRay(a, b, grid.rotations[r], grid.directions[u]).pose(s));
    }
  }
  return sample;
}

std::vector<Pose> shuffled(const std::vector<Pose>& poses, std::size_t count, std::uint64_t seed) {
  std::vector<Pose> list(poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(std::min(count, poses.size())));
  shuffle(list, seed);
  return list;
}

}  // namespace sixdof
