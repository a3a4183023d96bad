#include <sixdof/oracle/winding.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include <sixdof/oracle/crossing.h>

namespace sixdof::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// The mesh's box in the mesh's frame, enlarged by `slack` on all sides.
AlignedBox3d box_of(const Tree& tree, double slack) {
  const Tree::Volume& volume = tree.nodes()[0].volume;
  const auto corner = [&](const float* x) {
    return Vector3d(tree.center() + Eigen::Map<const Eigen::Vector3f>(x).cast<double>());
  };
  return {corner(volume.lower) - Vector3d::Constant(slack), corner(volume.upper) + Vector3d::Constant(slack)};
}

/// End of the shortest axis-parallel segment from `p` to a point outside of the box; none if `p` is outside.
std::optional<Vector3d> exit_point(const AlignedBox3d& box, const Vector3d& p) {
  if (!box.contains(p)) return std::nullopt;
  Vector3d end = p;
  double shortest = std::numeric_limits<double>::infinity();
  const double margin = 0.01 * box.sizes().maxCoeff();  // far above rounding
  for (int k = 0; k < 3; ++k) {
    for (const double face : {box.min()[k] - margin, box.max()[k] + margin}) {
      if (std::abs(face - p[k]) < shortest) {
        shortest = std::abs(face - p[k]);
        end = p;
        end[k] = face;
      }
    }
  }
  return end;
}

/// Finds the triangles of the leaves whose boxes overlap `box` (in the mesh's frame), and no fewer for rounding.
void find_in_box(const Tree& tree, const AlignedBox3d& box, std::vector<std::uint32_t>& triangles) {
  triangles.clear();
  // Rounding to float, and of the difference from the tree's centre.
  const double slack = 1e-6 * (tree.radius() + box.diagonal().norm()) + 1e-15 * tree.center().lpNorm<1>();
  float lower[3], upper[3];
  for (int k = 0; k < 3; ++k) {
    lower[k] = static_cast<float>(box.min()[k] - tree.center()[k] - slack);
    upper[k] = static_cast<float>(box.max()[k] - tree.center()[k] + slack);
  }
  const auto expand = [&](auto&& self, const Tree::Node& node) -> void {
    for (std::size_t i = 0; i < node.child_count; ++i) {
      bool apart = false;
      for (std::size_t k = 0; k < 3; ++k) apart = apart || node.lower[k][i] > upper[k] || node.upper[k][i] < lower[k];
      if (apart) continue;
      const Tree::Child child = node.child[i];
      if (!child.is_leaf()) {
        self(self, tree.nodes()[child.node()]);
        continue;
      }
      for (std::uint32_t t = child.first(); t < child.first() + child.count(); ++t) triangles.push_back(t);
    }
  };
  expand(expand, tree.nodes()[0]);
}

/// Whether a triangle is certainly not met by a segment within a box: it lies beyond one of the box's faces.
bool misses(const Tree::Corners& c, const AlignedBox3d& box) {
  return (c[0].cwiseMin(c[1]).cwiseMin(c[2]).array() > box.max().array()).any() ||
         (c[0].cwiseMax(c[1]).cwiseMax(c[2]).array() < box.min().array()).any();
}

/// @param p the point in A's frame, p_mesh in the mesh's frame
/// @param slack above the rounding of p_mesh and of transformed corners
/// @param to_a maps points of the mesh to A's frame
/// @param add takes each term: the triangle in tree order, and 1 or -1
template <class ToA, class Add>
void find_terms(const Tree& tree, const Vector3d& p, const Vector3d& p_mesh, double slack, Perturbed perturbed,
                const ToA& to_a, std::vector<std::uint32_t>& triangles, const Add& add) {
  const std::optional<Vector3d> end = exit_point(box_of(tree, slack), p_mesh);
  if (!end) return;
  const AlignedBox3d around(p_mesh.cwiseMin(*end) - Vector3d::Constant(slack),
                            p_mesh.cwiseMax(*end) + Vector3d::Constant(slack));
  find_in_box(tree, around, triangles);
  const Vector3d q = to_a(*end);
  for (const std::uint32_t t : triangles) {
    const Tree::Corners& c = tree.corners()[t];
    if (misses(c, around)) continue;
    const int entered = pierce(p, q, {to_a(c[0]), to_a(c[1]), to_a(c[2])}, perturbed);
    if (entered != 0) add(t, -entered);
  }
}

constexpr double k_slack = 1e-12;  // relative to the lengths that are added

}  // namespace

int winding_of_a(const Tree& a, const Vector3d& p, std::vector<std::uint32_t>& triangles) {
  int sum = 0;
  for_each_winding_term(a, p, triangles, [&](std::uint32_t, int n) { sum += n; });
  return sum;
}

void for_each_winding_term(const Tree& a, const Vector3d& p, std::vector<std::uint32_t>& triangles,
                           const std::function<void(std::uint32_t i, int n)>& add) {
  const double slack = k_slack * (2.0 * a.radius() + p.lpNorm<1>());
  const auto to_a = [](const Vector3d& x) -> const Vector3d& { return x; };
  find_terms(a, p, p, slack, Perturbed::edge, to_a, triangles, add);
}

int winding_of_b(const Tree& b, const Pose& X_AB, PointTransform transform, const Vector3d& p,
                 std::vector<std::uint32_t>& triangles) {
  const double slack = k_slack * (2.0 * b.radius() + p.lpNorm<1>() + X_AB.t.lpNorm<1>());
  const auto to_a = [&](const Vector3d& x) { return transform(X_AB, x); };
  int sum = 0;
  find_terms(b, p, X_AB.inverse() * p, slack, Perturbed::triangle, to_a, triangles,
             [&](std::uint32_t, int n) { sum += n; });
  return sum;
}

}  // namespace sixdof::detail
