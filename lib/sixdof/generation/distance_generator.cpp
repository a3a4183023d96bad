#include <sixdof/generation/distance_generator.h>

#include <sixdof/generation/rotation_sweep.h>

namespace sixdof {

Generated generate_distances(const DistanceGenerator& generator, const Mesh& a, const Mesh& b, const Grid& grid,
                             std::span<const int> percents, const RunOptions& run,
                             std::span<const std::uint32_t> rotations) {
  std::vector<BucketSummary> summaries;
  for (const int percent : percents) {
    BucketSummary summary = distance_bucket(a, percent);
    summary.oracle = generator.oracle_name();
    summary.oracle_version = generator.oracle_version();
    summaries.push_back(std::move(summary));
  }
  return detail::sweep_rotations([&] { return generator.prepare(a, b); }, grid, summaries, run, rotations);
}

}  // namespace sixdof
