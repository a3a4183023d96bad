#include <sixdof/configuration/shard_file.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/base/hdf5.h>
#include <sixdof/configuration/configuration_set.h>

#include "folder_test.h"
#include "foreign_hdf5.h"
#include "shard_job.h"

namespace sixdof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr ShardNumber k_middle{.number = 2, .count = 3};

class ShardFileTest : public test::FolderTest {};

TEST_F(ShardFileTest, ComesBackBitForBit) {
  const test::SmallJob small;
  const Generated values = small.compute(k_middle);
  const auto path = folder_ / shard_file_name(k_middle);
  EXPECT_EQ(path.filename(), "shard-0002-of-0003.h5");
  write_shard(path, small.job, small.set, k_middle, values.buckets);
  const ShardFile shard(path);
  EXPECT_EQ(shard.number(), k_middle);
  EXPECT_EQ(shard.job().difference(small.job), "");
  EXPECT_EQ(shard.job().hash(), small.job.hash());
  EXPECT_NO_THROW(shard.check_values());
  ASSERT_EQ(values.buckets.size(), 3u);
  for (const Bucket& expected : values.buckets) {
    const Bucket bucket = shard.read(expected.summary.key);
    EXPECT_TRUE(test::same_bits(bucket.translations, expected.translations));
    EXPECT_EQ(bucket.summary.largest_residual, expected.summary.largest_residual);
    EXPECT_EQ(bucket.summary.oracle, expected.summary.oracle);
  }
}

TEST_F(ShardFileTest, ThreadsDoNotChangeAByteOfIt) {
  const test::SmallJob small;
  for (const unsigned threads : {1u, 2u}) {
    write_shard(folder_ / std::to_string(threads), small.job, small.set, k_middle,
                small.compute(k_middle, threads).buckets);
  }
  EXPECT_EQ(test::bytes_of(folder_ / "1"), test::bytes_of(folder_ / "2"));
}

/// A file with a damaged byte or without its end is refused, or reads the same where HDF5 does not use the byte.
TEST_F(ShardFileTest, DamageIsFound) {
  const test::SmallJob small;
  const auto valid = folder_ / "valid.h5";
  const auto damaged = folder_ / "damaged.h5";
  write_shard(valid, small.job, small.set, k_middle, small.compute(k_middle).buckets);
  const std::string bytes = test::bytes_of(valid);
  const ShardFile expected(valid);
  std::size_t refused = 0, tried = 0;
  constexpr std::size_t k_step = 61;  // Not a multiple of the size of any structure.
  for (std::size_t at = 0; at < bytes.size(); at += k_step, ++tried) {
    std::filesystem::copy_file(valid, damaged, std::filesystem::copy_options::overwrite_existing);
    test::flip_byte(damaged, at);
    try {
      const ShardFile shard(damaged);
      shard.check_values();
      EXPECT_EQ(shard.job().hash(), expected.job().hash()) << at;
      EXPECT_EQ(shard.number(), expected.number()) << at;
    } catch (const BadFile& e) {
      EXPECT_THAT(e.what(), HasSubstr("damaged.h5")) << at;
      ++refused;
    }
  }
  EXPECT_GT(refused, tried / 2);
  for (const double part : {0.0, 0.3, 0.999}) {
    std::filesystem::copy_file(valid, damaged, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(damaged, static_cast<std::uintmax_t>(part * static_cast<double>(bytes.size())));
    EXPECT_THROW(ShardFile(damaged).check_values(), BadFile) << part;
  }
}

TEST_F(ShardFileTest, RefusesOtherFiles) {
  const auto path = folder_ / "shard-0001-of-0001.h5";
  EXPECT_THAT([&] { ShardFile shard(path); }, ThrowsMessage<BadFile>(HasSubstr("no such file")));
  std::ofstream(path) << "text";
  EXPECT_THAT([&] { ShardFile shard(path); }, ThrowsMessage<BadFile>(HasSubstr("not a readable HDF5 file")));
  const SetDescription set = test::SmallJob().set;
  ConfigurationSetWriter(path, set).commit();
  EXPECT_THAT([&] { ShardFile shard(path); }, ThrowsMessage<BadFile>(HasSubstr("is not a shard")));
  test::write_hdf5(path, [](hdf5::File& file) {
    file.write_attribute("/", "format", std::string("sixdof-shard"));
    file.write_attribute("/", "format_version", std::uint64_t{1});
  });
  EXPECT_THAT([&] { ShardFile shard(path); },
              ThrowsMessage<BadFile>(HasSubstr("has format version 1, but this build reads version 2")));
}

}  // namespace
}  // namespace sixdof
