#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <sixdof/base/run_options.h>
#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Finds the translations at which targets are met, for one pair of meshes. Used by one thread at a time. Results may
/// depend on the rays solved since set_rotation() and their order, but on nothing before.
class RaySolver {
 public:
  virtual ~RaySolver() = default;

  /// Sets B's rotation (w, x, y, z) for the rays that follow.
  virtual void set_rotation(const Eigen::Vector4d& rotation) = 0;

  /// Moves the centre of B's box along the ray from the centre of A's box in direction u (A's frame), inwards from far
  /// outside.
  /// @param targets distances in the meshes' length unit, positive and descending (of volume_solvers():
  /// volumes, ascending)
  /// @param translations one per target: the largest s >= 0 at which it is met, NaN if there is none
  /// @param residuals one per target: |measured - target| at that s, 0 if there is none
  /// @throws Error if a target is passed without being met within its tolerance
  virtual void solve(const Eigen::Vector3d& direction, std::span<const double> targets, std::span<double> translations,
                     std::span<double> residuals) = 0;

  /// Number of distances or volumes measured so far.
  virtual std::uint64_t measurements() const = 0;
};

/// A method that finds the configurations of distance buckets.
class DistanceGenerator {
 public:
  virtual ~DistanceGenerator() = default;
  /// The method that measures distances, for the attributes of the set.
  virtual const std::string& oracle_name() const = 0;
  virtual const std::string& oracle_version() const = 0;
  /// May be called from several threads. Both meshes outlive the solver. @throws BadMesh
  virtual std::unique_ptr<RaySolver> prepare(const Mesh& a, const Mesh& b) const = 0;
};

struct Generated {
  /// In the order of the percentages asked for. The rows of a bucket are in the order of the rotations asked for; those
  /// of a whole grid are as ConfigurationSetWriter::write() takes them.
  std::vector<Bucket> buckets;
  std::uint64_t measurements = 0;
};

/// Finds all configurations of distance buckets. Every distinct rotation is solved once. The result has the same bits
/// for every number of threads and every split into shards.
/// @param percents of the diagonal of A's box, each once, 0 to BucketKey::k_max_percent
/// @param run a step is one configuration that is solved
/// @param rotations indices into the grid, a shard's part; empty: all rotations of the grid
/// @throws BadArgument, Interrupted, and Error from the solver naming the configuration
Generated generate_distances(const DistanceGenerator& generator, const Mesh& a, const Mesh& b, const Grid& grid,
                             std::span<const int> percents, const RunOptions& run = {},
                             std::span<const std::uint32_t> rotations = {});

namespace detail {

/// The loop over rotations and directions that fills buckets of either kind: solves every distinct rotation once, on
/// several threads, and copies its rows to its repeats. The result has the same bits for every number of threads.
/// @param prepare makes the solver of a thread
/// @param summaries of buckets of one kind; their largest residuals are filled in
/// @param rotations indices into the grid; empty: all rotations of the grid
/// @return the buckets in the order of `summaries`
/// @throws BadArgument if there is no bucket, one is asked for twice, or the grid does not have one of the rotations;
/// Interrupted; Error from the solver naming the configuration
Generated sweep_rotations(const std::function<std::unique_ptr<RaySolver>()>& prepare, const Grid& grid,
                          const std::vector<BucketSummary>& summaries, const RunOptions& run,
                          std::span<const std::uint32_t> rotations);

}  // namespace detail
}  // namespace sixdof
