#include <sixdof/configuration/shard_file.h>

#include <sys/resource.h>

#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/configuration/configuration_set.h>

#include "folder_test.h"
#include "shard_job.h"

namespace sixdof {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class ShardMerge : public test::FolderTest {
 protected:
  std::filesystem::path part(std::size_t number) const {
    return folder_ / shard_file_name({.number = number, .count = k_count});
  }
  void expect_refused(const auto& matcher) const {
    EXPECT_THAT([&] { merge_shards(folder_, folder_ / "set.h5"); }, ThrowsMessage<BadFile>(matcher));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "set.h5"));
  }

  static constexpr std::size_t k_count = 4;
  const test::SmallJob small_;
};

/// The file is the same for every number of shards and has the values that the generators give on the whole grid.
TEST_F(ShardMerge, AnyNumberOfShardsGivesTheSameFile) {
  std::string first;
  for (const std::size_t count : {1u, 4u, 7u}) {
    const auto folder = folder_ / std::to_string(count);
    std::filesystem::create_directory(folder);
    small_.write(folder, count);
    merge_shards(folder, folder_ / "set.h5");
    const std::string bytes = test::bytes_of(folder_ / "set.h5");
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first) << count;
  }
  const ConfigurationSet set(folder_ / "set.h5");
  const Generated whole = generate_distances(*small_.generator, small_.a, small_.b, small_.set.grid,
                                             std::vector{20.0, 0.0}, {.threads = 2});
  for (const Bucket& bucket : whole.buckets) {
    const std::vector<double> translations = set.read(bucket.summary.key);
    EXPECT_TRUE(test::same_bits(translations, bucket.translations));
    EXPECT_EQ(set.summary(bucket.summary.key).largest_residual, bucket.summary.largest_residual);
  }
  EXPECT_EQ(set.read({BucketKind::volume, 3}).size(), small_.set.volume_grid->configurations());
  EXPECT_EQ(set.grid(BucketKind::volume).rotations, small_.set.volume_grid->rotations);
}

TEST_F(ShardMerge, NamesEveryShardThatIsMissingRepeatedForeignOrDamaged) {
  small_.write(folder_, k_count);
  std::filesystem::remove(part(1));
  test::flip_byte(part(2), std::filesystem::file_size(part(2)) / 2);
  std::filesystem::copy_file(part(3), folder_ / "shard-0003-copy.h5");
  const test::SmallJob other(7);
  write_shard(folder_ / "shard-stray.h5", other.job, other.set, {.number = 1, .count = k_count},
              other.compute({.number = 1, .count = k_count}).buckets);
  write_shard(folder_ / "shard-split.h5", small_.job, small_.set, {.number = 1, .count = 5},
              small_.compute({.number = 1, .count = 5}).buckets);
  std::ofstream(folder_ / "notes.txt") << "is ignored";
  expect_refused(AllOf(HasSubstr("shard-0001-of-0004.h5: missing"), HasSubstr("shard-0002-of-0004.h5: "),
                       HasSubstr("is shard 3 again"), HasSubstr("shard-stray.h5: of another job"),
                       HasSubstr("mesh A is lump"), HasSubstr("shard-split.h5: is shard 1 of 5")));
}

TEST_F(ShardMerge, RefusesAShardUnderTheNameOfAnother) {
  small_.write(folder_, k_count);
  std::filesystem::copy_file(part(3), part(4), std::filesystem::copy_options::overwrite_existing);
  expect_refused(AllOf(HasSubstr("is shard 3 again"), HasSubstr("shard 4 is missing")));
}

TEST_F(ShardMerge, RefusesAFolderWithoutShards) {
  expect_refused(HasSubstr("no valid shard"));
  EXPECT_THAT([&] { merge_shards(folder_ / "nowhere", folder_ / "set.h5"); },
              ThrowsMessage<BadFile>(HasSubstr("is not a directory")));
}

TEST_F(ShardMerge, ReportsProgressAndStopsWhenAsked) {
  small_.write(folder_, 2);
  std::uint64_t last = 0, total = 0;
  const auto progress = [&](std::uint64_t done, std::uint64_t all) {
    EXPECT_EQ(done, last + 1);
    last = done;
    total = all;
  };
  merge_shards(folder_, folder_ / "set.h5", {.progress = progress, .cancelled = nullptr});
  EXPECT_EQ(last, total);
  EXPECT_EQ(total, 2u * 3u);
  std::filesystem::remove(folder_ / "set.h5");
  int asked = 0;
  EXPECT_THROW(
      merge_shards(folder_, folder_ / "set.h5", {.progress = nullptr, .cancelled = [&] { return ++asked > 4; }}),
      Interrupted);
  // Only the two shards are left: no set, no temporary file.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 2);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // Sanitizers hold freed memory and shadow memory.
/// Largest resident memory of the process so far, in bytes.
std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

TEST_F(ShardMerge, HoldsOneBucketInMemoryAndNotTheSet) {
  SetDescription set = small_.set;
  set.grid = make_grid("30");
  set.volume_grid.reset();
  std::vector<double> percents(BucketKey::k_max_percent + 1);
  std::iota(percents.begin(), percents.end(), 0.0);
  const auto job = GenerationJob::of("", "raycast", "1", small_.a, set, percents, {});
  const DistinctRotations distinct(set.grid.rotations);
  const auto rows = [&](ShardNumber shard, BucketKey key) {
    Bucket bucket;
    bucket.summary.key = key;
    bucket.translations.assign(rotations_of(shard, distinct).size() * set.grid.directions.size(), 1.0 + key.percent);
    return bucket;
  };
  const std::size_t bucket_bytes = set.grid.configurations() * sizeof(double);
  const std::size_t before = peak_memory();
  assemble_set(folder_ / "set.h5", job, set, 64, rows);
  // A bucket, its compressed chunks and HDF5's own memory; the set has 101 buckets.
  EXPECT_LT(peak_memory() - before, 30 * bucket_bytes);
}
#endif

TEST_F(ShardMerge, RefusesRowsOfTheWrongNumber) {
  const auto short_rows = [&](ShardNumber shard, BucketKey key) {
    const Generated values = small_.compute(shard);
    Bucket bucket = *std::ranges::find(values.buckets, key, [](const auto& b) { return b.summary.key; });
    bucket.translations.pop_back();
    return bucket;
  };
  EXPECT_THAT([&] { assemble_set(folder_ / "set.h5", small_.job, small_.set, 2, short_rows); },
              ThrowsMessage<BadArgument>(HasSubstr("shard 1 of 2, distance/00")));
}

}  // namespace
}  // namespace sixdof
