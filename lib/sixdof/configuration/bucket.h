#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/geometry/mesh.h>

/// A bucket: the configurations of a set that share one distance or one overlap volume.

namespace sixdof {

/// What a bucket holds fixed: the distance (percent of A's box diagonal) or the overlap (percent of A's volume).
enum class BucketKind {
  distance,
  volume
};

std::string to_string(BucketKind kind);

struct BucketKey {
  BucketKind kind = BucketKind::distance;
  int percent = 0;

  auto operator<=>(const BucketKey&) const = default;

  /// Its dataset, and its part of a benchmark's name with ':' for '/': "distance/05", "volume/10".
  std::string name() const;
  /// The inverse of name(). @throws BadArgument
  static BucketKey parse(std::string_view name);

  /// Largest percentage a bucket may have.
  static constexpr int k_max_percent = 100;
};

/// All of a bucket but its values. Lengths in the meshes' unit, volumes in its cube.
struct BucketSummary {
  BucketKey key;
  double nominal = 0.0;  ///< The percentage as a distance or a volume.
  /// What the configurations are solved for: `nominal`, but in bucket 0 a distance just outside contact.
  double target = 0.0;
  double tolerance = 0.0;         ///< |measured - target| is at most this in every reachable configuration.
  double largest_residual = 0.0;  ///< The largest |measured - target| when the set was made.
  std::uint64_t reachable = 0;    ///< Configurations whose translation is a number; filled by the writer.
  std::string oracle;             ///< What measured, e.g. "fcl-rss".
  std::string oracle_version;
  std::string hash;  ///< Content hash of the values; filled by the writer.
};

/// A bucket with its values, in memory.
struct Bucket {
  BucketSummary summary;
  /// Translation s of B along the direction, [rotation][direction], NaN where the target is not met.
  std::vector<double> translations;
};

/// |distance - target| allowed in a set, in units of A's box diagonal.
constexpr double k_distance_tolerance = 1e-9;

/// Target of distance bucket 0, in units of A's box diagonal: far above the rounding of a distance (1e-16) and far below
/// the tolerance, so that the surfaces are about to touch and do not intersect.
constexpr double k_contact_target = 1e-11;

/// |volume - target| allowed in a set, in units of A's volume.
constexpr double k_volume_tolerance = 1e-9;

/// The distance bucket of a percentage of A's box diagonal: key, nominal, target and tolerance filled.
/// @throws BadArgument unless 0 <= percent <= BucketKey::k_max_percent
BucketSummary distance_bucket(const Mesh& a, int percent);

/// The volume bucket of a percentage of A's volume: key, nominal, target and tolerance filled. Bucket 0 is contact.
/// @throws BadArgument unless 0 <= percent <= BucketKey::k_max_percent
BucketSummary volume_bucket(const Mesh& a, int percent);

}  // namespace sixdof
