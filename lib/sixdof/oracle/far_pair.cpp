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

/// What reaches farther by no more than this times the distance is not looked for. From 1e9 diameters on that is more
/// than what floats blur in a volume, so that a face across w costs no more than a corner.
constexpr double k_unit_in_last_place = 0x1p-52;

/// Search for the corner of a mesh that reaches farthest along a direction.
class FarthestCorner {
 public:
  /// @param along of length 1, in the mesh's axes
  /// @param tolerance a corner that reaches farther by less need not be found (length)
  FarthestCorner(const Tree& tree, const Vector3d& along, double tolerance, TraversalCounts& counts)
      : tree_(tree), along_(along), tolerance_(tolerance), counts_(counts) {
    visit(0);
  }

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

Vector3d between_centers(const DistanceBody& a, const DistanceBody& b, const Pose& X_AB) {
  return X_AB * b.tree.center() - a.tree.center();
}

/// The length of a vector that is not zero; its square may overflow or underflow.
double length_of(const Vector3d& x) {
  const int exponent = std::ilogb(x.cwiseAbs().maxCoeff());
  return std::ldexp((std::ldexp(1.0, -exponent) * x).norm(), exponent);
}

}  // namespace

bool are_far(const DistanceBody& a, const DistanceBody& b, const Pose& X_AB) {
  return between_centers(a, b, X_AB).cwiseAbs().maxCoeff() > k_far * (a.tree.radius() + b.tree.radius());
}

void take_far_pair(DistanceSearch& search) {
  const Tree &a = search.a.tree, &b = search.b.tree;
  const Vector3d between = between_centers(search.a, search.b, search.X_AB);
  const double largest = between.cwiseAbs().maxCoeff();
  search.direction = (between / largest).normalized();
  const double tolerance = k_unit_in_last_place * largest;
  const FarthestCorner of_a(a, search.direction, tolerance, search.counts);
  const FarthestCorner of_b(b, -(search.X_AB.R.transpose() * search.direction), tolerance, search.counts);
  const Vector3d on_b = search.X_AB * of_b.point();
  search.pair = {of_a.triangle(), of_b.triangle()};
  search.closest = ClosestPoints{length_of(on_b - of_a.point()), of_a.point(), on_b};
  search.best = search.closest->distance;
  search.found = true;
}

}  // namespace sixdof::detail
