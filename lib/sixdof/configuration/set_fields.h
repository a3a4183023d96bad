#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/base/hash.h>
#include <sixdof/base/hdf5.h>
#include <sixdof/configuration/configuration_set.h>

/// What files of sets and of shards have in common, and their content hashes. Internal: use configuration_set.h or
/// shard_file.h. A caller of a function that takes an hdf5::File holds an hdf5::Session.
namespace sixdof::detail {

/// Hash of a sequence of fields. Lengths are part of it, so that different sequences never give the same input.
class FieldHash {
 public:
  void add(std::string_view text);
  void add(std::span<const double> values);
  void add(double value) { add(std::span<const double>(&value, 1)); }
  void add(std::uint64_t value) { hash_.add_values(std::span<const std::uint64_t>(&value, 1)); }
  void add(const MeshIdentity& mesh);
  void add(const Grid& grid);
  void add(const std::optional<Grid>& grid);
  void add(const std::vector<BucketSummary>& buckets);
  std::string hex() const { return hash_.hex(); }

 private:
  ContentHash hash_;
};

template <class... Fields>
std::string hash_of(const Fields&... fields) {
  FieldHash hash;
  (hash.add(fields), ...);
  return hash.hex();
}

/// Opens a file with these attributes `format` and `format_version`.
/// @param what the kind of file in words, for messages
/// @throws BadFile, for another version with the versions and how the file is made again
hdf5::File open_format(const std::filesystem::path& path, std::string_view format, std::uint64_t version,
                       std::string_view what);
/// @return the content hash that the file has
/// @throws BadFile if it is not `hash`
std::string check_content_hash(const hdf5::File& file, const std::filesystem::path& path, const std::string& hash);

void write_identity(hdf5::File& file, const std::string& group, const MeshIdentity& mesh);
MeshIdentity read_identity(const hdf5::File& file, const std::filesystem::path& path, const std::string& group);

/// Attributes at `group` and, in it, the datasets `directions` and `rotations`.
void write_grid(hdf5::File& file, const std::string& group, const Grid& grid);
Grid read_grid(const hdf5::File& file, const std::filesystem::path& path, const std::string& group);

/// Writes a bucket's dataset of [rotation][direction] with its summary as attributes.
/// @return the summary with the number of reachable configurations and the content hash
BucketSummary write_bucket(hdf5::File& file, BucketSummary summary, std::span<const double> translations,
                           std::size_t directions);
/// Of all buckets in the file, distances before volumes, each by percentage.
std::vector<BucketSummary> read_summaries(const hdf5::File& file, const std::filesystem::path& path);
/// Opens a session of its own. @throws BadFile if the values do not fit the summary
std::vector<double> read_translations(const std::filesystem::path& path, const BucketSummary& summary);

}  // namespace sixdof::detail
