#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/distance_source.h>
#include <sixdof/geometry/mesh.h>

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
  bool measured = false;             ///< False for buckets whose kind the oracle does not measure.
  std::uint64_t sampled = 0;         ///< Configurations re-measured,
  std::uint64_t reachable = 0;       ///< of which the set has a travel for.
  double largest_residual = 0.0;     ///< Largest |measured - aim| of those, in the bucket's unit.
  std::uint64_t wrong_distance = 0;  ///< |measured - aim| above the bucket's tolerance.
  std::uint64_t earlier_hit = 0;     ///< The distance falls below the aim further out.
  std::uint64_t false_nan = 0;       ///< Said to be unreachable, but the distance falls below the aim.

  std::uint64_t failures() const { return wrong_distance + earlier_hit + false_nan; }
};

struct Verdict {
  std::vector<BucketVerdict> buckets;
  std::vector<std::string> problems;  ///< In words: of the set as a whole, and the first of each kind in each bucket.
  bool ok() const { return problems.empty(); }
};

/// Checks a set against its meshes. Of all configurations: targets, tolerances, that repeated rotations agree, and that
/// a nearer target is met further in on every ray. Of a seeded sample of every bucket: the distance, and by marching in
/// from outside with an oracle of the caller's choice (best another one than made the set) that no hit comes before.
/// The march steps by the distance above the aim, but at least k_march_step: a dip below the aim shorter than that may
/// be missed by one check.
/// @throws BadArgument if the set was made for other meshes; BadFile if a bucket is damaged; Interrupted
Verdict verify_set(const ConfigurationSet& set, const Mesh& a, const Mesh& b, const DistanceSource& oracle,
                   const VerifyOptions& options = {});

constexpr double k_march_step = 2e-3;  ///< In units of A's box diagonal.

}  // namespace sixdof
