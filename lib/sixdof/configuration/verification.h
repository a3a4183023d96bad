#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/query/algorithm.h>

namespace sixdof {

struct VerifyOptions {
  std::size_t sample = 50;  ///< Configurations re-measured per bucket (with repetition; all are checked for order).
  std::uint64_t seed = 1;
  std::function<void(std::uint64_t done, std::uint64_t total)> progress;  ///< Re-measured configurations.
  std::function<bool()> cancelled;                                        ///< True ends the work with Interrupted.
};

/// What was found in one bucket.
struct BucketVerdict {
  BucketSummary summary;
  std::string oracle;             ///< What measured.
  double scale = 0.0;             ///< Unit of the tolerance: A's box diagonal or A's volume.
  double tolerance = 0.0;         ///< Largest |measured - target| allowed. Same unit as `scale`.
  std::uint64_t sampled = 0;      ///< Configurations re-measured,
  std::uint64_t reachable = 0;    ///< of which the set has a translation for.
  double largest_residual = 0.0;  ///< Largest |measured - target| of those, in the bucket's unit.
  std::uint64_t wrong_value = 0;  ///< |measured - target| above the bucket's tolerance.
  std::uint64_t earlier_hit = 0;  ///< The target is passed further out.
  std::uint64_t false_nan = 0;    ///< Said to be unreachable, but the target is passed.

  std::uint64_t failures() const { return wrong_value + earlier_hit + false_nan; }
};

struct Verdict {
  std::vector<BucketVerdict> buckets;
  std::vector<std::string> problems;  ///< In words: of the set as a whole, and the first of each kind in each bucket.
  bool ok() const { return problems.empty(); }
};

/// Checks a set against its meshes. Of all configurations: targets, tolerances, that repeated rotations agree, and that
/// a target nearer to full overlap is met further in on every ray. Of a seeded sample of every bucket: the distance or
/// volume, and by marching in from outside that no hit comes before.
///
/// Distances are measured with an oracle of the caller's choice (best another one than made the set); so is volume
/// bucket 0, which is contact. Other volumes are measured with overlap_volume_by_columns(), which shares nothing with
/// the oracle that makes sets and takes a fraction of a second at 100,000 triangles; the march uses that oracle itself.
///
/// The march steps by the least way in which the target can be met, but at least k_march_step: passing the target for less
/// than that may be missed by one check.
/// @throws BadArgument if the set was made for other meshes; BadFile if a bucket is damaged; BadMesh if it has volumes
/// of meshes that are no solids; Interrupted
Verdict verify_set(const ConfigurationSet& set, const Mesh& a, const Mesh& b, const Algorithm& oracle,
                   const VerifyOptions& options = {});

constexpr double k_march_step = 2e-3;  ///< In units of A's box diagonal.

}  // namespace sixdof
