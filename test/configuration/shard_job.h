#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/configuration/generation_job.h>
#include <sixdof/generation/ray_cast.h>
#include <sixdof/configuration/shard_file.h>
#include <sixdof/generation/shard_generator.h>

#include "shapes.h"

namespace sixdof::test {

/// A small job with everything: distances and volumes on grids of their own, rotations that repeat, A and B unlike.
struct SmallJob {
  explicit SmallJob(std::uint64_t seed = 1)
      : a(lump_mesh(seed, {0.3, -0.1, 2.0})), b(lump_mesh(seed + 1, {-1.0, 0.4, 0.2})) {
    set.generator_version = "1.2.3";
    set.a = MeshIdentity::of(a);
    set.b = MeshIdentity::of(b);
    set.grid = make_grid("90/60");
    set.volume_grid = make_grid("90");
    job = GenerationJob::of("1.2.3 abc", generator->oracle_name(), generator->oracle_version(), a, b, set, std::vector{20, 0}, std::vector{3});
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

/// A test with a folder of its own.
class FolderTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("sixdof_") + info->test_suite_name() + "_" + info->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void flip_byte(const std::filesystem::path& file, std::size_t at) {
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  stream.seekg(static_cast<std::streamoff>(at));
  const int byte = stream.get();
  stream.seekp(static_cast<std::streamoff>(at));
  stream.put(static_cast<char>(byte ^ 0x10));
}

}  // namespace sixdof::test
