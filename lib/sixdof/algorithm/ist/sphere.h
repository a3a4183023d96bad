#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace sixdof::ist {

struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< In the mesh's frame and length unit.
  double radius = 0.0;

  double volume() const { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }
};

/// Volume of the intersection of two spheres of radii `r1`, `r2` whose centres are `d` apart:
/// pi (r1 + r2 - d)^2 (d^2 + 2 d (r1 + r2) - 3 (r1 - r2)^2) / (12 d) where their surfaces cross, the smaller sphere's
/// volume where it lies inside the other, 0 where they are apart. (Weisstein, "Sphere-Sphere Intersection", MathWorld.)
double overlap_volume(double r1, double r2, double d);

/// Sum of the spheres' own volumes.
double total_volume(std::span<const Sphere> spheres);

/// A bounding sphere, close to the smallest one (Badoiu and Clarkson 2003, there for points): the centre moves towards
/// the farthest point in shrinking steps; the radius is then rounded up.
Sphere enclosing_sphere(std::span<const Sphere> spheres);

/// Finds the sphere whose surface is closest to a point. Each class of radii (powers of two) has a hashed grid with
/// cells of four radii. Several threads may read at once while none inserts.
class SphereIndex {
 public:
  /// @param largest upper bound on all radii.
  explicit SphereIndex(double largest);

  void insert(const Sphere& sphere);
  std::span<const Sphere> spheres() const { return spheres_; }

  struct Nearest {
    double clearance;          ///< Distance from the point to the sphere's surface, negative inside it.
    std::int32_t sphere = -1;  ///< Index into spheres(); -1 if none is nearer than `within`.

    /// Takes sphere `s`, whose index is `i`, if it is nearer to `p`.
    void consider(const Sphere& s, const Eigen::Vector3d& p, std::int32_t i) {
      const double other = (s.center - p).norm() - s.radius;
      if (other < clearance || (other == clearance && sphere >= 0 && i < sphere)) {
        clearance = other;
        sphere = i;
      }
    }
  };
  /// The sphere whose surface is nearest to `p` among those with a clearance below `within`; ties by lower index.
  Nearest nearest(const Eigen::Vector3d& p, double within) const;

  struct Near {
    Sphere sphere;
    double clearance;    ///< Of the point that was asked for.
    std::int32_t index;  ///< Into spheres().
  };
  /// Appends all spheres with a clearance below `within` of `p`, in no particular order.
  void find_near(const Eigen::Vector3d& p, double within, std::vector<Near>& found) const;

 private:
  struct Cell {
    std::uint64_t key = 0;    // 0: empty
    std::int32_t first = -1;  // head of the list of the cell's spheres
  };
  std::uint64_t key(std::size_t size_class, std::int64_t x, std::int64_t y, std::int64_t z) const;
  std::size_t slot(std::uint64_t key) const;
  void grow();
  template <class Visit>
  void for_candidates(const Eigen::Vector3d& p, const double& within, const Visit& visit) const;

  double largest_;
  std::vector<Sphere> spheres_;
  std::vector<std::int32_t> next_;                        // per sphere: the next one in its cell, -1 at the end
  std::vector<std::vector<std::int32_t>> class_members_;  // spheres of each size class
  std::vector<Cell> cells_;                               // open addressing, power-of-two size
  std::size_t used_ = 0;                                  // cells that are not empty
};

}  // namespace sixdof::ist
