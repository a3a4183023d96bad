#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/generation_job.h>

namespace sixdof {

/// "shard-0007-of-0064.h5": sorts by number.
std::string shard_file_name(ShardNumber shard);

/// Writes a shard, whole or not at all: the job in full, the shard's number, and per bucket the rows of its distinct
/// rotations. The same input gives the same bytes.
/// @param set the job's, with its grids
/// @throws BadFile
void write_shard(const std::filesystem::path& path, const GenerationJob& job, const SetDescription& set,
                 ShardNumber shard, std::span<const Bucket> values);

/// A shard on disk. Opening reads all but the values and checks it against its content hash.
class ShardFile {
 public:
  /// @throws BadFile if the file is no shard, of another version, truncated or damaged.
  explicit ShardFile(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  const GenerationJob& job() const { return job_; }
  ShardNumber number() const { return number_; }

  /// The summary and rows [distinct rotation of the shard][direction] of one bucket.
  /// @throws BadFile if the values do not have the hash that was stored with them
  Bucket read(BucketKey key) const;

  /// Reads all values. @throws BadFile
  void check_values() const;

 private:
  std::filesystem::path path_;
  GenerationJob job_;
  ShardNumber number_;
  std::vector<BucketSummary> buckets_;
};

}  // namespace sixdof
