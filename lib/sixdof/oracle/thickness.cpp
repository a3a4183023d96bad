#include <sixdof/oracle/thickness.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

namespace sixdof {
namespace {

using Eigen::Vector3d;

/// Whether the line p + t n (p relative to the tree's centre) passes within `slack` of the box of a child.
bool meets_box(const Tree::Node& node, std::size_t i, const Vector3d& p, const Vector3d& n, double slack) {
  double first = -std::numeric_limits<double>::infinity(), last = -first;
  for (int k = 0; k < 3; ++k) {
    const double low = static_cast<double>(node.lower[k][i]) - slack - p[k];
    const double high = static_cast<double>(node.upper[k][i]) + slack - p[k];
    if (n[k] == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    const double x = low / n[k], y = high / n[k];
    first = std::max(first, std::min(x, y));
    last = std::min(last, std::max(x, y));
  }
  return first <= last;
}

/// Calls pass(t, sign) where the line passes a triangle: sign is 1 against its normal (into the body), -1 along it. The
/// products of an edge are those of its other triangle with the opposite sign, in every bit, so that no line slips
/// between two triangles.
template <class Pass>
void pass_triangle(const Tree::Corners& corners, const Vector3d& p, const Vector3d& n, const Pass& pass) {
  const Vector3d a = corners[0] - p, b = corners[1] - p, c = corners[2] - p;
  const double u = n.dot(b.cross(c)), v = n.dot(c.cross(a)), w = n.dot(a.cross(b));
  const bool along = u > 0.0 && v > 0.0 && w > 0.0, against = u < 0.0 && v < 0.0 && w < 0.0;
  if (!along && !against) return;
  const double sum = u + v + w;
  pass((u * n.dot(a) + v * n.dot(b) + w * n.dot(c)) / sum, along ? -1 : 1);
}

/// The same for all triangles of a tree.
template <class Pass>
void pass_all(const Tree& tree, const Vector3d& p, const Vector3d& n, const Pass& pass) {
  constexpr double k_slack = 1e-6;  // rounding of the boxes' floats is far below
  const Vector3d local = p - tree.center();
  const double slack = k_slack * tree.radius();
  const auto expand = [&](auto&& self, const Tree::Node& node) -> void {
    for (std::size_t i = 0; i < node.child_count; ++i) {
      if (!meets_box(node, i, local, n, slack)) continue;
      const Tree::Child child = node.child[i];
      if (!child.is_leaf()) {
        self(self, tree.nodes()[child.node()]);
        continue;
      }
      for (std::uint32_t k = child.first(); k < child.first() + child.count(); ++k) {
        pass_triangle(tree.corners()[k], p, n, pass);
      }
    }
  };
  expand(expand, tree.nodes()[0]);
}

}  // namespace

double Thickness::along(const Pose& X_AB, const Vector3d& p, const Vector3d& n, double reach) {
  passages_.clear();
  pass_all(*a_, p, n, [&](double t, int sign) { passages_.push_back({t, sign, 0}); });
  const Pose X_BA = X_AB.inverse();
  pass_all(*b_, X_BA * p, X_BA.R * n, [&](double t, int sign) { passages_.push_back({t, 0, sign}); });
  std::ranges::sort(passages_, {}, &Passage::t);
  int in_a = 0, in_b = 0;
  double nearest = reach, thickness = 0.0;
  for (std::size_t i = 0; i + 1 < passages_.size(); ++i) {
    in_a += passages_[i].of_a;
    in_b += passages_[i].of_b;
    if (in_a <= 0 || in_b <= 0) continue;
    // To the end of the piece, across passages within it.
    const double first = passages_[i].t;
    std::size_t k = i + 1;
    while (k + 1 < passages_.size() && in_a + passages_[k].of_a > 0 && in_b + passages_[k].of_b > 0) {
      in_a += passages_[k].of_a;
      in_b += passages_[k].of_b;
      ++k;
    }
    const double last = passages_[k].t, off = std::max({first, -last, 0.0});
    if (off <= nearest && (off < nearest || last - first > thickness)) {
      nearest = off;
      thickness = last - first;
    }
    i = k - 1;  // the passage at k ends the piece
  }
  return thickness;
}

double Thickness::at(const Pose& X_AB, const Vector3d& p, const Vector3d& n, double reach, double beside) {
  // The same lines for a normal and its opposite.
  const bool is_upwards = n.z() > 0.0 || (n.z() == 0.0 && (n.y() > 0.0 || (n.y() == 0.0 && n.x() > 0.0)));
  const Vector3d axis = is_upwards ? n : Vector3d(-n), u = axis.unitOrthogonal(), v = axis.cross(u);
  double thickest = 0.0;
  // No symmetry of a body has this angle.
  constexpr double k_cos = 0.8276, k_sin = 0.5613;
  for (const auto& [x, y] : {std::pair(k_cos, k_sin), {-k_sin, k_cos}, {-k_cos, -k_sin}, {k_sin, -k_cos}}) {
    thickest = std::max(thickest, along(X_AB, p + beside * (x * u + y * v), n, reach + beside));
  }
  return thickest;
}

}  // namespace sixdof
