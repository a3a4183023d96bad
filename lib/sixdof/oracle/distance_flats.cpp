#include <sixdof/oracle/distance_flats.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;

/// Thickness of a flat part: rounding of its corners and of the products that measure it, together a dozen units in the
/// last place. In radii of the mesh, and in distances of its centre from the origin, where corners round.
constexpr double k_thickness = 4e-15;
constexpr double k_thickness_offset = 1e-15;
/// A float slab this thin, in radii, may belong to a flat part: both its ends round.
constexpr float k_thin_slab = 4e-7f;
/// What is added to either side of a plane's interval, in radii: a product of three terms rounds by less.
constexpr double k_height_rounding = 1e-15;
/// Planes whose normals differ by a larger angle than this (cosine) have no ties.
constexpr double k_parallel_cosine = 1.0 - 1e-6;

/// The plane of triangles first .. end - 1 in tree order, if they lie in one.
std::optional<Flats::Plane> common_plane(const Tree& tree, std::uint32_t first, std::uint32_t end) {
  Vector3d sum = Vector3d::Zero();
  for (std::uint32_t t = first; t < end; ++t) {
    const Tree::Corners& c = tree.corners()[t];
    sum += (c[1] - c[0]).cross(c[2] - c[0]);
  }
  const double scale = sum.cwiseAbs().maxCoeff();
  if (!(scale > 0.0)) return std::nullopt;
  const double thickness = k_thickness * tree.radius() + k_thickness_offset * tree.center().norm();
  Flats::Plane plane{(sum / scale).normalized(), std::numeric_limits<double>::infinity(),
                     -std::numeric_limits<double>::infinity()};
  for (std::uint32_t t = first; t < end; ++t) {
    for (const Vector3d& corner : tree.corners()[t]) {
      const double height = plane.normal.dot(corner - tree.center());
      plane.lower = std::min(plane.lower, height);
      plane.upper = std::max(plane.upper, height);
    }
    if (plane.upper - plane.lower > thickness) return std::nullopt;
  }
  plane.lower -= k_height_rounding * tree.radius();
  plane.upper += k_height_rounding * tree.radius();
  return plane;
}

struct Interval {
  double lower;
  double upper;
};

/// Where `axis` . p lies over a part: its plane, with the rest of the axis over its box.
Interval extent(const Flats::Plane& plane, const Tree::Volume& box, const Vector3d& axis) {
  const double along = axis.dot(plane.normal);
  const Vector3d rest = axis - along * plane.normal;
  double middle = 0.0;
  double reach = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto lower = static_cast<double>(box.lower[k]);
    const auto upper = static_cast<double>(box.upper[k]);
    const double r = rest[static_cast<Eigen::Index>(k)];
    middle += 0.5 * r * (lower + upper);
    reach += 0.5 * std::abs(r) * (upper - lower);
  }
  return {std::min(along * plane.lower, along * plane.upper) + middle - reach,
          std::max(along * plane.lower, along * plane.upper) + middle + reach};
}

}  // namespace

Flats::Flats(const Tree& tree) {
  find_planes(tree);
  if (!empty()) find_lowest(tree);
}

void Flats::find_planes(const Tree& tree) {
  // Parents before children: what lies in a flat part is not looked at again.
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
  node_plane_[0] = find(0, tree.nodes()[0].triangle_count, 0.0f);  // the root has no slab of its own
  for (std::size_t index = 0; index < tree.nodes().size(); ++index) {
    const Tree::Node& node = tree.nodes()[index];
    for (std::size_t i = 0; i < node.child_count; ++i) {
      const Tree::Child child = node.child[i];
      std::uint32_t& plane = child.is_leaf() ? leaf_plane_[node.leaf[i]] : node_plane_[child.node()];
      plane = node_plane_[index];
      if (plane != k_none) continue;
      const std::uint32_t first = child.is_leaf() ? child.first() : tree.nodes()[child.node()].first_triangle;
      const std::uint32_t count = child.is_leaf() ? child.count() : tree.nodes()[child.node()].triangle_count;
      plane = find(first, count, node.slab_upper[i] - node.slab_lower[i]);
    }
  }
  if (largest < k_least_triangles) {
    planes_ = std::vector<Plane>();  // which gives the memory back
    node_plane_ = std::vector<std::uint32_t>();
    leaf_plane_ = std::vector<std::uint32_t>();
  }
}

void Flats::find_lowest(const Tree& tree) {
  node_lowest_.resize(tree.nodes().size());
  leaf_lowest_.resize(tree.leaves().size());
  for (std::uint32_t i = static_cast<std::uint32_t>(tree.nodes().size()); i-- > 0;) {  // children before parents
    const Tree::Node& node = tree.nodes()[i];
    std::uint32_t lowest = k_none;
    for (std::size_t k = 0; k < node.child_count; ++k) {
      if (node.child[k].is_leaf()) {
        const auto triangles = tree.mesh_triangle().subspan(node.child[k].first(), node.child[k].count());
        leaf_lowest_[node.leaf[k]] = *std::min_element(triangles.begin(), triangles.end());
        lowest = std::min(lowest, leaf_lowest_[node.leaf[k]]);
      } else {
        lowest = std::min(lowest, node_lowest_[node.child[k].node()]);
      }
    }
    node_lowest_[i] = lowest;
  }
}

std::size_t Flats::bytes() const {
  return planes_.capacity() * sizeof(Plane) +
         (node_plane_.capacity() + leaf_plane_.capacity() + node_lowest_.capacity() + leaf_lowest_.capacity()) *
             sizeof(std::uint32_t);
}

double plane_gap(const Flats::Plane& a, const Tree::Volume& box_a, const Flats::Plane& b, const Tree::Volume& box_b,
                 const Eigen::Matrix3d& R, const Vector3d& shift) {
  const Vector3d turned = R * b.normal;
  if (!(std::abs(a.normal.dot(turned)) > k_parallel_cosine)) return -std::numeric_limits<double>::infinity();
  // Either normal may be the better known one. R is a rotation up to rounding only, so lengths are divided out.
  double gap = -std::numeric_limits<double>::infinity();
  for (const Vector3d& axis : {a.normal, turned}) {
    const Interval of_a = extent(a, box_a, axis);
    const Interval of_b = extent(b, box_b, R.transpose() * axis);
    const double apart = axis.dot(shift);
    gap = std::max(gap, std::max(of_b.lower + apart - of_a.upper, of_a.lower - (of_b.upper + apart)) / axis.norm());
  }
  return gap;
}

}  // namespace sixdof::detail
