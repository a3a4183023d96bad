// Configuration sets and shards on disk. The first byte of an input picks: 's' a set as it is, 'S' a shard as it is,
// 'e' and 'E' a valid set or shard that the rest of the input damages (hdf5_edit.h).
//
// A file is refused by a BadFile that names it. What is read has the hash that it states: of a damaged file, it is what
// the whole file holds.
#include <cmath>
#include <cstring>
#include <limits>

#include <sixdof/base/error.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/generation_job.h>
#include <sixdof/configuration/shard_file.h>

#include "hdf5_edit.h"
#include "small_set.h"

namespace sixdof::fuzz {
namespace {

bool same_bits(std::span<const double> left, std::span<const double> right) {
  return left.size() == right.size() && std::memcmp(left.data(), right.data(), left.size_bytes()) == 0;
}

/// Writes what a set holds once more; the content hash, which the writer takes of what it writes, has to be the same.
void check_set(const std::filesystem::path& file) {
  const ConfigurationSet set(file);
  const auto copy = scratch_folder() / "copy.h5";
  {
    ConfigurationSetWriter writer(copy, set.description());
    for (const BucketSummary& bucket : set.buckets()) writer.write(bucket, set.read(bucket.key));
    writer.commit();
  }
  require(ConfigurationSet(copy).hash() == set.hash(), "a set has the hash that it states");
}

void check_damaged_set(const std::filesystem::path& file, const std::filesystem::path& whole) {
  static const ConfigurationSet original(whole);
  const ConfigurationSet set(file);
  require(set.hash() == original.hash(), "a damaged set that is read has the hash of the whole one");
  for (const BucketSummary& bucket : set.buckets()) {
    require(same_bits(set.read(bucket.key), original.read(bucket.key)),
            "a damaged set has the values of the whole one");
  }
}

void check_shard(const std::filesystem::path& file) {
  const ShardFile shard(file);
  shard.check_values();
  require(!shard.job().hash().empty(), "a shard has a job");
}

void check_damaged_shard(const std::filesystem::path& file, const std::filesystem::path& whole) {
  static const ShardFile original(whole);
  const ShardFile shard(file);
  shard.check_values();
  require(shard.job().hash() == original.job().hash(), "a damaged shard that is read has the job of the whole one");
  require(shard.number().number == original.number().number, "a damaged shard has the number of the whole one");
}

}  // namespace
}  // namespace sixdof::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sixdof;
  using namespace sixdof::fuzz;
  static const auto whole_set = write_small_set(scratch_folder());
  static const auto whole_shard = write_small_shard(scratch_folder());
  const auto file = scratch_folder() / "damaged.h5";
  Input input(data, size);
  const char what = static_cast<char>(input.byte());
  const bool is_shard = what == 'S' || what == 'E', is_damaged = what == 'e' || what == 'E';
  const auto& whole = is_shard ? whole_shard : whole_set;
  if (is_damaged) {
    std::filesystem::copy_file(whole, file, std::filesystem::copy_options::overwrite_existing);
    damage_hdf5(file, input);
  } else {
    write_bytes(file, input.rest());
  }
  try {
    if (is_shard) {
      is_damaged ? check_damaged_shard(file, whole) : check_shard(file);
    } else {
      is_damaged ? check_damaged_set(file, whole) : check_set(file);
    }
  } catch (const BadFile& e) {
    require(std::string_view(e.what()).starts_with(file.string() + ": "), "an error names the file");
  }
  return 0;
}
