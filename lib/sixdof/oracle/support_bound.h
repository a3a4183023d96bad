#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>

namespace sixdof::detail {

/// A convex outer bound of a mesh, in the mesh's frame: how far it extends along any direction.
///
/// The support function h(d), the largest d . (p - center) of all vertices p, is tabulated for directions on a grid
/// over the six faces of a cube, and is interpolated between them. h is sublinear, and a direction on a face is the
/// same combination of the four grid directions around it: so what is interpolated is never below h. It is h where one
/// vertex is the farthest along all four, as for boxes in their own frame; elsewhere it is a few percent of the radius
/// above it.
class SupportBound {
 public:
  /// Bounds nothing: certainly_apart() is false.
  SupportBound() = default;
  explicit SupportBound(const Tree& tree);
  /// Of a box that contains the mesh: bounds less, and costs next to nothing.
  explicit SupportBound(const Eigen::AlignedBox3d& box);

  bool empty() const { return table_.empty(); }
  const Eigen::Vector3d& center() const { return center_; }  ///< Of the mesh's box.
  double radius() const { return radius_; }                  ///< No vertex is farther from the centre.
  const Eigen::Vector3d& half() const { return half_; }      ///< Of the box's size.

  struct Support {
    double height;          ///< At least h(d).
    Eigen::Vector3d point;  ///< Gradient of height by d, relative to center(): d . point = height.
  };
  /// @param d not zero
  Support along(const Eigen::Vector3d& d) const;

  std::size_t bytes() const { return table_.capacity() * sizeof(float); }

  /// Cells along an edge of a face of the cube.
  static constexpr std::size_t k_cells = 4;

 private:
  static constexpr std::size_t k_points = k_cells + 1;
  static std::size_t index(std::size_t face, std::size_t i, std::size_t j) {
    return (face * k_points + i) * k_points + j;
  }
  /// Calls height(d) for each direction of the grid, near ones after each other.
  template <class Height>
  void tabulate(const Height& height);

  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_ = Eigen::Vector3d::Zero();
  double radius_ = 0.0;
  std::vector<float> table_;  // [axis, negative ones last][next axis][the one after it]
};

/// Whether two meshes are certainly apart, neither one inside the other: by their spheres, by the axes of their boxes,
/// and by a few steps towards the direction that separates their bounds best. Most poses of bodies at 10 % of their
/// size are decided here.
bool certainly_apart(const SupportBound& a, const SupportBound& b, const Pose& X_AB);

}  // namespace sixdof::detail
