#include <sixdof/oracle/far_pair.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <sixdof/proximity/close_search.h>

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;

/// Where only corners matter, what reaches farther by no more than this times the distance is not looked for. From 1e9
/// diameters on that is more than what floats blur in a volume, so that a face across w costs no more than a corner.
constexpr double k_unit_in_last_place = 0x1p-52;
/// Elsewhere, what is closer by no more than this times the distance. More than the rounding of a pair's coordinates in
/// A's frame and of its distance: so the first of many equal pairs ends the search.
constexpr double k_roundings = 8.0 * 0x1p-53;

/// Search for the corner of a mesh that reaches farthest along a direction.
class FarthestCorner {
 public:
  /// @param along of length 1, in the mesh's axes
  /// @param tolerance a corner that reaches farther by less need not be found (length)
  FarthestCorner(const Tree& tree, const Vector3d& along, double tolerance, TraversalCounts& counts)
      : tree_(tree), along_(along), tolerance_(tolerance), counts_(counts) {
    visit(0);
  }

  double reach() const { return farthest_; }
  std::uint32_t triangle() const { return triangle_; }  ///< In tree order.
  const Vector3d& point() const { return tree_.corners()[triangle_][corner_]; }

 private:
  struct Volume {
    std::uint32_t number;
    double reach;
  };

  /// @param number as in Tree::Node::number
  void visit(std::uint32_t number) {
    ++counts_.nodes;
    if ((number & Tree::k_leaf_number) != 0) return visit_corners(tree_.leaves()[number - Tree::k_leaf_number].child);
    const Tree::Node& node = tree_.nodes()[number];
    std::array<Volume, Tree::k_width> children;
    for (std::size_t i = 0; i < node.child_count; ++i) {
      const CloseShape shape = shape_in_own_axes(tree_, CloseVolume::child_of(node, i));
      children[i] = {node.number[i], along_.dot(shape.center) + shape.reach(along_)};
    }
    const auto end = children.begin() + node.child_count;
    std::stable_sort(children.begin(), end, [](const Volume& x, const Volume& y) { return x.reach > y.reach; });
    for (auto child = children.begin(); child != end && child->reach > farthest_ + tolerance_; ++child) {
      visit(child->number);
    }
  }

  void visit_corners(const Tree::Child& leaf) {
    for (std::uint32_t t = leaf.first(); t < leaf.first() + leaf.count(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double reach = along_.dot(tree_.corners()[t][i] - tree_.center());
        if (!(reach > farthest_)) continue;
        farthest_ = reach;
        triangle_ = t;
        corner_ = i;
      }
    }
  }

  const Tree& tree_;
  const Vector3d along_;
  const double tolerance_;
  TraversalCounts& counts_;
  double farthest_ = -std::numeric_limits<double>::infinity();
  std::uint32_t triangle_ = 0;
  std::size_t corner_ = 0;
};

/// The length of a vector that is not zero; its square may overflow or underflow.
double length_of(const Vector3d& x) {
  const int exponent = std::ilogb(x.cwiseAbs().maxCoeff());
  return std::ldexp((std::ldexp(1.0, -exponent) * x).norm(), exponent);
}

/// Search for the closest pair of triangles: depth first, the pair of volumes with the smallest bound first.
class FarSearch {
 public:
  /// @param along,centers from A's centre to B's: direction of length 1, and length
  /// @param least_along lower bound on x of far_pair.h over all points. Floats blur the volumes of a face across
  /// `along`; this bounds all of them alike.
  FarSearch(DistanceSearch& search, const Vector3d& along, double centers, double least_along)
      : search_(search),
        tree_a_(search.a.tree),
        tree_b_(search.b.tree),
        bounds_(tree_a_, tree_b_, concentric(search)),
        along_(along),
        back_(-(search.X_AB.R.transpose() * along)),
        centers_(centers),
        least_along_(least_along) {
    visit({{0}, {0}, 0.0});
  }

 private:
  /// B as it is turned, its centre in A's.
  static Pose concentric(const DistanceSearch& search) {
    Pose pose = search.X_AB;
    pose.t = search.a.tree.center() - pose.R * search.b.tree.center();
    return pose;
  }

  /// The minimum of far_pair.h's term for points that reach so far.
  double term(double along, double across) const {
    return along + along * (along / (2.0 * centers_)) + across * (across / (2.0 * centers_));
  }

  /// A volume, and how far it reaches along w (of A) or -w (of B) from the centre of its tree.
  struct Part {
    CloseShape shape;
    double reach;
  };

  Part part_of_a(const CloseVolume& v) const {
    const CloseShape shape = bounds_.shape_of_a(v);
    const double reach =
        is_whole_leaf(v) ? reach_of(tree_a_, v, along_) : along_.dot(shape.center) + shape.reach(along_);
    return {shape, reach};
  }

  Part part_of_b(const CloseVolume& v) const {
    const CloseShape shape = bounds_.shape_of_b(v);
    const double reach =
        is_whole_leaf(v) ? reach_of(tree_b_, v, back_) : shape.reach(-along_) - along_.dot(shape.center);
    return {shape, reach};
  }

