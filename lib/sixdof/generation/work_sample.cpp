#include <sixdof/generation/work_sample.h>

#include <ctime>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <sixdof/base/error.h>
#include <sixdof/configuration/generation_job.h>

namespace sixdof {
namespace {

/// Standard error of the mean cost of a ray, where rays come in runs that are alike within.
double standard_error(std::span<const RunCost> runs, double mean, std::size_t rays) {
  if (runs.size() < 2) return 0.0;
  double sum = 0.0;
  for (const RunCost& run : runs) {
    const double off = run.rays_s - mean * static_cast<double>(run.rays);
    sum += off * off;
  }
  const auto n = static_cast<double>(runs.size());
  return std::sqrt(sum * n / (n - 1.0)) / static_cast<double>(rays);
}

}  // namespace

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

RayRuns::RayRuns(const Grid& grid, std::uint64_t seed)
    : grid_(grid), rotations_(DistinctRotations(grid.rotations).first), random_(seed) {}

RayRun RayRuns::next() {
  // Plain modulo: the same on every standard library; its bias is nothing.
  const std::size_t rotation = rotations_[random_() % rotations_.size()];
  const std::size_t direction = random_() % grid_.directions.size();
  return {
      .rotation = rotation, .first_direction = direction, .directions = std::min(k_length, grid_.directions.size())};
}

RunCost time_run(RaySolver& solver, const Grid& grid, const RayRun& run, std::span<const double> targets, double most_s) {
  std::vector<double> translations(targets.size()), residuals(targets.size());
  const std::size_t n = grid.directions.size();
  RunCost cost;
  const double start = thread_seconds();
  solver.set_rotation(grid.rotations[run.rotation]);
  cost.set_rotation_s = thread_seconds() - start;
  solver.solve(grid.directions[(run.first_direction + n - 1) % n], targets, translations, residuals);
  const double warm = thread_seconds();
  for (; cost.rays < run.directions && (cost.rays == 0 || thread_seconds() - start < most_s); ++cost.rays) {
    solver.solve(grid.directions[(run.first_direction + cost.rays) % n], targets, translations, residuals);
  }
  cost.rays_s = thread_seconds() - warm;
  return cost;
}

WorkCost sample_work(RaySolver& solver, const Grid& grid, std::span<const double> targets, double seconds,
                     std::uint64_t seed, const std::function<bool()>& cancelled) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto left = [&] { return seconds - std::chrono::duration<double>(Clock::now() - start).count(); };
  RayRuns runs(grid, seed);
  std::vector<RunCost> costs;
  double rays_s = 0.0;
  WorkCost mean;
  do {
    if (cancelled && cancelled()) throw Interrupted("interrupted");
    costs.push_back(time_run(solver, grid, runs.next(), targets, left()));
    mean.set_rotation_s += costs.back().set_rotation_s;
    rays_s += costs.back().rays_s;
    mean.rays += costs.back().rays;
  } while (left() > 0.0);
  mean.set_rotation_s /= static_cast<double>(costs.size());
  mean.ray_s = rays_s / static_cast<double>(mean.rays);
  mean.ray_standard_error_s = standard_error(costs, mean.ray_s, mean.rays);
  return mean;
}

}  // namespace sixdof
