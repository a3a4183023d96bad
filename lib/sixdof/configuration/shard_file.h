#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/base/run_options.h>
#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/generation_job.h>

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

/// Returns the rows of a shard's bucket.
using ShardSource = std::function<Bucket(ShardNumber shard, BucketKey key)>;

/// Writes the set that the shards of a job make, whole or not at all: every row to its rotation and to the repeats of
/// it. The bytes are the same for every number of shards. Holds one bucket and one shard's part of it in memory.
/// @param set the job's description, with its grids
/// @param run a step is one bucket of one shard; one thread is used
/// @throws BadFile, Interrupted, and what `source` throws
void assemble_set(const std::filesystem::path& output, const GenerationJob& job, const SetDescription& set,
                  std::size_t shards, const ShardSource& source, const RunOptions& run = {});

/// Makes one set of all shards of a folder. Reads and checks every file of the name shard-*.h5 before anything is
/// written, and ignores other files.
/// @param run as of assemble_set()
/// @throws BadFile naming every shard that is missing, repeated, of another job or damaged; what assemble_set() throws
void merge_shards(const std::filesystem::path& folder, const std::filesystem::path& output, const RunOptions& run = {});

}  // namespace sixdof