  static bool is_whole_leaf(const CloseVolume& v) {
    return (v.volume & CloseVolume::k_leaf) != 0 && v.triangle == CloseVolume::k_whole;
  }

  /// Of a leaf's triangles: floats blur its volume by more than they differ.
  /// @param along in the mesh's axes
  static double reach_of(const Tree& tree, const CloseVolume& leaf, const Vector3d& along) {
    const Tree::Child& triangles = tree.leaves()[leaf.volume - CloseVolume::k_leaf].child;
    double reach = -std::numeric_limits<double>::infinity();
    for (std::uint32_t t = triangles.first(); t < triangles.first() + triangles.count(); ++t) {
      for (const Vector3d& corner : tree.corners()[t]) reach = std::max(reach, along.dot(corner - tree.center()));
    }
    return reach;
  }

  double lower_bound(const Part& a, const Part& b) const {
    const Vector3d d = b.shape.center - a.shape.center;
    const Vector3d rest = d - along_.dot(d) * along_;
    const double length = rest.norm();
    double across = 0.0;
    if (length > 0.0) {
      const Vector3d unit = rest / length;
      across = std::max(0.0, length - a.shape.reach(unit) - b.shape.reach(-unit) - bounds_.slack());
    }
    return term(std::max(-a.reach - b.reach - bounds_.slack(), least_along_), across);
  }

  void visit(const ClosePair& pair) {
    if (pair.is_of_triangles()) return measure({pair.a.triangle, pair.b.triangle});
    ++search_.counts.nodes;
    const Part a = part_of_a(pair.a), b = part_of_b(pair.b);
    const bool expands_a =
        b.shape.is_triangle || (!a.shape.is_triangle && a.shape.squared_size >= b.shape.squared_size);
    std::array<CloseVolume, Tree::k_width> parts;
    const std::uint32_t count = parts_of(expands_a ? tree_a_ : tree_b_, expands_a ? pair.a : pair.b, parts);
    std::array<ClosePair, Tree::k_width> pairs;
    for (std::uint32_t i = 0; i < count; ++i) {
      pairs[i] = expands_a ? ClosePair{parts[i], pair.b, lower_bound(part_of_a(parts[i]), b)}
                           : ClosePair{pair.a, parts[i], lower_bound(a, part_of_b(parts[i]))};
    }
    const auto end = pairs.begin() + count;
    std::stable_sort(pairs.begin(), end, [](const ClosePair& x, const ClosePair& y) { return x.lower < y.lower; });
    for (auto next = pairs.begin(); next != end && next->lower < least_ - k_roundings * centers_; ++next) visit(*next);
  }

  void measure(TrianglePair pair) {
    ++search_.counts.triangles;
    const ClosestPoints points = distance_of(search_, pair);
    const double attained = (points.distance - centers_) * ((points.distance + centers_) / (2.0 * centers_));
    if (!(attained < least_)) return;
    least_ = attained;
    search_.pair = pair;
    search_.closest = points;
  }

  DistanceSearch& search_;
  const Tree& tree_a_;
  const Tree& tree_b_;
  const CloseBounds bounds_;
  const Vector3d along_;
  const Vector3d back_;  ///< -along_ in B's axes.
  const double centers_;
  const double least_along_;
  double least_ = std::numeric_limits<double>::infinity();
};

Vector3d between_centers(const DistanceBody& a, const DistanceBody& b, const Pose& X_AB) {
  return X_AB * b.tree.center() - a.tree.center();
}

bool are_farther_than(double ratio, const DistanceBody& a, const DistanceBody& b, const Vector3d& between) {
  return between.cwiseAbs().maxCoeff() > ratio * (a.tree.radius() + b.tree.radius());
}

}  // namespace

bool are_far(const DistanceBody& a, const DistanceBody& b, const Pose& X_AB) {
  return are_farther_than(k_far, a, b, between_centers(a, b, X_AB));
}

void take_far_pair(DistanceSearch& search) {
  const Tree &a = search.a.tree, &b = search.b.tree;
  const Vector3d between = between_centers(search.a, search.b, search.X_AB);
  const double largest = between.cwiseAbs().maxCoeff();
  const bool only_corners = are_farther_than(k_corners, search.a, search.b, between);
  search.direction = (between / largest).normalized();
  const double tolerance = only_corners ? k_unit_in_last_place * largest : 0.0;
  const FarthestCorner of_a(a, search.direction, tolerance, search.counts);
  const FarthestCorner of_b(b, -(search.X_AB.R.transpose() * search.direction), tolerance, search.counts);
  if (only_corners) {
    const Vector3d on_b = search.X_AB * of_b.point();
    search.pair = {of_a.triangle(), of_b.triangle()};
    search.closest = ClosestPoints{length_of(on_b - of_a.point()), of_a.point(), on_b};
  } else {
    FarSearch(search, search.direction, length_of(between), -of_a.reach() - of_b.reach());
  }
  search.best = search.closest->distance;
  search.found = true;
}

}  // namespace sixdof::detail
