#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/generation_job.h>
#include <sixdof/configuration/set_description.h>

namespace sixdof {

/// "shard-0007-of-0064.h5": sorts by number.
std::string shard_file_name(ShardNumber shard);

/// Writes a shard, whole or not at all: the job, the shard's number, and for each bucket the rows of the shard's
/// distinct rotations. The same input gives the same bytes.
/// @param set the job's description, with its grids
/// @throws BadFile
void write_shard(const std::filesystem::path& path, const GenerationJob& job, const SetDescription& set,
                 ShardNumber shard, std::span<const Bucket> values);

/// A shard on disk. Opening reads everything but the values and checks it against its content hash.
class ShardFile {
 public:
  /// @throws BadFile if the file is not a shard, is of another format version, truncated or damaged.
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
