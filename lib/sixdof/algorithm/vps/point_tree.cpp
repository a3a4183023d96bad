#include <sixdof/algorithm/vps/point_tree.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/algorithm/vps/point_tree.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/highway.h>

#include <sixdof/algorithm/vps/lookup-inl.h>
#include <sixdof/base/set_bits.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::vps {
namespace HWY_NAMESPACE {

/// Slack for the rounding of voxel coordinates, in voxels: in single precision those below 2^12 round to 2^-12.
constexpr float k_rounding = 1e-3f;
constexpr float k_half_diagonal = 0.8660254f;  // of a voxel

constexpr hn::Rebind<std::uint8_t, Words> k_bytes;

/// Which of a node's children may hold points in contact.
class NodeTest {
 public:
  HWY_INLINE NodeTest(const VoxelMap& map, const VoxelTransform& transform, double reach)
      : lookup_(map.grid),
        layers_(map),
        transform_(transform),
        end_{splat(static_cast<float>(map.grid.voxels().x())), splat(static_cast<float>(map.grid.voxels().y())),
             splat(static_cast<float>(map.grid.voxels().z()))},
        per_size_(splat(static_cast<float>(1.0 / map.grid.size))),
        reach_(splat(k_rounding + static_cast<float>(reach))) {}

  /// Writes first + i for every such child i, ascending, followed by up to k_width undefined values.
  /// @return the number of such children
  HWY_INLINE std::size_t write_near(const PointTree::Node& node, std::uint32_t first, std::uint32_t* out) const {
    std::size_t count = 0;
    for (std::size_t l = 0; l < PointTree::k_width; l += hn::Lanes(k_floats)) {
      const auto row = [&](std::size_t r) HWY_ATTR { return hn::Load(k_floats, node.sphere[r] + l); };
      HWY_ALIGN std::uint8_t near[8] = {};  // as many as StoreMaskBits may write
      hn::StoreMaskBits(k_floats, is_near({row(0), row(1), row(2)}, row(3)), near);
      const auto bits = hn::PromoteTo(k_words, hn::LoadU(k_bytes, k_set_bits[near[0]].data()));
      hn::StoreU(hn::Add(bits, hn::Set(k_words, first + static_cast<std::uint32_t>(l))), k_words, out + count);
      count += static_cast<std::size_t>(std::popcount(near[0]));
    }
    return count;
  }

 private:
  HWY_INLINE hn::Mask<Floats> is_near(const Vec3& center, F radius) const {
    const F zero = hn::Zero(k_floats);
    const Vec3 q = transform_ * center;
    const F reach = hn::Add(hn::Mul(radius, per_size_), reach_);  // negative where there is no child
    // A centre outside the grid is projected to the grid's border. The surface is on the other side of that border, so
    // its distance is at least the hypotenuse of the distances to and from the projection.
    const Vec3 projected{hn::Min(hn::Max(q.x, zero), end_.x), hn::Min(hn::Max(q.y, zero), end_.y),
                         hn::Min(hn::Max(q.z, zero), end_.z)};
    const Vec3 outside = minus(q, projected);
    const Cell cell = lookup_.cell(q);
    const F half = splat(0.5f);
    const Vec3 off = minus(projected, plus(cell.low, {half, half, half}));
    // A line from here to a voxel with v >= 0 enters the first such voxel at a surface voxel, within half a diagonal of
    // its centre. outside_distance() is between the centres of voxels.
    const F distance = hn::Max(
        hn::Sub(hn::Sub(layers_.outside_distance(cell), splat(k_half_diagonal)), hn::Sqrt(dot(off, off))), zero);
    const F squared = hn::Add(dot(outside, outside), hn::Mul(distance, distance));
    return hn::And(hn::Ge(reach, zero), hn::Le(squared, hn::Mul(reach, reach)));
  }

