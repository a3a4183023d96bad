// The spheres of a node's eight children are told apart at once, compiled once per instruction set and chosen at run
// time.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)  // as in contact.cpp
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/algorithm/vps/point_tree.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/highway.h>

#include <sixdof/algorithm/vps/lookup-inl.h>
#include <sixdof/algorithm/vps/point_tree.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::vps {
namespace HWY_NAMESPACE {

/// Slack for the rounding of single-precision voxel coordinates, in voxels: coordinates below 2^12 round to 2^-12.
constexpr float k_rounding = 1e-3f;
constexpr float k_half_diagonal = 0.8660254f;  // of a voxel

/// The part of a coordinate that lies beyond [0, end], squared.
HWY_INLINE F squared_beyond(F q, float end) {
  const F out = hn::Sub(q, hn::Min(hn::Max(q, hn::Zero(k_floats)), splat(end)));
  return hn::Mul(out, out);
}

/// Bits of a mask's lanes.
template <class M>
HWY_INLINE unsigned bits_of(M mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(k_floats, mask, bits);
  return bits[0] & ((1u << hn::Lanes(k_floats)) - 1u);
}

/// @param spheres x, y, z and radius of eight spheres, one row each
/// @param outside, inside receive one bit per sphere
void find_sides(const float* spheres, const VoxelMap& map, const Placement& placement, float reach, unsigned& outside,
                unsigned& inside) {
  const GridLookup lookup(map.grid);
  const LayerLookup layers(map);
  const Matrix scaled(placement.scaled);
  const Vec3 offset{splat(placement.center.x()), splat(placement.center.y()), splat(placement.center.z())};
  const Eigen::Array3f end = map.grid.voxels().cast<float>();
  const auto per_size = static_cast<float>(1.0 / map.grid.size);
  outside = inside = 0;
  for (std::size_t l = 0; l < PointTree::k_block; l += hn::Lanes(k_floats)) {
    const auto row = [&](std::size_t r) HWY_ATTR { return hn::LoadU(k_floats, spheres + r * PointTree::k_block + l); };
    const Vec3 q = transform(scaled, offset, {row(0), row(1), row(2)});
    const F radius = hn::Add(hn::Mul(row(3), splat(per_size)), splat(k_rounding + reach));
    // A centre beyond the grid is moved to its border; the way there counts as one leg of a right angle, since all of
    // the surface lies on the other side of that border.
    const F beyond =
        hn::Add(hn::Add(squared_beyond(q.x, end.x()), squared_beyond(q.y, end.y())), squared_beyond(q.z, end.z()));
    const F left = hn::Sub(hn::Mul(radius, radius), beyond);
    const auto in_reach = hn::Ge(left, hn::Zero(k_floats));
    // As VoxelMap::outside_distance().
    const Cell cell = lookup.cell(q);
    const I entry = layers.entries(cell);
    const F unstored = hn::Sub(splat(-1.0f), hn::ConvertTo(k_floats, entry));
    const F stored = hn::Sub(splat(-0.5f), hn::ConvertTo(k_floats, layers.layers(cell, entry)));
    const auto is_stored = hn::RebindMask(k_floats, hn::Gt(entry, splat_int(-1)));
    const F distance = hn::IfThenElse(is_stored, stored, unstored);
    // A straight way from the node's centre to a voxel with v >= 0 first enters such a voxel where it is a surface
    // voxel: half a diagonal from that voxel's centre at most. The node's centre is within half a diagonal of its own
    // voxel's.
    const F out = hn::Max(hn::Sub(distance, splat(2.0f * k_half_diagonal)), hn::Zero(k_floats));
    const auto near = hn::And(in_reach, hn::Le(hn::Mul(out, out), left));
    // Inside, |v| is rounded the other way; no way as short leads out of voxels with v >= 0.
    const F in = hn::Sub(splat(-1.0f - 2.0f * k_half_diagonal), distance);
    outside |= bits_of(hn::Not(near)) << l;
    inside |= bits_of(hn::And(near, hn::Gt(in, radius))) << l;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::vps
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sixdof::vps {

HWY_EXPORT(find_sides);

Placement Placement::of(const Pose& X, const Eigen::Vector3d& center, const VoxelGrid& grid) {
  return {.rotation = X.R.cast<float>(),
          .scaled = (X.R / grid.size).cast<float>(),
          .center = grid.coordinates(X * center).cast<float>()};
}

PointTree::PointTree(const PointShell& shell, const Eigen::Vector3d& center, bool by_area)
    : center_(center), points_(shell.points.size()) {
  std::vector<std::uint32_t> order(points_);
  std::iota(order.begin(), order.end(), 0u);
  build(shell, order, {0, points_});
  leaves_ = static_cast<std::uint32_t>((points_ + k_leaf_points - 1) / k_leaf_points);
  blocks_.resize(leaves_ * k_leaf_blocks * k_rows * k_block);
  for (std::size_t i = 0; i < leaves_ * k_leaf_points; ++i) {
    const std::uint32_t p = order[std::min(i, points_ - 1)];
    const Eigen::Vector3f position = (shell.points[p] - center_).cast<float>(), normal = shell.normals[p].cast<float>();
    const float weight = i >= points_ ? 0.0f : by_area ? static_cast<float>(shell.areas[p]) : 1.0f;
    float* const lane = blocks_.data() + i / k_block * k_rows * k_block + i % k_block;
    const float row[k_rows] = {position.x(), position.y(), position.z(), weight, normal.x(), normal.y(), normal.z()};
    for (std::size_t r = 0; r < k_rows; ++r) lane[r * k_block] = row[r];
  }
}

std::pair<PointTree::Range, PointTree::Range> PointTree::split(const PointShell& shell,
                                                               std::vector<std::uint32_t>& order, Range range) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = range.begin; i < range.end; ++i) box.extend(shell.points[order[i]]);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t middle = range.begin + (range.leaves() + 1) / 2 * k_leaf_points;
  const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(range.begin), at(middle), at(range.end), [&](std::uint32_t i, std::uint32_t j) {
    const double a = shell.points[i][axis], b = shell.points[j][axis];
    return a != b ? a < b : i < j;
  });
  return {{range.begin, middle}, {middle, range.end}};
}

std::uint32_t PointTree::build(const PointShell& shell, std::vector<std::uint32_t>& order, Range range) {
  const auto here = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  std::vector<Range> ranges{range};
  for (std::size_t width = 1; width < k_width; width *= 2) {
    std::vector<Range> halves;
    for (const Range& part : ranges) {
      if (part.leaves() == 1) {
        halves.push_back(part);
        continue;
      }
      const auto [low, high] = split(shell, order, part);
      halves.push_back(low);
      halves.push_back(high);
    }
    ranges = std::move(halves);
  }
  Node node;
  node.children = static_cast<std::uint32_t>(ranges.size());
  for (std::size_t i = 0; i < k_width; ++i) {
    const Range& part = ranges[std::min(i, ranges.size() - 1)];
    Eigen::AlignedBox3d box;
    for (std::size_t k = part.begin; k < part.end; ++k) box.extend(shell.points[order[k]]);
    const Eigen::Vector3d middle = box.center();
    double radius = 0.0;
    for (std::size_t k = part.begin; k < part.end; ++k) {
      radius = std::max(radius, (shell.points[order[k]] - middle).norm());
    }
    const Eigen::Vector3f center = (middle - center_).cast<float>();
    for (Eigen::Index k = 0; k < 3; ++k) node.sphere[k][i] = center[k];
    node.sphere[3][i] = static_cast<float>(radius);
  }
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const auto first_leaf = static_cast<std::uint32_t>(ranges[i].begin / k_leaf_points);
    node.child[i] = {.node = ranges[i].leaves() == 1 ? k_no_node : build(shell, order, ranges[i]),
                     .first_leaf = first_leaf,
                     .end_leaf = first_leaf + static_cast<std::uint32_t>(ranges[i].leaves())};
  }
  nodes_[here] = node;
  return here;
}

PointTree::Sides PointTree::sides_of(const Node& node, const VoxelMap& map, const Placement& placement, double reach) {
  Sides sides;
  HWY_DYNAMIC_DISPATCH(find_sides)
  (node.sphere[0], map, placement, static_cast<float>(reach), sides.outside, sides.inside);
  return sides;
}

void PointTree::cull(const VoxelMap& map, const Placement& placement, double reach,
                     std::vector<std::uint32_t>& leaves) const {
  leaves.clear();
  any_leaves(map, placement, reach, [&](std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t leaf = first; leaf < end; ++leaf) leaves.push_back(leaf);
    return false;
  });
}

}  // namespace sixdof::vps
#endif  // HWY_ONCE
