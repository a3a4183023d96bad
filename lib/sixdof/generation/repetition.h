#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <sixdof/base/run_options.h>
#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/geometry/mesh.h>

/// Whether this build still makes a set as it is, bit for bit. verify_set() asks whether a set is right; this asks
/// whether it can be made again.

namespace sixdof {

/// Which rotations of a set are made again: all directions and all buckets of each.
struct RepetitionSample {
  std::size_t rotations = 2;  ///< Distinct ones, drawn from each grid of the set; 0: all.
  std::uint64_t seed = 1;
};

/// A translation that this build computes differently, in the meshes' length unit.
struct ChangedValue {
  std::uint32_t rotation = 0, direction = 0;  ///< Indices into the bucket's grid.
  double stored = 0.0, made = 0.0;
};

struct BucketRepetition {
  BucketKey key;
  std::uint64_t values = 0;   ///< Made again.
  std::uint64_t changed = 0;  ///< Those whose bits differ. All NaNs are equal.
  ChangedValue largest;       ///< Of those, the one that changed most; reachable or not counts more than any value.
};

struct Repetition {
  std::vector<BucketRepetition> buckets;
  /// Differences of what is not a translation, in words: grids, targets, tolerances, methods.
  std::vector<std::string> differences;

  std::uint64_t values() const;
  std::uint64_t changed() const;
  bool same() const { return differences.empty() && changed() == 0; }
};

/// Makes a sample of a set again and compares bits.
/// @param generator the one that the set names, see distance_oracle()
/// @param run a step is one configuration that is solved
/// @throws BadArgument if the set was made for other meshes, or by another method than `generator`; BadFile if a bucket
/// is damaged; what generate_distances() and generate_volumes() throw
Repetition make_again(const ConfigurationSet& set, const Mesh& a, const Mesh& b, const DistanceGenerator& generator,
                      const RepetitionSample& sample = {}, const RunOptions& run = {});

/// The name of the method that measured distances and contact; empty if the set has neither.
std::string distance_oracle(const ConfigurationSet& set);

}  // namespace sixdof
