#include <sixdof/oracle/support_bound.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

namespace sixdof::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Steps towards the best direction. Bodies that overlap take all of them in vain.
constexpr int k_steps = 2;
/// Bodies whose bounds are closer than this part of their radii are not tried further, nor those that overlap by more
/// than k_deep along the second direction.
constexpr double k_close = 0.03;
constexpr double k_deep = 0.2;

/// The largest d . (p - center) of all vertices.
class Farthest {
 public:
  explicit Farthest(const Tree& tree) : tree_(tree) {}

  /// @param guess a triangle that is probably far along d; then the farthest one
  double along(const Vector3d& d, std::uint32_t& guess) {
    best_ = height_of(d, guess);
    triangle_ = guess;
    visit(tree_.nodes()[0], d);
    guess = triangle_;
    return best_;
  }

 private:
  double height_of(const Vector3d& d, std::uint32_t triangle) const {
    double height = -std::numeric_limits<double>::infinity();
    for (const Vector3d& p : tree_.corners()[triangle]) height = std::max(height, d.dot(p - tree_.center()));
    return height;
  }

  void visit(const Tree::Node& node, const Vector3d& d) {
    std::array<std::pair<double, std::size_t>, Tree::k_width> order;
    std::size_t count = 0;
    for (std::size_t i = 0; i < node.child_count; ++i) {
      double upper = 0.0;
      for (int k = 0; k < 3; ++k) {
        upper += std::max(d[k] * static_cast<double>(node.lower[k][i]), d[k] * static_cast<double>(node.upper[k][i]));
      }
      if (upper > best_) order[count++] = {upper, i};
    }
    std::sort(order.begin(), order.begin() + count, std::greater<>());
    for (std::size_t k = 0; k < count && order[k].first > best_; ++k) {
      const Tree::Child child = node.child[order[k].second];
      if (!child.is_leaf()) {
        visit(tree_.nodes()[child.node()], d);
        continue;
      }
      for (std::uint32_t t = child.first(); t < child.first() + child.count(); ++t) {
        const double height = height_of(d, t);
        if (height > best_) {
          best_ = height;
          triangle_ = t;
        }
      }
    }
  }

  const Tree& tree_;
  double best_ = 0.0;
  std::uint32_t triangle_ = 0;
};

float rounded_up(double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); }

/// Whether an axis of one of the boxes, or one across two of their edges, separates them.
/// @param between from the centre of A's box to that of B's
bool boxes_apart(const Vector3d& half_a, const Vector3d& half_b, const Matrix3d& R, const Vector3d& between,
                 double slack) {
  const Matrix3d abs_R = R.cwiseAbs();
  if ((between.cwiseAbs() - half_a - abs_R * half_b).maxCoeff() > slack) return true;
  // The other axes take R for a rotation, which it is up to rounding.
  slack += 4.0 * (R.transpose() * R - Matrix3d::Identity()).cwiseAbs().maxCoeff() * half_b.sum();
  const Vector3d in_b = R.transpose() * between;
  if ((in_b.cwiseAbs() - half_b - abs_R.transpose() * half_a).maxCoeff() > slack) return true;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    for (int m = 0; m < 3; ++m) {
      // Across axis i of A and axis m of B: (0, -R(k, m), R(j, m)) in cyclic order.
      const int n = (m + 1) % 3, o = (m + 2) % 3;
      const double distance = std::abs(between[k] * R(j, m) - between[j] * R(k, m));
      const double extent =
          half_a[j] * abs_R(k, m) + half_a[k] * abs_R(j, m) + half_b[n] * abs_R(i, o) + half_b[o] * abs_R(i, n);
      if (distance - extent > slack) return true;
    }
  }
  return false;
}

}  // namespace

