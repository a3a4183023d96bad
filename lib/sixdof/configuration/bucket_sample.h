#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

namespace sixdof {

/// The configurations of one bucket that a benchmark asks, and what their answers have to be.
struct BucketSample {
  BucketKey key;
  /// In runs of up to k_run neighbours (one rotation, consecutive directions of the grid); the runs stand in random
  /// order, so that the first few of them are a fair sample too.
  std::vector<Pose> poses;
  double target = 0.0;             ///< Distance (length) or overlap volume (length^3) of every configuration.
  double tolerance = 0.0;       ///< How far the set's own truth may be from `target`, same unit.
  double diagonal = 0.0;        ///< Of A's box: the scale that tolerances of distances refer to.
  double volume = 0.0;          ///< Of A: the scale that tolerances of overlap volumes refer to.
  std::uint64_t reachable = 0;  ///< Configurations in the whole bucket.

  static constexpr std::size_t k_run = 32;
};

/// Reads a bucket and draws at least `most` of its configurations, in whole runs (all of them, in the set's own order,
/// if there are no more or `most` is 0). The same seed draws the same ones.
/// @throws BadFile, BadArgument as ConfigurationSet does
BucketSample sample_bucket(const ConfigurationSet& set, BucketKey key, const Mesh& a, const Mesh& b, std::size_t most,
                           std::uint64_t seed);

/// The first `count` poses in a random order that depends only on `seed` and `count`.
std::vector<Pose> shuffled(const std::vector<Pose>& poses, std::size_t count, std::uint64_t seed);

}  // namespace sixdof
