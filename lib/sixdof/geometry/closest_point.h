#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>

namespace sixdof {

/// A point of a mesh's surface, in the mesh's frame.
struct SurfacePoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double distance = std::numeric_limits<double>::infinity();  ///< From the query point, unsigned.
  std::uint32_t triangle = 0;                                 ///< Index into Mesh::triangles().
};

/// The point of the mesh's surface closest to `p` (mesh frame); none if no point is nearer than `within`. Of several
/// equally near, the one on the triangle that comes first in tree order. The same bits on every instruction set.
std::optional<SurfacePoint> closest_point(const Tree& tree, const Eigen::Vector3d& p,
                                          double within = std::numeric_limits<double>::infinity());

/// The same for one triangle, given by its corners: by the Voronoi region that p lies in. On needles and flat triangles
/// the point is on the triangle but may not be the closest one; triangle_triangle_distance() has no such limit. Source:
/// C. Ericson, Real-Time Collision Detection (2005), section 5.1.5.
Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& p, const Tree::Corners& corners);

/// Calls visit(position of a triangle, in tree order) for all triangles whose box is within `reach` of `p` (mesh
/// frame), and some others, until a call returns false. @return whether none did
template <class Visit>
bool for_triangles_near(const Tree& tree, const Eigen::Vector3d& p, double reach, const Visit& visit) {
  const Eigen::Vector3d q = p - tree.center();
  std::vector<std::uint32_t> stack{0};
  while (!stack.empty()) {
    const Tree::Node& node = tree.nodes()[stack.back()];
    stack.pop_back();
    for (std::uint32_t c = 0; c < node.child_count; ++c) {
      double squared = 0.0;
      for (Eigen::Index k = 0; k < 3; ++k) {
        const double outside =
            std::max({0.0, static_cast<double>(node.lower[k][c]) - q[k], q[k] - static_cast<double>(node.upper[k][c])});
        squared += outside * outside;
      }
      if (squared > reach * reach) continue;
      const Tree::Child child = node.child[c];
      if (!child.is_leaf()) {
        stack.push_back(child.node());
        continue;
      }
      for (std::uint32_t t = child.first(); t < child.first() + child.count(); ++t) {
        if (!visit(t)) return false;
      }
    }
  }
  return true;
}

}  // namespace sixdof