template <class Height>
void SupportBound::tabulate(const Height& height) {
  table_.resize(6 * k_points * k_points);
  for (std::size_t face = 0; face < 6; ++face) {
    const auto axis = static_cast<Eigen::Index>(face % 3);
    Vector3d d;
    d[axis] = face < 3 ? 1.0 : -1.0;
    for (std::size_t i = 0; i < k_points; ++i) {
      d[(axis + 1) % 3] = 2.0 * static_cast<double>(i) / k_cells - 1.0;
      for (std::size_t column = 0; column < k_points; ++column) {
        const std::size_t j = i % 2 == 0 ? column : k_cells - column;
        d[(axis + 2) % 3] = 2.0 * static_cast<double>(j) / k_cells - 1.0;
        table_[index(face, i, j)] = rounded_up(height(d));
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    half_[axis] = std::max(height(Vector3d::Unit(axis)), height(-Vector3d::Unit(axis)));
  }
}

SupportBound::SupportBound(const Tree& tree) : center_(tree.center()), radius_(tree.radius()) {
  Farthest farthest(tree);
  std::uint32_t guess = 0;
  tabulate([&](const Vector3d& d) { return farthest.along(d, guess); });
}

SupportBound::SupportBound(const Eigen::AlignedBox3d& box)
    : center_(box.center()), radius_(0.5 * (1.0 + 1e-15) * box.diagonal().norm()) {
  const Vector3d half = 0.5 * box.sizes();
  tabulate([&](const Vector3d& d) { return d.cwiseAbs().dot(half); });
}

SupportBound::Support SupportBound::along(const Vector3d& d) const {
  int axis = 0;
  const double largest = d.cwiseAbs().maxCoeff(&axis);
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  const double u = d[next] / largest, v = d[last] / largest;  // -1 .. 1
  const double x = 0.5 * k_cells * (u + 1.0), y = 0.5 * k_cells * (v + 1.0);
  const std::size_t i = std::min(static_cast<std::size_t>(x), k_cells - 1);
  const std::size_t j = std::min(static_cast<std::size_t>(y), k_cells - 1);
  const double right = x - static_cast<double>(i), up = y - static_cast<double>(j);
  const auto face = static_cast<std::size_t>(d[axis] < 0.0 ? axis + 3 : axis);
  const float* const low = &table_[index(face, i, j)];
  const float* const high = low + k_points;
  const double at_low = low[0] + up * (low[1] - low[0]), at_high = high[0] + up * (high[1] - high[0]);
  const double height = at_low + right * (at_high - at_low);
  const double by_u = 0.5 * k_cells * (at_high - at_low);
  const double by_v = 0.5 * k_cells * ((low[1] - low[0]) + right * ((high[1] - high[0]) - (low[1] - low[0])));
  Support support;
  support.height = largest * height;
  support.point[next] = by_u;
  support.point[last] = by_v;
  const double along_axis = height - u * by_u - v * by_v;
  support.point[axis] = d[axis] < 0.0 ? -along_axis : along_axis;
  return support;
}

bool certainly_apart(const SupportBound& a, const SupportBound& b, const Pose& X_AB) {
  if (a.empty() || b.empty()) return false;
  const Vector3d between = X_AB * b.center() - a.center();
  const double reach = a.radius() + b.radius();
  // Above the rounding of transformed vertices, and of what is computed here; far below the gaps of bodies in contact.
  const double slack =
      1e-13 * reach + (1e-14 * (a.center().cwiseAbs() + b.center().cwiseAbs() + X_AB.t.cwiseAbs())).sum();
  if (between.squaredNorm() > (reach + slack) * (reach + slack)) return true;
  if (boxes_apart(a.half(), b.half(), X_AB.R, between, slack)) return true;
  Vector3d difference = between;  // of a point of B and one of A, or nearly so
  for (int step = 0; step < k_steps; ++step) {
    const double length = difference.norm();
    if (!(length > k_close * reach)) return false;
    const Vector3d d = difference / length;
    const SupportBound::Support of_a = a.along(d), of_b = b.along(X_AB.R.transpose() * -d);
    const double gap = d.dot(between) - of_a.height - of_b.height;
    if (gap > slack) return true;
    if (step > 0 && gap < -k_deep * reach) return false;
    // Frank and Wolfe's step: the shortest difference on the way to the points that are nearest along d.
    const Vector3d way = between + X_AB.R * of_b.point - of_a.point - difference;
    const double squared = way.squaredNorm();
    if (!(squared > 0.0)) return false;
    difference += std::clamp(-difference.dot(way) / squared, 0.0, 1.0) * way;
  }
  return false;
}

}  // namespace sixdof::detail
