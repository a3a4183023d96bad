#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <sixdof/generation/distance_generator.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

namespace detail {
struct VolumePair;
}

/// Finds the translation at which B, coming from outside, overlaps A by a volume for the first time.
///
/// V need not grow monotonically on the way in. The search goes inwards to where the samples so far foresee the target
/// (overlap_march.h); the oracle's exact derivative makes that good and the last steps cubic. Samples further in serve
/// the next targets. An target counts as met only if no gap between samples on the way there can hide an earlier hit: what
/// the triangles that meet within a gap can do to the slope bounds V there (slope_bounds.h). Where that does not
/// suffice, the gap is divided, down to k_first_overlap_resolution.
///
/// The triangles that may meet are collected once for each stretch of the way (swept_candidates.h) and serve all
/// measurements and bounds on it. A ray takes about three measurements per target.
///
/// What is not found: V passing the target and falling below it again within that length of translation, where the bounds
/// allow it at all; and, in meshes that overlap themselves, the same within longer ways.
///
/// Results depend on the rotation and the directions since set_rotation() alone: a ray is first measured as far behind
/// contact as the ray before it met its first target. The same bits for every number of threads and on every instruction
/// set.
class VolumeGenerator {
 public:
  /// @param touching finds where the surfaces meet first
  /// Both meshes and `touching` outlive this object.
  /// @throws BadMesh naming the mesh that is no solid and why.
  VolumeGenerator(const DistanceGenerator& touching, const Mesh& a, const Mesh& b);
  ~VolumeGenerator();
  VolumeGenerator(const VolumeGenerator&) = delete;
  VolumeGenerator& operator=(const VolumeGenerator&) = delete;

  const std::string& oracle_name() const { return oracle_name_; }
  const std::string& oracle_version() const { return oracle_version_; }
  const DistanceGenerator& touching() const { return touching_; }

  /// A solver whose targets are volumes in the meshes' unit, ascending; 0 stands for touching, which is distance bucket 0.
  /// Measurements are those of the volume. May be called from several threads.
  std::unique_ptr<RaySolver> prepare() const;

 private:
  const DistanceGenerator& touching_;
  std::string oracle_name_ = "exact";
  std::string oracle_version_;
  std::unique_ptr<const detail::VolumePair> pair_;
};

/// In units of the smaller mesh's box diagonal.
constexpr double k_first_overlap_resolution = 2e-3;

/// Finds all configurations of volume buckets, as generate_distances() does those of distances.
/// @param percents of A's volume, each once, 0 to BucketKey::k_max_percent
/// @throws BadArgument, BadMesh, Interrupted, and Error naming the configuration
Generated generate_volumes(const DistanceGenerator& touching, const Mesh& a, const Mesh& b, const Grid& grid,
                           std::span<const int> percents, const GenerateOptions& options = {});

}  // namespace sixdof
