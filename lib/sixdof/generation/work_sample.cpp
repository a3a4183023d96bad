#include <sixdof/generation/work_sample.h>

#include <ctime>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace sixdof {
namespace {

/// Processor time of the calling thread.
double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Standard error of the mean cost of a ray. Rays of one run are alike, so runs are the independent samples.
double standard_error(std::span<const RunCost> runs, double mean, std::size_t rays) {
  if (runs.size() < 2) return 0.0;
  double sum = 0.0;
  for (const RunCost& run : runs) {
    const double off = run.rays_s - mean * static_cast<double>(run.ray_s.size());
    sum += off * off;
  }
  const auto n = static_cast<double>(runs.size());
  return std::sqrt(sum * n / (n - 1.0)) / static_cast<double>(rays);
}

/// The smallest value that at least `fraction` of all do not exceed.
double quantile(std::vector<double>& values, double fraction) {
  const double rank = std::ceil(fraction * static_cast<double>(values.size()));
  const auto at = values.begin() + std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(rank) - 1);
  std::ranges::nth_element(values, at);
  return *at;
}

}  // namespace

RayRuns::RayRuns(const Grid& grid, std::uint64_t seed)
    : grid_(grid), rotations_(DistinctRotations(grid.rotations).first), random_(seed) {}

RayRun RayRuns::next() {
  // Not a standard distribution, whose numbers may differ between libraries. The bias of the modulo is negligible.
  const std::size_t rotation = rotations_[random_() % rotations_.size()];
  const std::size_t direction = random_() % grid_.directions.size();
  return {
      .rotation = rotation, .first_direction = direction, .directions = std::min(k_length, grid_.directions.size())};
}

RunCost time_run(RaySolver& solver, const Grid& grid, const RayRun& run, std::span<const double> targets,
                 double most_s) {
  std::vector<double> translations(targets.size()), residuals(targets.size());
  const std::size_t n = grid.directions.size();
  RunCost cost;
  const double start = thread_seconds();
  solver.set_rotation(grid.rotations[run.rotation]);
  cost.set_rotation_s = thread_seconds() - start;
  solver.solve(grid.directions[(run.first_direction + n - 1) % n], targets, translations, residuals);
  const double first = thread_seconds();
  double now = first;
  while (cost.ray_s.size() < run.directions && (cost.ray_s.empty() || now - start < most_s)) {
    solver.solve(grid.directions[(run.first_direction + cost.ray_s.size()) % n], targets, translations, residuals);
    const double before = now;
    now = thread_seconds();
    cost.ray_s.push_back(now - before);
    cost.unreachable +=
        static_cast<std::uint64_t>(std::ranges::count_if(translations, [](double s) { return std::isnan(s); }));
  }
  cost.rays_s = now - first;
  return cost;
}

WorkCost sample_work(RaySolver& solver, const Grid& grid, std::span<const double> targets, double seconds,
                     std::uint64_t seed, const RunOptions& run) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto left = [&] { return seconds - std::chrono::duration<double>(Clock::now() - start).count(); };
  RayRuns runs(grid, seed);
  std::vector<RunCost> costs;
  std::vector<double> rays;
  double rays_s = 0.0;
  WorkCost work;
  do {
    run.check_cancelled();
    const RayRun drawn = runs.next();
    RunCost cost = time_run(solver, grid, drawn, targets, left());
    work.set_rotation_s += cost.set_rotation_s;
    rays_s += cost.rays_s;
    work.unreachable += cost.unreachable;
    const auto greatest = std::ranges::max_element(cost.ray_s);
    if (*greatest > work.greatest_ray_s) {
      work.greatest_ray_s = *greatest;
      work.greatest_rotation = drawn.rotation;
      const auto offset = static_cast<std::size_t>(greatest - cost.ray_s.begin());
      work.greatest_direction = (drawn.first_direction + offset) % grid.directions.size();
    }
    rays.insert(rays.end(), cost.ray_s.begin(), cost.ray_s.end());
    costs.push_back(std::move(cost));
  } while (left() > 0.0);
  work.rays = rays.size();
  work.configurations = rays.size() * targets.size();
  work.set_rotation_s /= static_cast<double>(costs.size());
  work.ray_s = rays_s / static_cast<double>(work.rays);
  work.ray_standard_error_s = standard_error(costs, work.ray_s, work.rays);
  work.median_ray_s = quantile(rays, 0.5);
  work.p99_ray_s = quantile(rays, 0.99);
  return work;
}

}  // namespace sixdof
