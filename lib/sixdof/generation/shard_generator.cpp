#include <sixdof/generation/shard_generator.h>

#include <algorithm>
#include <iterator>

#include <sixdof/generation/volume_generator.h>

namespace sixdof {
namespace {

std::vector<int> percents(const GenerationJob& job, BucketKind kind) {
  std::vector<int> list;
  for (const BucketSummary& bucket : job.buckets) {
    if (bucket.key.kind == kind) list.push_back(bucket.key.percent);
  }
  return list;
}

}  // namespace

Generated generate_shard(const GenerationJob& job, const SetDescription& set, ShardNumber shard,
                         const DistanceGenerator& generator, const Mesh& a, const Mesh& b,
                         const ShardOptions& options) {
  Generated result;
  const auto generate = [&](BucketKind kind, auto generate_buckets) {
    if (!job.has(kind)) return;
    const Grid& grid = set.grid_of(kind);
    const DistinctRotations distinct(grid.rotations);
    const auto part = rotations_of(shard, distinct);
    GenerateOptions part_options{.threads = options.threads, .progress = nullptr, .cancelled = options.cancelled};
    part_options.rotations.assign(part.begin(), part.end());
    if (options.progress) {
      part_options.progress = [&](std::uint64_t done, std::uint64_t /*total*/) { options.progress(kind, done); };
    }
    Generated made = generate_buckets(generator, a, b, grid, percents(job, kind), part_options);
    std::ranges::move(made.buckets, std::back_inserter(result.buckets));
    result.measurements += made.measurements;
  };
  generate(BucketKind::distance, generate_distances);
  generate(BucketKind::volume, generate_volumes);
  return result;
}

}  // namespace sixdof
