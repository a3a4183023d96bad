#include <sixdof/generation/distance_generator.h>

#include <algorithm>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/generation/rotation_sweep.h>

namespace sixdof {

Generated generate_distances(const DistanceGenerator& generator, const Mesh& a, const Mesh& b, const Grid& grid,
                             std::span<const int> percents, const GenerateOptions& options) {
  Generated result;
  for (const int percent : percents) result.buckets.push_back({.summary = distance_bucket(a, percent), .translations = {}});
  // From far to near: a ray meets them in this order.
  detail::order_buckets(result.buckets, true, detail::rotations_asked(grid, options) * grid.directions.size());
  result.measurements = detail::sweep_rotations([&] { return generator.prepare(a, b); }, grid, result.buckets, options);
  for (Bucket& bucket : result.buckets) {
    bucket.summary.oracle = generator.oracle_name();
    bucket.summary.oracle_version = generator.oracle_version();
  }
  std::ranges::sort(result.buckets, {}, [&](const Bucket& bucket) {
    return std::ranges::find(percents, bucket.summary.key.percent) - percents.begin();
  });
  return result;
}

}  // namespace sixdof
