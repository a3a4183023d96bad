#pragma once

#include <cstdint>
#include <vector>

#include <sixdof/algorithm/vps/surface_voxels.h>

namespace sixdof::vps {

/// Exact squared Euclidean distances between voxel centres and the nearest surface voxel's centre, one slice of
/// constant z at a time: lower envelopes of parabolas, axis by axis (Felzenszwalb and Huttenlocher, Distance transforms
/// of sampled functions, 2012). The constructor does the pass along z and stores it, 2 bytes per voxel; slice() does
/// the other two.
class DistanceTransform {
 public:
  explicit DistanceTransform(const SurfaceVoxels& surface);

  /// Working memory of one thread.
  struct Scratch {
    std::vector<std::int32_t> values, centers, bounds, output;
  };

  /// @param squared output: nx * ny squared distances in voxels, x fastest
  void slice(int z, Scratch& scratch, std::vector<std::int32_t>& squared) const;

 private:
  static constexpr std::uint16_t k_none = 0xffff;  ///< No surface voxel on this line along z.

  Eigen::Array3i n_;
  std::vector<std::uint16_t> along_z_;
};

}  // namespace sixdof::vps
