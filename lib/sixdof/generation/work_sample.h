#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include <sixdof/base/run_options.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/generation/distance_generator.h>

/// The cost of making a set, estimated from a seeded sample of its rays. All times are processor times in seconds.
namespace sixdof {

/// Neighbouring directions under one rotation, as a solver meets them when it makes a set.
struct RayRun {
  std::size_t rotation = 0;
  std::size_t first_direction = 0;
  std::size_t directions = 0;  ///< The run wraps around at the end of the grid's directions.
};

/// Draws runs by seed, uniformly over distinct rotations and directions, the same on every machine.
class RayRuns {
 public:
  static constexpr std::size_t k_length = 8;

  /// `grid` outlives this object.
  RayRuns(const Grid& grid, std::uint64_t seed);
  RayRun next();

 private:
  const Grid& grid_;
  std::vector<std::uint32_t> rotations_;
  std::mt19937_64 random_;
};

/// Cost of one run.
struct RunCost {
  double set_rotation_s = 0.0;
  double rays_s = 0.0;            ///< Of all rays.
  std::vector<double> ray_s;      ///< Of each ray.
  std::uint64_t unreachable = 0;  ///< Configurations of these rays that have no translation.
};

/// Solves one run. The ray before it is solved first, untimed, so that the solver starts as after a neighbouring ray.
/// @param targets in the solver's order
/// @param most_s no further ray is begun after this time
RunCost time_run(RaySolver& solver, const Grid& grid, const RayRun& run, std::span<const double> targets,
                 double most_s = std::numeric_limits<double>::infinity());

/// Cost of a ray with all its targets, over a sample.
struct WorkCost {
  double set_rotation_s = 0.0;        ///< Mean per rotation.
  double ray_s = 0.0;                 ///< Mean per ray.
  double ray_standard_error_s = 0.0;  ///< Of `ray_s`, from the differences between runs; 0 for a single run.
  double median_ray_s = 0.0;
  double p99_ray_s = 0.0;
  double greatest_ray_s = 0.0;
  std::size_t greatest_rotation = 0;   ///< Where the greatest is, index into the grid's rotations
  std::size_t greatest_direction = 0;  ///< and its directions.
  std::size_t rays = 0;
  std::uint64_t configurations = 0;
  std::uint64_t unreachable = 0;  ///< Of these configurations.

  /// Estimate for all rays of `rotations` rotations.
  double total_s(std::size_t rotations, std::size_t directions) const {
    return static_cast<double>(rotations) * (set_rotation_s + static_cast<double>(directions) * ray_s);
  }
};

/// Draws and solves runs on this thread until `seconds` of wall time have passed, at least one ray.
/// @param run a step is one run of rays; progress is not reported
/// @throws Interrupted, and what the solver throws
WorkCost sample_work(RaySolver& solver, const Grid& grid, std::span<const double> targets, double seconds,
                     std::uint64_t seed, const RunOptions& run = {});

}  // namespace sixdof
