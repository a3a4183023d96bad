#include <sixdof/generation/ray_cast_ties.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace sixdof::ray_cast {
namespace {

constexpr std::size_t k_width = Tree::k_width;

/// So much credit is kept, whatever was saved: one configuration is not to spend what a thousand did not need.
constexpr std::uint64_t k_most_credit = 1024;

/// Heights may be too low by this, in units of the tree's radius, where that saves looking at all that is as low: more
/// than the rounding that bounds are lowered by.
constexpr double k_height_room = 2e-15;
/// Rounding of bounds of heights, in the same units: of some fifteen products and sums.
constexpr double k_height_rounding = 1e-15;
/// A subtree's height mostly takes no more than this, a node of each level.
constexpr std::uint64_t k_least_credit = 64;

/// Axes of pairs that tie differ by rounding. Heights along this close an axis are off by less than half of what ties
/// may be off (k_cast_tie) for points within Cast::size().
constexpr double k_same_axis = 5e-16;

/// Axes that are turned by more than this, an angle of 1.4e-4, are others: bucket 0 is off by some 1e-5.
constexpr double k_least_cosine = 1.0 - 1e-8;

/// Axes that are turned from a normal by more than this, an angle of 1.4e-3, do not stand on the face: triangles of a
/// flat patch are turned by less.
constexpr double k_least_face_cosine = 1.0 - 1e-6;

}  // namespace

double lowest_difference(const TriangleCorners& mirrored, const TriangleCorners& b, const Eigen::Vector3d& axis) {
  return std::min({axis.dot(mirrored[0]), axis.dot(mirrored[1]), axis.dot(mirrored[2])}) +
         std::min({axis.dot(b[0]), axis.dot(b[1]), axis.dot(b[2])});
}

Eigen::Vector3d sharp_axis(const TriangleCorners& mirrored, const TriangleCorners& b, const Eigen::Vector3d& axis,
                           double room) {
  Eigen::Vector3d best = axis;
  double height = lowest_difference(mirrored, b, axis) - room;
  const auto try_out = [&](const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    const Eigen::Vector3d across = u.cross(v);
    const double along = across.dot(axis);
    const double length = across.norm();
    if (!(std::abs(along) >= k_least_cosine * length) || !(length > 0.0)) return;
    const Eigen::Vector3d n = across / std::copysign(length, along);
    const double height_of_n = lowest_difference(mirrored, b, n);
    if (!(height_of_n > height)) return;
    height = height_of_n;
    best = n;
  };
  const auto edge = [](const TriangleCorners& t, std::size_t i) -> Eigen::Vector3d { return t[(i + 1) % 3] - t[i]; };
  try_out(edge(mirrored, 0), edge(mirrored, 1));
  try_out(edge(b, 0), edge(b, 1));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) try_out(edge(mirrored, i), edge(b, j));
  }
  return best;
}

void CastFace::note(const Eigen::Vector3d& normal, float size, const Eigen::Vector3d& axis,
                    const Eigen::Vector3d& direction) {
  CastFace face;
  face.normal_ = normal.dot(direction) < 0.0 ? Eigen::Vector3d(-normal) : normal;
  face.size_ = size;
  if (face.faces(axis, direction)) *this = face;
}

bool CastFace::faces(const Eigen::Vector3d& axis, const Eigen::Vector3d& direction) const {
  return size_ > 0.0f && normal_.dot(axis) >= k_least_face_cosine && normal_.dot(direction) >= 0.0;
}

CastSupports::CastSupports(const CastTree& tree)
    : tree_(&tree), room_(k_height_room * tree.radius()), rounding_(k_height_rounding * tree.radius()) {}

void CastSupports::set_axis(const Eigen::Vector3d& axis) {
  axis_ = tree_->matrix().transpose() * axis;
  ++round_;
}

double CastSupports::lowest(std::size_t node_and_lane, std::uint64_t& credit) {
  if (heights_.empty()) heights_.resize(k_width * tree_->nodes().size());
  Height& height = heights_[node_and_lane];
  if (height.round == round_) return height.value;
  const CastChild from = child(node_and_lane);
  const std::uint64_t triangles = from.is_leaf() ? tree_->mesh().leaf_children()[from.index()].count()
                                                 : tree_->mesh().tree().nodes()[from.index()].triangle_count;
  if (credit < std::min(triangles, k_least_credit)) return k_unknown;
  const std::uint64_t before = looked_at_;
  const std::uint64_t most = before + credit;
  const Found found = look_into(from, {.least = -k_unknown, .most = most});
  credit -= std::min(credit, looked_at_ - before);
  height = {std::min(found.low, found.least), round_};
  return height.value;
}

void CastSupports::bound_children(const CastPatches& patches, double* low) const {
  const double a[3] = {axis_[0], axis_[1], axis_[2]};
  for (std::size_t i = 0; i < k_width; ++i) {
    const double along = a[0] * patches.normal[0][i] + a[1] * patches.normal[1][i] + a[2] * patches.normal[2][i];
    double in_slab = along * patches.middle[i] - std::abs(along) * patches.half[i];
    double in_box = -rounding_;
    for (std::size_t k = 0; k < 3; ++k) {
      const double rest = a[k] - along * patches.normal[k][i];
      in_slab += rest * patches.box_center[k][i] - std::abs(rest) * patches.box_half[k][i];
      in_box += a[k] * patches.box_center[k][i] - std::abs(a[k]) * patches.box_half[k][i];
    }
    low[i] = std::max(in_slab - rounding_, in_box);
  }
}

CastSupports::Found CastSupports::look_into(CastChild from, Limits limits) {
  Found found;
  if (from.is_leaf()) {
    const Tree::Child leaf = tree_->mesh().leaf_children()[from.index()];
    const Tree& tree = tree_->mesh().tree();
    for (std::uint32_t t = leaf.first(); t < leaf.first() + leaf.count(); ++t) {
      for (const Eigen::Vector3d& corner : tree.corners()[t]) {
        found.least = std::min(found.least, axis_.dot(corner - tree.center()));
      }
    }
    looked_at_ += leaf.count();
    return found;
  }
  const std::size_t count = tree_->nodes()[from.index()].child_count;
  alignas(64) double low[k_width];
  bound_children(tree_->mesh().patches()[from.index()], low);
  looked_at_ += count;
  for (std::size_t i = 0; i < count; ++i) {
    const auto lane = static_cast<std::size_t>(std::min_element(low, low + count) - low);
    limits.least = std::min(limits.least, found.least);
    if (low[lane] >= limits.least - room_ || looked_at_ >= limits.most) {
      found.low = std::min(found.low, low[lane]);
      break;
    }
    low[lane] = -k_unknown;
    const std::size_t next = k_width * from.index() + lane;
    const Found below = look_into(child(next), limits);
    if (below.least <= below.low + room_) heights_[next] = {std::min(below.low, below.least), round_};
    found.low = std::min(found.low, below.low);
    found.least = std::min(found.least, below.least);
  }
  return found;
}

double CastTies::lowest(std::size_t child_a, std::size_t child_b, const Eigen::Vector3d& axis, std::uint64_t pay) {
  credit_ = std::min(credit_ + pay, k_most_credit);
  if (!known_ || (axis - axis_).cwiseAbs().maxCoeff() > k_same_axis) {
    known_ = true;
    axis_ = axis;
    a_.set_axis(axis);
    b_.set_axis(axis);
  }
  const double low_a = a_.lowest(child_a, credit_);
  return low_a == CastSupports::k_unknown ? low_a : low_a + b_.lowest(child_b, credit_);
}

}  // namespace sixdof::ray_cast
