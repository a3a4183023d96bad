#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <sixdof/base/run_options.h>
#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/query/algorithm.h>

namespace sixdof {

/// Which configurations verify_set() measures again.
struct VerificationSample {
  std::size_t size = 50;   ///< Configurations per bucket, drawn with repetition.
  std::uint64_t seed = 1;  ///< Of the draw.
};

/// Results of one bucket.
struct BucketVerdict {
  BucketSummary summary;          ///< As the set has it.
  std::string oracle;             ///< The method that measured.
  double scale = 0.0;             ///< Diagonal of A's box (distances) or A's volume (volumes).
  double tolerance = 0.0;         ///< Upper bound of |measured - target|, in the unit of `scale`.
  std::uint64_t sampled = 0;      ///< Configurations measured again, reachable or not.
  std::uint64_t reachable = 0;    ///< Those for which the set has a translation.
  double largest_residual = 0.0;  ///< Largest |measured - target| of those, in the unit of `scale`.
  std::uint64_t wrong_value = 0;  ///< |measured - target| is above `tolerance`.
  std::uint64_t earlier_hit = 0;  ///< The target is passed at a greater translation.
  std::uint64_t false_nan = 0;    ///< Unreachable in the set, but the target is passed.
};

/// Answer of verify_set().
struct Verdict {
  std::vector<BucketVerdict> buckets;  ///< In the order of ConfigurationSet::buckets().
  /// In words: problems of the set as a whole, and the first of each kind in each bucket.
  std::vector<std::string> problems;
  /// Whether the set has no problem.
  bool ok() const { return problems.empty(); }
};

/// Checks a set against its meshes. For all configurations: targets, tolerances, that repeated rotations have equal
/// values, and that on every ray a smaller distance or larger volume is met at a smaller translation. For a seeded
/// sample of every bucket: the distance or volume, and by marching in from outside that the target is not met before.
///
/// Distances are measured with an oracle of the caller's choice, best another one than made the set; so is volume
/// bucket 0, which is contact. Other volumes are measured with overlap_volume_by_columns(), which shares no code with
/// the oracle that makes sets. The march for a volume uses that oracle itself, since columns are slow; columns then
/// measure where the march found the target nearest, and at two random translations outside of the hit.
///
/// The march steps by the greatest displacement within which the target cannot be met, but at least by k_march_step:
/// a target that is passed and lost again within less may go unnoticed in one check.
/// @param run a step is one configuration measured again; one thread is used
/// @throws BadArgument if the set was made for other meshes; BadFile if a bucket is damaged; BadMesh if the set has
/// volumes and a mesh is not a solid; Interrupted
Verdict verify_set(const ConfigurationSet& set, const Mesh& a, const Mesh& b, const Algorithm& oracle,
                   const VerificationSample& sample = {}, const RunOptions& run = {});

constexpr double k_march_step = 2e-3;  ///< In units of the diagonal of A's box.

}  // namespace sixdof
