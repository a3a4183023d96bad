#include <sixdof/configuration/distance_generator.h>

#include <algorithm>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/configuration/rotation_sweep.h>

namespace sixdof {

BucketSummary distance_bucket(const Mesh& a, int percent) {
  if (percent < 0 || percent > BucketKey::k_max_percent) {
    throw BadArgument(fmt::format("distance {} %: not in 0 .. {}", percent, BucketKey::k_max_percent));
  }
  const double diagonal = a.diagonal();
  BucketSummary bucket;
  bucket.key = {BucketKind::distance, percent};
  bucket.target = diagonal * static_cast<double>(percent) / 100.0;
  bucket.aim = percent == 0 ? k_contact_aim * diagonal : bucket.target;
  bucket.tolerance = k_distance_tolerance * diagonal;
  return bucket;
}

Generated generate_distances(const DistanceGenerator& generator, const Mesh& a, const Mesh& b, const Grid& grid,
                             std::span<const int> percents, const GenerateOptions& options) {
  Generated result;
  for (const int percent : percents) result.buckets.push_back({.summary = distance_bucket(a, percent), .travel = {}});
  // From far to near: a ray meets them in this order.
  detail::order_buckets(result.buckets, true, detail::rotations_asked(grid, options) * grid.directions.size());
  result.measurements = detail::sweep_rotations([&] { return generator.prepare(a, b); }, grid, result.buckets, options);
  for (GeneratedBucket& bucket : result.buckets) {
    bucket.summary.oracle = generator.oracle_name();
    bucket.summary.oracle_version = generator.oracle_version();
  }
  std::ranges::sort(result.buckets, {}, [&](const GeneratedBucket& bucket) {
    return std::ranges::find(percents, bucket.summary.key.percent) - percents.begin();
  });
  return result;
}

}  // namespace sixdof
