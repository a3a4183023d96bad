#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sixdof/algorithm/ist/sphere.h>

namespace sixdof::ist {

/// Finds the sphere whose surface is closest to a point. Spheres are sorted by radius into classes (powers of two).
/// Each class has a hashed grid with cells of four radii, so that large and small spheres are both found in few cells.
/// Several threads may read at once while none inserts.
class SphereIndex {
 public:
  /// @param largest upper bound on all radii.
  explicit SphereIndex(double largest);

  void insert(const Sphere& sphere);
  std::span<const Sphere> spheres() const { return spheres_; }

  struct Nearest {
    double clearance;          ///< Distance from the point to the sphere's surface, negative inside it.
    std::int32_t sphere = -1;  ///< Index into spheres(); -1 if none is nearer than `within`.
  };
  /// The sphere whose surface is nearest to `p` among those with a clearance below `within`; ties by lower index.
  Nearest nearest(const Eigen::Vector3d& p, double within) const;

 private:
  struct Cell {
    std::uint64_t key = 0;    // 0: empty
    std::int32_t first = -1;  // head of the list of the cell's spheres
  };
  std::uint64_t key(std::size_t size_class, std::int64_t x, std::int64_t y, std::int64_t z) const;
  std::size_t slot(std::uint64_t key) const;
  void grow();

  double largest_;
  std::vector<Sphere> spheres_;
  std::vector<std::int32_t> next_;                        // per sphere: the next one in its cell, -1 at the end
  std::vector<std::vector<std::int32_t>> class_members_;  // spheres of each size class
  std::vector<Cell> cells_;                               // open addressing, power-of-two size
  std::size_t used_ = 0;                                  // cells that are not empty
};

}  // namespace sixdof::ist
