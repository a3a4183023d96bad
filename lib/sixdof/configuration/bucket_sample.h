#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

namespace sixdof {

/// Configurations drawn from one bucket, with what their answers are compared with.
struct BucketSample {
  BucketKey key;
  /// In runs of up to k_run neighbours (one rotation, consecutive directions of the grid). The runs stand in random
  /// order, so every prefix of whole runs is a random sample too.
  std::vector<Pose> poses;
  double target = 0.0;          ///< Distance (length) or overlap volume (length^3) of every configuration.
  double tolerance = 0.0;       ///< Upper bound of the set's own |measured - target|, same unit.
  double diagonal = 0.0;        ///< Of A's box: the scale of tolerances of distances.
  std::uint64_t reachable = 0;  ///< Reachable configurations of the whole bucket.

  static constexpr std::size_t k_run = 32;
};

/// Reads a bucket and draws at least `count` of its reachable configurations, in whole runs. Draws all of them, in the
/// order of the set, if there are no more or `count` is 0. The same seed draws the same ones.
/// @throws BadFile, BadArgument as ConfigurationSet does
BucketSample sample_bucket(const ConfigurationSet& set, BucketKey key, const Mesh& a, const Mesh& b, std::size_t count,
                           std::uint64_t seed);

/// The first `count` poses in a random order that depends on `seed` and `count` alone.
std::vector<Pose> shuffled(const std::vector<Pose>& poses, std::size_t count, std::uint64_t seed);

}  // namespace sixdof
