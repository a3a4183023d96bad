#include <sixdof/oracle/coplanar_patches.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;

/// A mesh whose largest patch has fewer triangles counts as having none.
constexpr std::uint32_t k_least_triangles = 4;

/// Largest thickness of a patch: the rounding of its corners and of the products that measure it, together a dozen
/// units in the last place. Relative to the mesh's radius, and to the distance of its centre from the origin.
constexpr double k_thickness = 4e-15;
constexpr double k_thickness_offset = 1e-15;
/// A slab of a tree's volume that is thicker than this (relative to the radius) does not belong to a patch: both its
/// bounds are rounded to floats.
constexpr float k_thin_slab = 4e-7f;
/// Added on either side of a plane's interval, relative to the radius: rounding of a scalar product.
constexpr double k_plane_rounding = 1e-15;
/// Planes are compared if the cosine of the angle between their normals is larger.
constexpr double k_parallel_cosine = 1.0 - 1e-6;

/// The plane of triangles first .. end - 1 in tree order, if they lie in one.
std::optional<CoplanarPatches::Plane> common_plane(const Tree& tree, std::uint32_t first, std::uint32_t end) {
  Vector3d sum = Vector3d::Zero();
  for (std::uint32_t t = first; t < end; ++t) {
    const Tree::Corners& c = tree.corners()[t];
    sum += (c[1] - c[0]).cross(c[2] - c[0]);
  }
  const double scale = sum.cwiseAbs().maxCoeff();
  if (!(scale > 0.0)) return std::nullopt;
  const double thickness = k_thickness * tree.radius() + k_thickness_offset * tree.center().norm();
  CoplanarPatches::Plane plane{(sum / scale).normalized(), std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity()};
  for (std::uint32_t t = first; t < end; ++t) {
    for (const Vector3d& corner : tree.corners()[t]) {
      const double offset = plane.normal.dot(corner - tree.center());
      plane.lower = std::min(plane.lower, offset);
      plane.upper = std::max(plane.upper, offset);
    }
    if (plane.upper - plane.lower > thickness) return std::nullopt;
  }
  plane.lower -= k_plane_rounding * tree.radius();
  plane.upper += k_plane_rounding * tree.radius();
  return plane;
}

struct Interval {
  double lower;
  double upper;
};

/// Range of axis . p over a patch: the component of the axis along the normal over the plane, the rest over the box.
Interval project(const CoplanarPatches::Plane& plane, const Tree::Volume& box, const Vector3d& axis) {
  const double along = axis.dot(plane.normal);
  const Vector3d rest = axis - along * plane.normal;
  double middle = 0.0;
  double radius = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto lower = static_cast<double>(box.lower[k]);
    const auto upper = static_cast<double>(box.upper[k]);
    const double r = rest[static_cast<Eigen::Index>(k)];
    middle += 0.5 * r * (lower + upper);
    radius += 0.5 * std::abs(r) * (upper - lower);
  }
  return {std::min(along * plane.lower, along * plane.upper) + middle - radius,
          std::max(along * plane.lower, along * plane.upper) + middle + radius};
}

}  // namespace

CoplanarPatches::CoplanarPatches(const Tree& tree, bool always) {
  find_planes(tree, always);
  if (!empty()) find_smallest_indices(tree);
}

void CoplanarPatches::find_planes(const Tree& tree, bool always) {
  // Parents come before their children, which inherit the plane.
  std::uint32_t largest = 0;
  const auto find = [&](std::uint32_t first, std::uint32_t count, float thickness) {
    if (!(thickness <= k_thin_slab * static_cast<float>(tree.radius()))) return k_none;
    const std::optional<Plane> plane = common_plane(tree, first, first + count);
    if (!plane) return k_none;
    largest = std::max(largest, count);
    planes_.push_back(*plane);
    return static_cast<std::uint32_t>(planes_.size() - 1);
  };
  node_plane_.resize(tree.nodes().size());
  leaf_plane_.resize(tree.leaves().size());
  node_plane_[0] = find(0, tree.nodes()[0].triangle_count, 0.0f);  // the root's volume has no slab
  for (std::size_t index = 0; index < tree.nodes().size(); ++index) {
    const Tree::Node& node = tree.nodes()[index];
    for (std::size_t i = 0; i < node.child_count; ++i) {
      const Tree::Child child = node.child[i];
      std::uint32_t& plane = child.is_leaf() ? leaf_plane_[node.leaf(i)] : node_plane_[child.node()];
      plane = node_plane_[index];
      if (plane != k_none) continue;
      const std::uint32_t first = child.is_leaf() ? child.first() : tree.nodes()[child.node()].first_triangle;
      const std::uint32_t count = child.is_leaf() ? child.count() : tree.nodes()[child.node()].triangle_count;
      plane = find(first, count, node.slab_upper[i] - node.slab_lower[i]);
    }
  }
  if (largest < k_least_triangles && !always) {
    planes_ = std::vector<Plane>();  // frees the memory
    node_plane_ = std::vector<std::uint32_t>();
    leaf_plane_ = std::vector<std::uint32_t>();
  }
}

void CoplanarPatches::find_smallest_indices(const Tree& tree) {
  node_smallest_index_.resize(tree.nodes().size());
  leaf_smallest_index_.resize(tree.leaves().size());
  for (std::uint32_t i = static_cast<std::uint32_t>(tree.nodes().size()); i-- > 0;) {  // children before parents
    const Tree::Node& node = tree.nodes()[i];
    std::uint32_t smallest = k_none;
    for (std::size_t k = 0; k < node.child_count; ++k) {
      if (node.child[k].is_leaf()) {
        const auto triangles = tree.mesh_triangle().subspan(node.child[k].first(), node.child[k].count());
        leaf_smallest_index_[node.leaf(k)] = *std::min_element(triangles.begin(), triangles.end());
        smallest = std::min(smallest, leaf_smallest_index_[node.leaf(k)]);
      } else {
        smallest = std::min(smallest, node_smallest_index_[node.child[k].node()]);
      }
    }
    node_smallest_index_[i] = smallest;
  }
}

std::size_t CoplanarPatches::bytes() const {
  return planes_.capacity() * sizeof(Plane) + (node_plane_.capacity() + leaf_plane_.capacity() +
                                               node_smallest_index_.capacity() + leaf_smallest_index_.capacity()) *
                                                  sizeof(std::uint32_t);
}

double plane_gap(const CoplanarPatches::Plane& a, const Tree::Volume& box_a, const CoplanarPatches::Plane& b,
                 const Tree::Volume& box_b, const Eigen::Matrix3d& R, const Vector3d& shift) {
  const Vector3d normal_b = R * b.normal;  // in A's frame
  if (!(std::abs(a.normal.dot(normal_b)) > k_parallel_cosine)) return -std::numeric_limits<double>::infinity();
  // Both normals are tried: either may be the more accurate one. R is a rotation up to rounding, hence axis.norm().
  double gap = -std::numeric_limits<double>::infinity();
  for (const Vector3d& axis : {a.normal, normal_b}) {
    const Interval of_a = project(a, box_a, axis);
    const Interval of_b = project(b, box_b, R.transpose() * axis);
    const double apart = axis.dot(shift);
    gap = std::max(gap, std::max(of_b.lower + apart - of_a.upper, of_a.lower - (of_b.upper + apart)) / axis.norm());
  }
  return gap;
}

}  // namespace sixdof::detail
