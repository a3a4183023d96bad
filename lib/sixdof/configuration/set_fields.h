#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <sixdof/base/hash.h>
#include <sixdof/base/hdf5.h>
#include <sixdof/configuration/configuration_set.h>

/// The pieces of which files of sets and of shards consist, and their content hashes. Internal: use configuration_set.h
/// or shard_file.h. All that touch a file do so inside a Session of the caller's.
namespace sixdof::detail {

/// Hash of a sequence of named fields; lengths are part of it, so that no two sequences run into one another.
class FieldHash {
 public:
  void add(std::string_view text);
  void add(std::span<const double> values);
  void add(double value) { add(std::span<const double>(&value, 1)); }
  void add(std::uint64_t value) { hash_.add_values(std::span<const std::uint64_t>(&value, 1)); }
  void add(const MeshIdentity& mesh);
  void add(const Grid& grid);
  void add(const BucketSummary& bucket);
  std::string hex() const { return hash_.hex(); }

 private:
  ContentHash hash_;
};

/// Content hash of a bucket's translation.
std::string hash_of(std::span<const double> values);
std::string hash_of(const Grid& grid);

std::uint64_t count_reachable(std::span<const double> translations);

/// Rows of rotations in one chunk of a matrix of translation: HDF5's chunk cache of 1 MiB holds one chunk.
std::size_t chunk_rows(std::size_t directions);

void write_identity(hdf5::File& file, const std::string& group, const MeshIdentity& mesh);
MeshIdentity read_identity(const hdf5::File& file, const std::filesystem::path& path, const std::string& group);

/// Attributes at `group` and, in it, /directions and /rotations.
void write_grid(hdf5::File& file, const std::string& group, const Grid& grid);
Grid read_grid(const hdf5::File& file, const std::filesystem::path& path, const std::string& group);

/// Attributes at the bucket's dataset.
void write_summary(hdf5::File& file, const BucketSummary& bucket);
BucketSummary read_summary(const hdf5::File& file, BucketKey key);

/// Every key that the format allows and the file has, distances before volumes, each by percentage.
std::vector<BucketKey> bucket_keys(const hdf5::File& file);

}  // namespace sixdof::detail
