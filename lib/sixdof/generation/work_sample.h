#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include <sixdof/generation/distance_generator.h>
#include <sixdof/configuration/grid.h>

/// What the making of a set costs, from a seeded sample of the rays it consists of.

namespace sixdof {

/// CPU seconds that the calling thread has had.
double thread_seconds();

/// Neighbouring directions under one rotation: what a solver meets in the real work.
struct RayRun {
  std::size_t rotation = 0;
  std::size_t first_direction = 0;
  std::size_t directions = 0;  ///< The run wraps around the end of the grid's list.
};

/// Runs drawn by seed, uniform over distinct rotations and directions, the same on every machine.
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

/// CPU seconds of the calling thread.
struct RunCost {
  double set_rotation_s = 0.0;
  double rays_s = 0.0;
  std::size_t rays = 0;
};

/// Solves one run. A ray before it, whose time does not count, warms the solver up as a neighbour would.
/// @param targets in the solver's order
/// @param most_s no further ray is begun once the run has taken this long
RunCost time_run(RaySolver& solver, const Grid& grid, const RayRun& run, std::span<const double> targets,
                 double most_s = std::numeric_limits<double>::infinity());

/// Means over a sample, in CPU seconds.
struct WorkCost {
  double set_rotation_s = 0.0;        ///< Per rotation.
  double ray_s = 0.0;                 ///< Per ray with all its targets.
  double ray_standard_error_s = 0.0;  ///< From the differences between runs; 0 for a single run.
  std::size_t rays = 0;

  /// Of all rays of `rotations` rotations.
  double total_s(std::size_t rotations, std::size_t directions) const {
    return static_cast<double>(rotations) * (set_rotation_s + static_cast<double>(directions) * ray_s);
  }
};

/// Samples runs until `seconds` of wall time are over, at least one ray.
/// @param cancelled true ends the sample with Interrupted
WorkCost sample_work(RaySolver& solver, const Grid& grid, std::span<const double> targets, double seconds,
                     std::uint64_t seed, const std::function<bool()>& cancelled = {});

}  // namespace sixdof
