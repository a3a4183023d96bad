#include <sixdof/oracle/nested.h>

#include <algorithm>

#include <sixdof/oracle/winding.h>

namespace sixdof::detail {
using Eigen::Vector3d;

bool is_nested(const DistanceBody& a, const DistanceBody& b, const Pose& X_AB, std::vector<std::uint32_t>& triangles) {
  if (a.piece_vertices.empty() || b.piece_vertices.empty()) return false;
  return std::ranges::any_of(b.piece_vertices,
                             [&](const Vector3d& p) { return winding_of_a(a.tree, X_AB * p, triangles) > 0; }) ||
         std::ranges::any_of(a.piece_vertices, [&](const Vector3d& p) {
           return winding_of_b(b.tree, X_AB, transform_point_of_b, p, triangles) > 0;
         });
}

}  // namespace sixdof::detail
