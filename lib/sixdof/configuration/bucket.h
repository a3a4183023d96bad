#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/geometry/mesh.h>

/// A bucket: the configurations of a set that have one distance or one overlap volume in common.

namespace sixdof {

/// The quantity that a bucket holds fixed.
enum class BucketKind {
  distance,  ///< Of the surfaces, in percent of the diagonal of A's box.
  volume     ///< Of the overlap, in percent of A's volume.
};

/// "distance" or "volume".
std::string to_string(BucketKind kind);

/// Which bucket of a set: a kind and a percentage.
struct BucketKey {
  BucketKind kind = BucketKind::distance;  ///< What the percentage is of.
  double percent = 0.0;  ///< 0 to k_max_percent, a decimal number with at most k_max_decimals digits behind the point.

  /// Distances before volumes, each by percentage.
  auto operator<=>(const BucketKey&) const = default;

  /// Name of the bucket's dataset: "distance/05", "volume/10", "distance/0.5". Whole percentages have two digits at
  /// least. Names of benchmarks have it with ':' for '/'.
  std::string name() const;
  std::string percent_text() const;  ///< "05", "0.5": the part of name() behind the '/'.
  /// The inverse of name(). @throws BadArgument
  static BucketKey parse(std::string_view name);

  /// Largest percentage.
  static constexpr int k_max_percent = 100;
  /// Most digits behind the point.
  static constexpr int k_max_decimals = 3;
};

/// A percentage as a bucket may have it: digits, and at most k_max_decimals digits behind a point ("5", "05", "0.5").
/// Nothing if the text is something else or above k_max_percent.
std::optional<double> parse_percent(std::string_view text);

/// Everything about a bucket but its values. Distances in the meshes' length unit, volumes in its cube.
struct BucketSummary {
  BucketKey key;         ///< Its name.
  double nominal = 0.0;  ///< The percentage as a distance or a volume.
  /// The distance or volume that the configurations have: `nominal`, but a distance just outside contact in
  /// distance bucket 0.
  double target = 0.0;
  double tolerance = 0.0;         ///< Upper bound of |measured - target| of every reachable configuration.
  double largest_residual = 0.0;  ///< Largest |measured - target| when the set was made.
  std::uint64_t reachable = 0;    ///< Configurations whose translation is not NaN. The writer fills it in.
  std::string oracle;             ///< The method that measured, e.g. "fcl-rss".
  std::string oracle_version;     ///< Of that method.
  std::string hash;               ///< Content hash of the values. The writer fills it in.
};

/// A bucket with its values, in memory.
struct Bucket {
  /// Everything but the values.
  BucketSummary summary;
  /// Translation s of B along the direction, [rotation][direction], NaN where the target is not met.
  std::vector<double> translations;
};

/// |distance - target| allowed in a set, in units of the diagonal of A's box.
constexpr double k_distance_tolerance = 1e-9;

/// Target of distance bucket 0, in units of the diagonal of A's box: far above the rounding of a distance (1e-16) and
/// far below the tolerance, so that the surfaces are about to touch and do not intersect.
constexpr double k_contact_target = 1e-11;

/// |volume - target| allowed in a set, in units of A's volume.
constexpr double k_volume_tolerance = 1e-9;

/// The distance bucket of a percentage of the diagonal of A's box, with key, nominal, target and tolerance.
/// @throws BadArgument if a BucketKey cannot have this percentage
BucketSummary distance_bucket(const Mesh& a, double percent);

/// The volume bucket of a percentage of A's volume, with key, nominal, target and tolerance. Bucket 0 is contact.
/// @throws BadArgument if a BucketKey cannot have this percentage
BucketSummary volume_bucket(const Mesh& a, double percent);

}  // namespace sixdof
