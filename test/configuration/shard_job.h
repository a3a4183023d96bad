#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include <sixdof/configuration/generation_job.h>
#include <sixdof/configuration/shard_file.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/generation/shard_generator.h>

#include "shapes.h"

namespace sixdof::test {

/// A small job with distances and volumes on different grids, repeated rotations, and different meshes A and B.
struct SmallJob {
  explicit SmallJob(std::uint64_t seed = 1)
      : a(lump_mesh(seed, {0.3, -0.1, 2.0})), b(lump_mesh(seed + 1, {-1.0, 0.4, 0.2})) {
    set.generator_version = "1.2.3";
    set.a = MeshIdentity::of(a);
    set.b = MeshIdentity::of(b);
    set.grid = make_grid("90/60");
    set.volume_grid = make_grid("90");
    job = GenerationJob::of("1.2.3 abc", generator->oracle_name(), generator->oracle_version(), a, set,
                            std::vector{20.0, 0.0}, std::vector{3.0});
  }

  Generated compute(ShardNumber shard, unsigned threads = 1) const {
    return generate_shard(job, set, shard, *generator, a, b, {.threads = threads});
  }

  /// Writes all shards of a split. @return their files
  std::vector<std::filesystem::path> write(const std::filesystem::path& folder, std::size_t count) const {
    std::vector<std::filesystem::path> paths;
    for (std::size_t number = 1; number <= count; ++number) {
      const ShardNumber shard{.number = number, .count = count};
      paths.push_back(folder / shard_file_name(shard));
      write_shard(paths.back(), job, set, shard, compute(shard).buckets);
    }
    return paths;
  }

  Mesh a, b;
  std::unique_ptr<DistanceGenerator> generator = make_ray_cast();
  SetDescription set;
  GenerationJob job;
};

}  // namespace sixdof::test
