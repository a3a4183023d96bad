#include <sixdof/generation/distance_generator.h>

#include <algorithm>
#include <mutex>
#include <numeric>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>

namespace sixdof {
namespace {

std::vector<std::uint32_t> all_or(std::span<const std::uint32_t> rotations, const Grid& grid) {
  for (const std::uint32_t r : rotations) {
    if (r >= grid.rotations.size()) {
      throw BadArgument(fmt::format("rotation {}: the grid has {}", r, grid.rotations.size()));
    }
  }
  if (!rotations.empty()) return {rotations.begin(), rotations.end()};
  std::vector<std::uint32_t> all(grid.rotations.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

/// Indices of the buckets in the order in which a ray meets them: from far to near, or from small to large overlap.
std::vector<std::size_t> along_ray(const std::vector<BucketSummary>& summaries) {
  if (summaries.empty()) throw BadArgument("no bucket to generate");
  std::vector<std::size_t> order(summaries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto percent = [&](std::size_t k) { return summaries[k].key.percent; };
  const bool inwards_descends = summaries.front().key.kind == BucketKind::distance;
  std::ranges::sort(order, {}, [&](std::size_t k) { return inwards_descends ? -percent(k) : percent(k); });
  const auto repeated = std::ranges::adjacent_find(order, {}, percent);
  if (repeated != order.end()) {
    const BucketKey key = summaries[*repeated].key;
    throw BadArgument(fmt::format("{} {} %: asked for twice", to_string(key.kind), key.percent));
  }
  return order;
}

}  // namespace

Generated detail::sweep_rotations(const std::function<std::unique_ptr<RaySolver>()>& prepare, const Grid& grid,
                                  const std::vector<BucketSummary>& summaries, const RunOptions& run,
                                  std::span<const std::uint32_t> rotations) {
  const std::vector<std::size_t> order = along_ray(summaries);
  const std::vector<std::uint32_t> in_grid = all_or(rotations, grid);
  std::vector<Eigen::Vector4d> quaternions;
  for (const std::uint32_t r : in_grid) quaternions.push_back(grid.rotations[r]);
  const DistinctRotations distinct(quaternions);
  const std::size_t n_directions = grid.directions.size();

  Generated result;
  for (const BucketSummary& summary : summaries) {
    result.buckets.push_back({.summary = summary, .translations = std::vector<double>(in_grid.size() * n_directions)});
  }
  std::vector<double> targets;
  for (const std::size_t k : order) targets.push_back(summaries[k].target);

  const std::uint64_t of_rotation = n_directions * targets.size(), total = of_rotation * distinct.first.size();
  std::uint64_t done = 0;
  if (run.progress) run.progress(0, total);
  std::mutex mutex;  // for `done`, progress and the summaries
  parallel::PerThread<std::unique_ptr<RaySolver>> solvers(prepare);

  const auto solve_rotation = [&](std::size_t i) {
    const std::uint32_t r = distinct.first[i];
    RaySolver& solver = *solvers.local();
    solver.set_rotation(quaternions[r]);
    std::vector<double> translations(targets.size());
    std::vector<double> residuals(targets.size());
    std::vector<double> largest_residuals(targets.size());
    for (std::size_t u = 0; u < n_directions; ++u) {
      run.check_cancelled();
      try {
        solver.solve(grid.directions[u], targets, translations, residuals);
      } catch (const Error& e) {
        throw Error(fmt::format("rotation {}, direction {}: {}", in_grid[r], u, e.what()));
      }
      for (std::size_t k = 0; k < targets.size(); ++k) {
        result.buckets[order[k]].translations[r * n_directions + u] = translations[k];
        largest_residuals[k] = std::max(largest_residuals[k], residuals[k]);
      }
    }
    const std::scoped_lock lock(mutex);
    for (std::size_t k = 0; k < targets.size(); ++k) {
      double& largest = result.buckets[order[k]].summary.largest_residual;
      largest = std::max(largest, largest_residuals[k]);
    }
    done += of_rotation;
    if (run.progress) run.progress(done, total);
  };
  parallel::with_threads(run.threads, [&] { parallel::for_each(distinct.first.size(), solve_rotation); });

  for (Bucket& bucket : result.buckets) distinct.copy_to_repeats(bucket.translations, n_directions);
  for (const auto& solver : solvers) result.measurements += solver->measurements();
  return result;
}

Generated generate_distances(const DistanceGenerator& generator, const Mesh& a, const Mesh& b, const Grid& grid,
                             std::span<const double> percents, const RunOptions& run,
                             std::span<const std::uint32_t> rotations) {
  std::vector<BucketSummary> summaries;
  for (const double percent : percents) {
    BucketSummary summary = distance_bucket(a, percent);
    summary.oracle = generator.oracle_name();
    summary.oracle_version = generator.oracle_version();
    summaries.push_back(std::move(summary));
  }
  return detail::sweep_rotations([&] { return generator.prepare(a, b); }, grid, summaries, run, rotations);
}

}  // namespace sixdof
