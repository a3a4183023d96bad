#include <sixdof/generation/rotation_sweep.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>

namespace sixdof::detail {
namespace {

std::vector<Eigen::Vector4d> rotations_of(const Grid& grid, const GenerateOptions& options) {
  if (options.rotations.empty()) return grid.rotations;
  std::vector<Eigen::Vector4d> rotations;
  for (const std::uint32_t r : options.rotations) rotations.push_back(grid.rotations[r]);
  return rotations;
}

/// Counts rays and tells the user, one call at a time.
class Progress {
 public:
  Progress(const GenerateOptions& options, std::uint64_t configurations_per_rotation, std::size_t rotations)
      : options_(options), step_(configurations_per_rotation), total_(configurations_per_rotation * rotations) {
    if (options_.progress) options_.progress(0, total_);
  }
  void rotation_done() {
    if (!options_.progress) return;
    const std::scoped_lock lock(mutex_);
    done_ += step_;
    options_.progress(done_, total_);
  }

 private:
  const GenerateOptions& options_;
  std::mutex mutex_;
  const std::uint64_t step_, total_;
  std::uint64_t done_ = 0;
};

}  // namespace

std::size_t rotations_asked(const Grid& grid, const GenerateOptions& options) {
  for (const std::uint32_t r : options.rotations) {
    if (r >= grid.rotations.size()) {
      throw BadArgument(fmt::format("rotation {}: the grid has {}", r, grid.rotations.size()));
    }
  }
  return options.rotations.empty() ? grid.rotations.size() : options.rotations.size();
}

void order_buckets(std::vector<Bucket>& buckets, bool descending, std::size_t configurations) {
  if (buckets.empty()) throw BadArgument("no bucket to generate");
  const auto percent = [](const Bucket& bucket) { return bucket.summary.key.percent; };
  std::ranges::sort(buckets, {}, [&](const Bucket& b) { return descending ? -percent(b) : percent(b); });
  const auto repeated = std::ranges::adjacent_find(buckets, {}, percent);
  if (repeated != buckets.end()) {
    const std::string name = repeated->summary.key.name();
    throw BadArgument(
        fmt::format("{} {} %: asked for twice", name.substr(0, name.find('/')), repeated->summary.key.percent));
  }
  for (Bucket& bucket : buckets) bucket.translations.resize(configurations);
}

std::uint64_t sweep_rotations(const std::function<std::unique_ptr<RaySolver>()>& prepare, const Grid& grid,
                              std::vector<Bucket>& buckets, const GenerateOptions& options) {
  const std::size_t n_directions = grid.directions.size();
  const std::vector<Eigen::Vector4d> rotations = rotations_of(grid, options);
  const DistinctRotations distinct(rotations);
  std::vector<double> targets;
  for (const Bucket& bucket : buckets) targets.push_back(bucket.summary.target);

  std::vector<std::vector<double>> residuals(distinct.first.size(), std::vector<double>(targets.size()));
  Progress progress(options, n_directions * targets.size(), distinct.first.size());
  parallel::PerThread<std::unique_ptr<RaySolver>> solvers(prepare);

  const auto solve_rotation = [&](std::size_t i) {
    const std::uint32_t r = distinct.first[i];
    RaySolver& solver = *solvers.local();
    solver.set_rotation(rotations[r]);
    std::vector<double> translations(targets.size());
    std::vector<double> residual(targets.size());
    for (std::size_t u = 0; u < n_directions; ++u) {
      if (options.cancelled && options.cancelled()) throw Interrupted("interrupted");
      try {
        solver.solve(grid.directions[u], targets, translations, residual);
      } catch (const Error& e) {
        const std::uint32_t in_grid = options.rotations.empty() ? r : options.rotations[r];
        throw Error(fmt::format("rotation {}, direction {}: {}", in_grid, u, e.what()));
      }
      for (std::size_t k = 0; k < targets.size(); ++k) {
        buckets[k].translations[r * n_directions + u] = translations[k];
        residuals[i][k] = std::max(residuals[i][k], residual[k]);
      }
    }
    progress.rotation_done();
  };
  parallel::with_threads(options.threads, [&] { parallel::for_each(distinct.first.size(), solve_rotation); });

  for (std::size_t k = 0; k < buckets.size(); ++k) {
    distinct.copy_to_repeats(buckets[k].translations, n_directions);
    for (const auto& of_rotation : residuals) {
      buckets[k].summary.largest_residual = std::max(buckets[k].summary.largest_residual, of_rotation[k]);
    }
  }
  std::uint64_t measurements = 0;
  for (const auto& solver : solvers) measurements += solver->measurements();
  return measurements;
}

}  // namespace sixdof::detail
