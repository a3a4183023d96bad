#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sixdof/geometry/mesh.h>

namespace sixdof::vps {

/// Closest point of a triangle to p, corners and edges included; a triangle of zero area is its longest edge.
/// Ericson, Real-Time Collision Detection (2005), 5.1.5.
Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                          const Eigen::Vector3d& c);

/// A tree of boxes over a mesh's triangles, for building voxelmaps: closest point and winding number. The mesh outlives
/// it. Immutable: any number of threads may ask.
class SurfaceIndex {
 public:
  explicit SurfaceIndex(const Mesh& mesh);

  struct Closest {
    Eigen::Vector3d point;
    std::uint32_t triangle;
    double squared_distance;
  };
  /// @param guess a triangle that is probably near; the better it is, the faster the answer. Does not change the
  /// distance found.
  Closest closest(const Eigen::Vector3d& p, std::uint32_t guess = 0) const;

  /// How often the surface winds around p: 1 inside a body, 0 outside, 2 where two bodies of one mesh overlap. The
  /// solid angles of near triangles are exact; clusters further than k_far_ratio radii away count as one dipole (Barill
  /// et al., Fast winding numbers for soups and clouds, 2018), which leaves an error of a few hundredths.
  double winding_number(const Eigen::Vector3d& p) const;

 private:
  static constexpr double k_far_ratio = 3.0;
  static constexpr std::size_t k_leaf_triangles = 4;

  struct Node {
    Eigen::AlignedBox3d box;
    Eigen::Vector3d area_vector = Eigen::Vector3d::Zero();  ///< Sum of the triangles' area vectors.
    Eigen::Vector3d center = Eigen::Vector3d::Zero();       ///< Area-weighted centre.
    double radius = 0.0;                                    ///< Farthest corner from `center`.
    std::uint32_t begin = 0, end = 0;                       ///< Range of order_.
    std::uint32_t second = 0;                               ///< Second child, 0 in leaves; the first child follows.
    bool leaf() const { return second == 0; }
  };

  std::array<Eigen::Vector3d, 3> corners(std::uint32_t triangle) const;
  std::uint32_t build(std::uint32_t begin, std::uint32_t end);

  const Mesh* mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Eigen::Vector3d> middles_;
  std::vector<Node> nodes_;
};

}  // namespace sixdof::vps
