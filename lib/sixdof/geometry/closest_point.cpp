#include <sixdof/geometry/closest_point.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <boost/container/static_vector.hpp>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/geometry/closest_point.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Squared distances of a point (relative to the tree's centre) to the node's eight boxes; infinite for empty lanes.
void box_distances(const Tree::Node& node, const std::array<float, 3>& p, float* squared) {
  const hn::CappedTag<float, Tree::k_width> d;
  for (std::size_t l = 0; l < Tree::k_width; l += hn::Lanes(d)) {
    auto sum = hn::Zero(d);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto x = hn::Set(d, p[k]);
      const auto below = hn::Sub(hn::Load(d, node.lower[k] + l), x);
      const auto above = hn::Sub(x, hn::Load(d, node.upper[k] + l));
      const auto out = hn::Max(hn::Max(below, above), hn::Zero(d));
      sum = hn::Add(sum, hn::Mul(out, out));
    }
    hn::Store(sum, d, squared + l);
  }
}

/// Error of a box distance in single precision, relative to |p| + radius: the rounding of the point and of about ten
/// operations.
constexpr double k_float_slack = 4e-7;

struct Candidate {
  float squared;
  Tree::Child child;
};

bool find_closest_point(const Tree& tree, const Eigen::Vector3d& p, double within, SurfacePoint& best) {
  const Eigen::Vector3d local = p - tree.center();
  const std::array<float, 3> q{static_cast<float>(local.x()), static_cast<float>(local.y()),
                               static_cast<float>(local.z())};
  // A box is expanded unless its computed distance exceeds the best distance by more than this: a length.
  const double slack = k_float_slack * (local.norm() + tree.radius());
  double best_squared = within * within;
  bool found = false;
  std::uint32_t best_position = 0;

  constexpr std::size_t k_deepest_tree = 64;
  // Unlike an array, it does not initialise the elements that a search never reaches: most of its cost otherwise.
  boost::container::static_vector<Candidate, k_deepest_tree * Tree::k_width> stack;
  stack.push_back({0.0f, Tree::Child::node(0)});
  while (!stack.empty()) {
    const Candidate next = stack.back();
    stack.pop_back();
    const double cutoff = std::sqrt(best_squared) + slack;
    if (next.squared > cutoff * cutoff) continue;
    if (next.child.is_leaf()) {
      for (std::uint32_t i = next.child.first(); i < next.child.first() + next.child.count(); ++i) {
        const Eigen::Vector3d on = closest_point_on_triangle(p, tree.corners()[i]);
        const double squared = (on - p).squaredNorm();
        if (squared < best_squared || (found && squared == best_squared && i < best_position)) {
          best_squared = squared;
          best.point = on;
          best_position = i;
          found = true;
        }
      }
      continue;
    }
    const Tree::Node& node = tree.nodes()[next.child.node()];
    alignas(64) float squared[Tree::k_width];
    box_distances(node, q, squared);
    // Insertion sort, farthest first, so that the nearest is on top of the stack.
    const std::size_t begin = stack.size();
    for (std::size_t i = 0; i < node.child_count; ++i) {
      if (squared[i] > cutoff * cutoff) continue;
      std::size_t at = stack.size();
      stack.push_back({squared[i], node.child[i]});
      for (; at > begin && stack[at - 1].squared < squared[i]; --at) stack[at] = stack[at - 1];
      stack[at] = {squared[i], node.child[i]};
    }
  }
  if (!found) return false;
  best.distance = std::sqrt(best_squared);
  best.triangle = tree.mesh_triangle()[best_position];
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof {

HWY_EXPORT(find_closest_point);

Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& p, const Tree::Corners& corners) {
  const auto& [a, b, c] = corners;
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + ab * (d1 / (d1 - d3));
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double sum = va + vb + vc;
  if (!(sum > 0.0)) return a;  // collinear corners
  return a + ab * (vb / sum) + ac * (vc / sum);
}

std::optional<SurfacePoint> closest_point(const Tree& tree, const Eigen::Vector3d& p, double within) {
  SurfacePoint best;
  if (!HWY_DYNAMIC_DISPATCH(find_closest_point)(tree, p, within, best)) return std::nullopt;
  return best;
}

}  // namespace sixdof
#endif
