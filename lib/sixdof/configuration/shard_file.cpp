#include <sixdof/configuration/shard_file.h>

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hdf5.h>
#include <sixdof/configuration/set_fields.h>

namespace sixdof {
namespace {

constexpr const char* k_format = "sixdof-shard";
constexpr std::uint64_t k_format_version = 2;

/// Hash of everything; the summaries of the buckets contain the hashes of their values.
std::string hash_of(const GenerationJob& job, ShardNumber shard, const std::vector<BucketSummary>& buckets) {
  detail::FieldHash hash;
  hash.add(k_format);
  hash.add(k_format_version);
  hash.add(job.hash());
  hash.add(std::uint64_t{shard.number});
  hash.add(std::uint64_t{shard.count});
  for (const BucketSummary& bucket : buckets) hash.add(bucket);
  return hash.hex();
}

void write_identity(hdf5::File& file, const std::string& group, const GridIdentity& grid) {
  file.make_group(group);
  file.write_attribute(group, "grid", grid.spec);
  file.write_attribute(group, "content_hash", grid.hash);
}

GridIdentity read_identity(const hdf5::File& file, const std::string& group) {
  return {.spec = file.read_string(group, "grid"), .hash = file.read_string(group, "content_hash")};
}

void write_job(hdf5::File& file, const GenerationJob& job) {
  file.write_attribute("/", "job", job.hash());
  file.write_attribute("/", "program", job.program);
  file.write_attribute("/", "generator_version", job.generator_version);
  file.write_attribute("/", "oracle", job.oracle);
  file.write_attribute("/", "oracle_version", job.oracle_version);
  detail::write_identity(file, "mesh_a", job.a);
  detail::write_identity(file, "mesh_b", job.b);
  write_identity(file, "grid", job.grid);
  if (job.volume_grid) write_identity(file, "volume_grid", *job.volume_grid);
}

/// The job without its buckets.
GenerationJob read_job(const hdf5::File& file, const std::filesystem::path& path) {
  GenerationJob job{.program = file.read_string("/", "program"),
                    .generator_version = file.read_string("/", "generator_version"),
                    .oracle = file.read_string("/", "oracle"),
                    .oracle_version = file.read_string("/", "oracle_version"),
                    .a = detail::read_identity(file, path, "mesh_a"),
                    .b = detail::read_identity(file, path, "mesh_b"),
                    .grid = read_identity(file, "grid"),
                    .volume_grid = std::nullopt,
                    .buckets = {}};
  if (file.exists("volume_grid")) job.volume_grid = read_identity(file, "volume_grid");
  return job;
}

/// The fields of a summary that a job has.
BucketSummary job_fields(const BucketSummary& bucket) {
  return {.key = bucket.key, .nominal = bucket.nominal, .target = bucket.target, .tolerance = bucket.tolerance};
}

}  // namespace

std::string shard_file_name(ShardNumber shard) {
  return fmt::format("shard-{:04}-of-{:04}.h5", shard.number, shard.count);
}

void write_shard(const std::filesystem::path& path, const GenerationJob& job, const SetDescription& set,
                 ShardNumber shard, std::span<const Bucket> values) {
  AtomicFile atomic(path);
  {
    const hdf5::Session session;
    hdf5::File file = hdf5::File::create(atomic.temporary_path(), path);
    file.write_attribute("/", "format", std::string(k_format));
    file.write_attribute("/", "format_version", k_format_version);
    file.write_attribute("/", "shard", std::uint64_t{shard.number});
    file.write_attribute("/", "shards", std::uint64_t{shard.count});
    write_job(file, job);
    file.make_group("distance");
    file.make_group("volume");
    std::vector<BucketSummary> buckets;
    for (const auto& [summary, translations] : values) {
      const std::size_t directions = set.grid_of(summary.key.kind).directions.size();
      buckets.push_back(detail::write_bucket(file, summary, translations, directions));
    }
    file.write_attribute("/", "content_hash", hash_of(job, shard, buckets));
    file.close();
  }
  atomic.commit();
}

ShardFile::ShardFile(std::filesystem::path path) : path_(std::move(path)) {
  const std::string name = path_.string();
  const hdf5::Session session;
  const hdf5::File file = hdf5::File::open(path_);
  detail::check_format(file, path_, k_format, k_format_version, "a shard of a configuration set");
  number_ = {.number = file.read_count("/", "shard"), .count = file.read_count("/", "shards")};
  job_ = read_job(file, path_);
  for (const BucketKey key : detail::bucket_keys(file)) {
    buckets_.push_back(detail::read_summary(file, key));
    job_.buckets.push_back(job_fields(buckets_.back()));
  }
  if (hash_of(job_, number_, buckets_) != file.read_string("/", "content_hash")) {
    throw BadFile(name, "root", "content does not have the hash that was stored with it: damaged or edited");
  }
}

Bucket ShardFile::read(BucketKey key) const {
  const auto summary = std::ranges::find(buckets_, key, &BucketSummary::key);
  if (summary == buckets_.end()) throw BadFile(path_.string(), key.name(), "no such bucket");
  return {.summary = *summary, .translations = detail::read_translations(path_, *summary)};
}

void ShardFile::check_values() const {
  for (const BucketSummary& bucket : buckets_) static_cast<void>(read(bucket.key));
}

}  // namespace sixdof
