#include <sixdof/generation/shard_generator.h>

#include <algorithm>
#include <array>
#include <iterator>

#include <sixdof/generation/volume_generator.h>

namespace sixdof {
namespace {

/// What a shard solves of one kind of bucket.
struct Part {
  Part(const GenerationJob& job, const SetDescription& set, ShardNumber shard, BucketKind which)
      : kind(which), grid(set.grid_of(kind)) {
    const DistinctRotations distinct(grid.rotations);
    const auto of_shard = rotations_of(shard, distinct);
    rotations.assign(of_shard.begin(), of_shard.end());
    for (const BucketSummary& bucket : job.buckets) {
      if (bucket.key.kind == kind) percents.push_back(bucket.key.percent);
    }
  }
  std::uint64_t configurations() const { return percents.size() * rotations.size() * grid.directions.size(); }

  BucketKind kind;
  const Grid& grid;
  std::vector<std::uint32_t> rotations;
  std::vector<double> percents;
};

}  // namespace

Generated generate_shard(const GenerationJob& job, const SetDescription& set, ShardNumber shard,
                         const DistanceGenerator& generator, const Mesh& a, const Mesh& b, const RunOptions& run) {
  const std::array parts{Part(job, set, shard, BucketKind::distance), Part(job, set, shard, BucketKind::volume)};
  const std::uint64_t total = parts[0].configurations() + parts[1].configurations();
  std::uint64_t before = 0;
  Generated result;
  for (const Part& part : parts) {
    if (part.percents.empty()) continue;
    RunOptions part_run = run;
    if (run.progress) {
      part_run.progress = [&](std::uint64_t done, std::uint64_t /*total*/) { run.progress(before + done, total); };
    }
    const auto generate = part.kind == BucketKind::distance ? generate_distances : generate_volumes;
    Generated made = generate(generator, a, b, part.grid, part.percents, part_run, part.rotations);
    std::ranges::move(made.buckets, std::back_inserter(result.buckets));
    result.measurements += made.measurements;
    before += part.configurations();
  }
  return result;
}

}  // namespace sixdof
