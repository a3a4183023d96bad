#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <sixdof/generation/distance_generator.h>
#include <sixdof/configuration/grid.h>

/// How evenly the work of making a set is spread over its configurations: whether some take so much longer than most
/// that they hold up a whole run.

namespace sixdof {

/// Counts numbers by size, to k_parts per doubling: quantiles of more numbers than one would keep.
class WorkHistogram {
 public:
  static constexpr std::uint64_t k_parts = 64;

  void add(std::uint64_t value) { ++counts_[bin(value)]; }
  void add(const WorkHistogram& other);
  std::uint64_t count() const;

  /// The value that `share` (0 .. 1) of all do not exceed, rounded down by less than 1 / k_parts of it; 0 if there are
  /// none.
  std::uint64_t quantile(double share) const;

 private:
  static std::size_t bin(std::uint64_t value);
  static std::uint64_t least_of(std::size_t bin);

  // Values below k_parts have bins of their own.
  std::array<std::uint64_t, (64 - 6 + 1) * k_parts> counts_{};
};

/// Rotations that make faces of box-like bodies tie, and others: of the distinct rotations of a grid all that turn a
/// coordinate axis onto a coordinate axis, and `others` of the rest, drawn by seed (all of them if there are fewer).
/// Indices into the grid, ascending.
struct ProfileRotations {
  ProfileRotations(const Grid& grid, std::size_t others, std::uint64_t seed);

  std::vector<std::uint32_t> indices;
  std::size_t aligned = 0;  ///< Those that turn an axis onto an axis.
};

/// One configuration, or with any `target` one ray.
struct ProfilePlace {
  std::uint32_t rotation = 0;
  std::uint32_t direction = 0;
  std::uint32_t target = 0;
};

struct WorkProfile {
  /// RaySolver::work() of every configuration that takes any: what is known to be unreachable without a look does not
  /// count.
  WorkHistogram work;
  std::uint64_t worst_work = 0;          ///< The largest of them,
  ProfilePlace worst;                    ///< and where.
  std::vector<std::uint64_t> reachable;  ///< Of each target.

  /// Processor times of rays with all their targets, in seconds.
  double median_ray_s = 0.0, p999_ray_s = 0.0;
  /// The longest, where rotations that seemed to hold it were measured several times and the least counts.
  double worst_ray_s = 0.0;
  ProfilePlace worst_ray;
  /// Seconds per unit of work: of a ray in the middle, and such that all but 1 in 1000 rays take less and more.
  double median_unit_s = 0.0, least_unit_s = 0.0, most_unit_s = 0.0;

  /// 0 if nothing takes any work.
  double worst_over_median() const {
    const std::uint64_t median = work.quantile(0.5);
    return median == 0 ? 0.0 : static_cast<double>(worst_work) / static_cast<double>(median);
  }
};

struct ProfileOptions {
  unsigned threads = 0;  ///< 0: as many as the machine has. Counts do not depend on it.
  /// Called now and then, one call at a time.
  std::function<void(std::uint64_t rotations_done, std::uint64_t rotations)> progress;
  std::function<bool()> cancelled;  ///< Asked before every ray: true ends the work with Interrupted.
};

/// Solves all directions of some of a grid's rotations, as a set's maker does, and keeps what they took.
/// @param prepare makes one solver per thread
/// @param targets in the solver's order
WorkProfile profile_work(const std::function<std::unique_ptr<RaySolver>()>& prepare, const Grid& grid,
                         std::span<const double> targets, std::span<const std::uint32_t> rotations,
                         const ProfileOptions& options = {});

}  // namespace sixdof
