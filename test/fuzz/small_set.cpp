#include "small_set.h"

#include <limits>
#include <span>
#include <vector>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/generation_job.h>
#include <sixdof/configuration/shard_file.h>

#include "small_meshes.h"

namespace sixdof::fuzz {
namespace {

struct SmallSet {
  Mesh a = tetrahedron(), b = tetrahedron(0.45);
  SetDescription description{.generator_version = "1.2.3",
                             .a = MeshIdentity::of(a),
                             .b = MeshIdentity::of(b),
                             .grid = make_grid("so3:2:3"),
                             .volume_grid = make_grid("so3:2:2")};
  GenerationJob job = GenerationJob::of("1.2.3 abc", "exact", "1", a, description, std::vector{5.0}, std::vector{1.0});

  /// Of a bucket, one of them unreachable.
  std::vector<double> translations(const BucketSummary& bucket) const {
    std::vector<double> values(description.grid_of(bucket.key.kind).configurations());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.3 + 0.7 * static_cast<double>(i);
    values.back() = std::numeric_limits<double>::quiet_NaN();
    return values;
  }
};

}  // namespace

std::filesystem::path write_small_set(const std::filesystem::path& folder) {
  const SmallSet small;
  const auto file = folder / "set.h5";
  ConfigurationSetWriter writer(file, small.description);
  for (BucketSummary bucket : small.job.buckets) {
    bucket.oracle = "exact";
    bucket.oracle_version = "1";
    writer.write(bucket, small.translations(bucket));
  }
  writer.commit();
  return file;
}

std::filesystem::path write_small_shard(const std::filesystem::path& folder) {
  const SmallSet small;
  const auto file = folder / "shard.h5";
  std::vector<Bucket> buckets;
  for (const BucketSummary& bucket : small.job.buckets) buckets.push_back({bucket, small.translations(bucket)});
  write_shard(file, small.job, small.description, {.number = 1, .count = 1}, buckets);
  return file;
}

}  // namespace sixdof::fuzz
