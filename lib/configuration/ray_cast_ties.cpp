#include <sixdof/configuration/ray_cast_ties.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace sixdof::ray_cast {
namespace {

constexpr std::size_t k_width = Tree::k_width;

/// Triangles that one try pays for: some two or three times what looking into a pair in vain costs.
constexpr std::uint64_t k_per_try = 16;

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

void CastSupports::set_axis(const Eigen::Vector3d& axis) {
  axis_ = axis;
  ++round_;
}

double CastSupports::lowest(std::size_t node_and_lane, std::uint64_t& credit) {
  if (heights_.empty()) heights_.resize(k_width * tree_->nodes().size());
  if (heights_[node_and_lane].round == round_) return heights_[node_and_lane].value;
  const CastChild child = tree_->nodes()[node_and_lane / k_width].child[node_and_lane % k_width];
  const CastMesh& mesh = tree_->mesh();
  const std::uint64_t triangles =
      child.is_leaf() ? mesh.leaf_children()[child.index()].count() : mesh.tree().nodes()[child.index()].triangle_count;
  if (triangles > credit) return k_unknown;
  const std::uint64_t before = triangles_;
  const double height = find(node_and_lane);
  credit -= triangles_ - before;
  return height;
}

double CastSupports::find(std::size_t node_and_lane) {
  if (heights_[node_and_lane].round == round_) return heights_[node_and_lane].value;
  const CastChild child = tree_->nodes()[node_and_lane / k_width].child[node_and_lane % k_width];
  double low = std::numeric_limits<double>::infinity();
  if (child.is_leaf()) {
    const Tree::Child leaf = tree_->mesh().leaf_children()[child.index()];
    for (std::uint32_t t = leaf.first(); t < leaf.first() + leaf.count(); ++t) {
      for (const Eigen::Vector3d& corner : tree_->triangle(t)) low = std::min(low, axis_.dot(corner));
    }
    triangles_ += leaf.count();
  } else {
    for (std::size_t lane = 0; lane < tree_->nodes()[child.index()].child_count; ++lane) {
      low = std::min(low, find(k_width * child.index() + lane));
    }
  }
  heights_[node_and_lane] = {low, round_};
  return low;
}

bool CastTies::apart(std::size_t child_a, std::size_t child_b, const Eigen::Vector3d& axis, double along, double gap) {
  credit_ += k_per_try;
  if (!known_ || (axis - axis_).cwiseAbs().maxCoeff() > k_same_axis) {
    known_ = true;
    axis_ = axis;
    a_.set_axis(axis);
    b_.set_axis(axis);
  }
  const double low_a = a_.lowest(child_a, credit_);
  if (low_a == CastSupports::k_unknown) return false;
  return along + low_a + b_.lowest(child_b, credit_) >= gap;
}

}  // namespace sixdof::ray_cast
