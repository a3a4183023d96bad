#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::bench {

/// A configuration set of one pair with few configurations, for one table of results: made in seconds, by the same
/// methods and to the same tolerances as any set. It is kept in the cache (lib/sixdof/base/cache.h) under the content
/// hashes of the meshes and the versions of what makes it; without a cache it is a temporary file.
class CoarseSet {
 public:
  /// Distances of 0, 1, 5, 10 and 20 % and, of two solids, volumes of 1, 5 and 10 % of the smaller one, which the keys
  /// give in percent of A.
  static std::vector<BucketKey> buckets(const Mesh& a, const Mesh& b);

  /// Finds the set in the cache or makes it, on all cores. On stderr: a progress line, one line that says where the set
  /// is, and one if it has no volumes. Polls InterruptGuard::requested().
  /// @param a_identity, b_identity for the set's file
  /// @param program named in these lines
  /// @throws BadFile if the set cannot be written; Interrupted; Error from the generator of distances
  CoarseSet(const Mesh& a, const MeshIdentity& a_identity, const Mesh& b, const MeshIdentity& b_identity,
            std::string_view program);
  /// Removes a temporary file.
  ~CoarseSet();
  CoarseSet(const CoarseSet&) = delete;
  CoarseSet& operator=(const CoarseSet&) = delete;

  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  bool temporary_ = false;
};

}  // namespace sixdof::bench
