#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Finds the translation at which targets are met, for one pair. One thread at a time. Results may use what was learnt since
/// set_rotation(), in the order of directions, but nothing from before: so work splits by rotation without changing a
/// bit.
class RaySolver {
 public:
  virtual ~RaySolver() = default;

  /// B's rotation (w, x, y, z) for the rays that follow.
  virtual void set_rotation(const Eigen::Vector4d& rotation) = 0;

  /// B's box centre translations along the ray from A's box centre in direction u (A's frame), inwards from far outside.
  /// @param targets distances in the meshes' unit, positive and descending
  /// @param translation one per target: the largest s >= 0 at which the surfaces are that far apart; NaN if they nowhere are
  /// @param residuals one per target: |measured - target| at that s, 0 where there is none
  /// @throws Error if a target is met neither exactly enough nor certainly not
  virtual void solve(const Eigen::Vector3d& direction, std::span<const double> targets, std::span<double> translations,
                     std::span<double> residuals) = 0;

  /// Distance measurements so far: what the work consists of.
  virtual std::uint64_t measurements() const = 0;

  /// What each target of the last solve() took, in counts of steps weighed by their usual time: for one pair about
  /// proportional to processor time, but the same on every machine and in every run. So single configurations can be
  /// compared, whose times a busy machine hides. What several targets share counts for the first of them.
  virtual std::span<const std::uint64_t> work() const = 0;
};

/// A way to find the configurations of the distance buckets.
class DistanceGenerator {
 public:
  virtual ~DistanceGenerator() = default;
  /// What defines the distances, for the set's attributes.
  virtual const std::string& oracle_name() const = 0;
  virtual const std::string& oracle_version() const = 0;
  /// May be called from several threads. Both meshes outlive the solver. @throws BadMesh
  virtual std::unique_ptr<RaySolver> prepare(const Mesh& a, const Mesh& b) const = 0;
};

struct GenerateOptions {
  unsigned threads = 0;  ///< 0: as many as the machine has.
  /// Called now and then, one call at a time, with the configurations found so far and in all.
  std::function<void(std::uint64_t done, std::uint64_t total)> progress;
  /// Asked before every ray, from every thread: true ends the work with Interrupted.
  std::function<bool()> cancelled;
  /// The rotations to solve, by index into the grid: a shard's part. None given: all of the grid.
  std::vector<std::uint32_t> rotations;
};

struct Generated {
  /// In the order of `percents`. Rows of rotations stand in the order in which they were asked for; those of a whole
  /// grid are as ConfigurationSetWriter::write() takes them.
  std::vector<Bucket> buckets;
  std::uint64_t measurements = 0;
};

/// Finds all configurations of distance buckets. Every rotation is solved once, however often the grid repeats it. The
/// result is the same bits for every number of threads and every split into shards.
/// @param percents of A's box diagonal, each once, 0 to BucketKey::k_max_percent
/// @throws BadArgument, Interrupted, and Error from the solver naming the configuration
Generated generate_distances(const DistanceGenerator& generator, const Mesh& a, const Mesh& b, const Grid& grid,
                             std::span<const int> percents, const GenerateOptions& options = {});

}  // namespace sixdof
