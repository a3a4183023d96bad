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
  BucketKey key;  ///< Of the bucket.
  /// In the order of drawing: every prefix is a stratified sample of the bucket (CellOrder).
  std::vector<Pose> poses;
  std::vector<std::uint64_t> cells;  ///< Place of each pose in the grid: rotation * number of directions + direction.
  double target = 0.0;               ///< Distance (length) or overlap volume (length^3) of every configuration.
  double tolerance = 0.0;            ///< Upper bound of the set's own |measured - target|, same unit.
  double diagonal = 0.0;             ///< Of A's box: the scale of tolerances of distances.
  std::uint64_t reachable = 0;       ///< Reachable configurations of the whole bucket.
};

/// Order in which the cells of a grid, rotations times directions, are drawn. With random permutations P of the R
/// rotations and Q of the U directions, and L the least common multiple of R and U, cell number t is
/// (P[t mod R], Q[(t + floor(t / L)) mod U]). So every cell comes once, and in every prefix the counts of any two
/// rotations differ by at most 1, and so do those of any two directions.
class CellOrder {
 public:
  /// Neither number is 0. The same seed gives the same order.
  CellOrder(std::size_t rotations, std::size_t directions, std::uint64_t seed);

  /// Number of cells: rotations times directions.
  std::uint64_t size() const { return rotations_.size() * directions_.size(); }
  /// rotation * number of directions + direction, of 0 <= t < size().
  std::uint64_t operator[](std::uint64_t t) const;

 private:
  std::vector<std::size_t> rotations_, directions_;
  std::uint64_t period_;
};

/// Reads a bucket and draws `count` of its reachable configurations, all if there are no more or `count` is 0, in the
/// order of CellOrder without the cells that cannot be reached. The same seed draws the same ones, and a smaller count
/// a prefix of them.
/// @throws BadFile, BadArgument as ConfigurationSet does
BucketSample sample_bucket(const ConfigurationSet& set, BucketKey key, const Mesh& a, const Mesh& b, std::size_t count,
                           std::uint64_t seed);

/// Indices of the first `count` poses of a sample, sorted by their places in the grid.
std::vector<std::size_t> grid_order(const BucketSample& sample, std::size_t count);

/// 0..count-1 in a random order that depends on `seed` and `count` alone.
std::vector<std::size_t> random_order(std::size_t count, std::uint64_t seed);

}  // namespace sixdof