  GridLookup lookup_;
  LayerLookup layers_;
  TransformLanes transform_;
  Vec3 end_;
  F per_size_, reach_;
};

/// Breadth first. @return the number of leaves; they are in scratch.current
std::size_t cull(const PointTree::Node* nodes, const std::uint32_t* first_child, std::uint32_t last_level,
                 const VoxelMap& map, const VoxelTransform& transform, double reach, PointTree::Scratch& scratch) {
  const NodeTest test(map, transform, reach);
  if (scratch.current.empty()) scratch.current.resize(1);
  scratch.current[0] = 0;
  std::size_t count = 1;
  for (bool last = false; !last && count > 0;) {
    last = scratch.current[0] >= last_level;
    if (scratch.next.size() < (count + 1) * PointTree::k_width) {
      scratch.next.resize(2 * (count + 1) * PointTree::k_width);
    }
    const std::uint32_t* const current = scratch.current.data();
    std::uint32_t* const next = scratch.next.data();
    std::size_t found = 0;
    for (std::size_t i = 0; i < count; ++i) {
      found += test.write_near(nodes[current[i]], first_child[current[i]], next + found);
    }
    count = found;
    std::swap(scratch.current, scratch.next);
  }
  return count;
}

/// Depth first, some nodes at a time.
bool any_leaves(const PointTree::Node* nodes, const std::uint32_t* first_child, std::uint32_t last_level,
                const VoxelMap& map, const VoxelTransform& transform, double reach, PointTree::Scratch& scratch,
                const PointTree::LeafTest& accept) {
  constexpr std::size_t k_batch = 8;  // nodes whose tests the processor can overlap
  constexpr std::size_t k_room = (k_batch + 1) * PointTree::k_width;
  const NodeTest test(map, transform, reach);
  std::vector<std::uint32_t>& stack = scratch.current;
  if (stack.size() < k_room) stack.resize(k_room);
  stack[0] = 0;
  std::uint32_t leaves[k_room];
  for (std::size_t size = 1; size > 0;) {
    std::uint32_t batch[k_batch];
    const std::size_t count = std::min(size, k_batch);
    size -= count;
    std::copy_n(stack.data() + size, count, batch);
    if (stack.size() < size + k_room) stack.resize(2 * (size + k_room));
    std::size_t found = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const bool last = batch[i] >= last_level;
      const std::size_t near =
          test.write_near(nodes[batch[i]], first_child[batch[i]], last ? leaves + found : stack.data() + size);
      (last ? found : size) += near;
    }
    if (found > 0 && accept(std::span(leaves, found))) return true;
  }
  return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::vps
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace sixdof::vps {

HWY_EXPORT(cull);
HWY_EXPORT(any_leaves);

VoxelTransform VoxelTransform::of(const Pose& X, const Eigen::Vector3d& center, const VoxelGrid& grid) {
  return {.rotation = X.R.cast<float>(),
          .scaled = (X.R / grid.size).cast<float>(),
          .center = grid.coordinates(X * center).cast<float>()};
}

namespace {

/// Points `begin` to `end` - 1 of an ordering.
struct Range {
  std::size_t begin, end;
  std::size_t leaves() const { return (end - begin + PointTree::k_leaf_points - 1) / PointTree::k_leaf_points; }
};

/// Sorts the points of a range into `parts` of nearly equal size and whole leaves, and appends them.
void split(const PointShell& shell, std::vector<std::uint32_t>& order, Range range, std::size_t parts,
           std::vector<Range>& out) {
  if (parts == 1) {
    out.push_back(range);
    return;
  }
  Eigen::AlignedBox3d box;
  for (std::size_t i = range.begin; i < range.end; ++i) box.extend(shell.points[order[i]]);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t low = (parts + 1) / 2;
  const std::size_t middle = range.begin + (range.leaves() * low + parts - 1) / parts * PointTree::k_leaf_points;
  const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(range.begin), at(middle), at(range.end), [&](std::uint32_t i, std::uint32_t j) {
    const double a = shell.points[i][axis], b = shell.points[j][axis];
    return a != b ? a < b : i < j;
  });
  split(shell, order, {range.begin, middle}, low, out);
  split(shell, order, {middle, range.end}, parts - low, out);
}

PointTree::Node enclose(const PointShell& shell, const Eigen::Vector3d& center, const std::vector<std::uint32_t>& order,
                        std::span<const Range> children) {
  PointTree::Node node{};
  std::fill_n(node.sphere[3], PointTree::k_width, -std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < children.size(); ++i) {
    const Range& part = children[i];
    Eigen::AlignedBox3d box;
    for (std::size_t k = part.begin; k < part.end; ++k) box.extend(shell.points[order[k]]);
    const Eigen::Vector3d middle = box.center();
    double radius = 0.0;
    for (std::size_t k = part.begin; k < part.end; ++k) {
      radius = std::max(radius, (shell.points[order[k]] - middle).norm());
    }
    const Eigen::Vector3f relative = (middle - center).cast<float>();
    for (Eigen::Index k = 0; k < 3; ++k) node.sphere[k][i] = relative[k];
    node.sphere[3][i] = static_cast<float>(radius);
  }
  return node;
}

}  // namespace

PointTree::PointTree(const PointShell& shell, const Eigen::Vector3d& center, bool by_area)
    : center_(center), points_(shell.points.size()) {
  std::vector<std::uint32_t> order(points_);
  std::iota(order.begin(), order.end(), 0u);
  std::vector<Range> level{{0, points_}};
  leaves_ = static_cast<std::uint32_t>(level.front().leaves());
  std::size_t child_leaves = 1;  // most leaves of a child on this level
  while (child_leaves * k_width < leaves_) child_leaves *= k_width;
  for (; child_leaves > 0; child_leaves /= k_width) {
    last_level_ = static_cast<std::uint32_t>(nodes_.size());
    const auto next_level = static_cast<std::uint32_t>(child_leaves > 1 ? nodes_.size() + level.size() : 0);
    std::vector<Range> next;
    for (const Range& range : level) {
      const std::size_t first = next.size();
      split(shell, order, range, (range.leaves() + child_leaves - 1) / child_leaves, next);
      first_child_.push_back(next_level + static_cast<std::uint32_t>(first));
      nodes_.push_back(enclose(shell, center_, order, std::span(next).subspan(first)));
    }
    level = std::move(next);
  }
  blocks_.resize(leaves_ * k_rows * k_leaf_points);
  for (std::size_t i = 0; i < leaves_ * k_leaf_points; ++i) {
    const std::uint32_t p = order[std::min(i, points_ - 1)];
    const Eigen::Vector3f position = (shell.points[p] - center_).cast<float>(), normal = shell.normals[p].cast<float>();
    const float weight = i >= points_ ? 0.0f : by_area ? static_cast<float>(shell.areas[p]) : 1.0f;
    float* const lane = blocks_.data() + i / k_leaf_points * k_rows * k_leaf_points + i % k_leaf_points;
    const float row[k_rows] = {position.x(), position.y(), position.z(), weight, normal.x(), normal.y(), normal.z()};
    for (std::size_t r = 0; r < k_rows; ++r) lane[r * k_leaf_points] = row[r];
  }
}

std::span<const std::uint32_t> PointTree::cull(const VoxelMap& map, const VoxelTransform& transform, double reach,
                                               Scratch& scratch) const {
  const std::size_t count =
      HWY_DYNAMIC_DISPATCH(cull)(nodes_.data(), first_child_.data(), last_level_, map, transform, reach, scratch);
  return std::span(scratch.current).first(count);
}

bool PointTree::any_leaves(const VoxelMap& map, const VoxelTransform& transform, double reach, Scratch& scratch,
                           const LeafTest& accept) const {
  return HWY_DYNAMIC_DISPATCH(any_leaves)(nodes_.data(), first_child_.data(), last_level_, map, transform, reach,
                                          scratch, accept);
}

}  // namespace sixdof::vps
#endif  // HWY_ONCE
