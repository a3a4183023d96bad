#include <sixdof/generation/rotation_sweep.h>

#include <algorithm>
#include <mutex>
#include <numeric>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>

namespace sixdof::detail {
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

/// Reports configurations to RunOptions::progress, one call at a time.
class Progress {
 public:
  Progress(const RunOptions& run, std::uint64_t configurations_per_rotation, std::size_t rotations)
      : run_(run), step_(configurations_per_rotation), total_(configurations_per_rotation * rotations) {
    if (run_.progress) run_.progress(0, total_);
  }
  void rotation_done() {
    if (!run_.progress) return;
    const std::scoped_lock lock(mutex_);
    done_ += step_;
    run_.progress(done_, total_);
  }

 private:
  const RunOptions& run_;
  std::mutex mutex_;
  const std::uint64_t step_, total_;
  std::uint64_t done_ = 0;
};

}  // namespace

Generated sweep_rotations(const std::function<std::unique_ptr<RaySolver>()>& prepare, const Grid& grid,
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

  std::vector<std::vector<double>> largest_residuals(distinct.first.size(), std::vector<double>(targets.size()));
  Progress progress(run, n_directions * targets.size(), distinct.first.size());
  parallel::PerThread<std::unique_ptr<RaySolver>> solvers(prepare);

  const auto solve_rotation = [&](std::size_t i) {
    const std::uint32_t r = distinct.first[i];
    RaySolver& solver = *solvers.local();
    solver.set_rotation(quaternions[r]);
    std::vector<double> translations(targets.size());
    std::vector<double> residuals(targets.size());
    for (std::size_t u = 0; u < n_directions; ++u) {
      run.check_cancelled();
      try {
        solver.solve(grid.directions[u], targets, translations, residuals);
      } catch (const Error& e) {
        throw Error(fmt::format("rotation {}, direction {}: {}", in_grid[r], u, e.what()));
      }
      for (std::size_t k = 0; k < targets.size(); ++k) {
        result.buckets[order[k]].translations[r * n_directions + u] = translations[k];
        largest_residuals[i][k] = std::max(largest_residuals[i][k], residuals[k]);
      }
    }
    progress.rotation_done();
  };
  parallel::with_threads(run.threads, [&] { parallel::for_each(distinct.first.size(), solve_rotation); });

  for (std::size_t k = 0; k < targets.size(); ++k) {
    Bucket& bucket = result.buckets[order[k]];
    distinct.copy_to_repeats(bucket.translations, n_directions);
    for (const auto& of_rotation : largest_residuals) {
      bucket.summary.largest_residual = std::max(bucket.summary.largest_residual, of_rotation[k]);
    }
  }
  for (const auto& solver : solvers) result.measurements += solver->measurements();
  return result;
}

}  // namespace sixdof::detail
