#include <sixdof/oracle/common_point.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Geometry>

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;

constexpr std::size_t k_planes = 8;

/// Nearer to the surface than this part of the point's coordinates, the way there is rounding, and a normal is taken.
constexpr double k_on_surface = 1e-13;
/// Part of the gain that the model promises that a point has to have to be the next.
constexpr double k_serious = 0.3;
constexpr double k_as_promised = 0.7;
/// tau grows by this factor where a step promises little, up to a multiple of the depth. Between surfaces at an angle w
/// a step is w tau / 2 long and promises w^2 tau / 4: so the multiple finds the way out of a wedge of 1e-4.
constexpr double k_longer = 4.0, k_longest_step = 1e8;
constexpr int k_most_exchanges = 40;
/// Steps shorter than this part of the coordinates end an ascent.
constexpr double k_shortest_step = 1e-13;

/// A linear bound on depth() around the current point.
struct Plane {
  Vector3d gradient = Vector3d::Zero();
  double value = 0.0;  ///< At the current point.
};

/// The bounds of an ascent, the oldest first.
class Bundle {
 public:
  void add(const Plane& plane) {
    if (count_ == k_planes) {
      std::move(planes_.begin() + 1, planes_.end(), planes_.begin());
      --count_;
    }
    planes_[count_++] = plane;
  }

  /// Makes the point at `step` the current one, where the depth is `depth`: bounds below it do not hold there.
  void move(const Vector3d& step, double depth) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      Plane plane = planes_[k];
      plane.value += plane.gradient.dot(step);
      if (plane.value >= depth) planes_[kept++] = plane;
    }
    count_ = kept;
  }

  /// The step that maximizes min over k of (value_k + gradient_k . x) - |x|^2 / (2 tau): x = tau times a convex
  /// combination of the gradients, whose weights are found by exchanges between two of them (the dual problem).
  Vector3d best_step(double tau) const {
    std::array<double, k_planes> weight{};
    weight[0] = 1.0;
    Vector3d sum = planes_[0].gradient;
    for (int exchange = 0; exchange < k_most_exchanges; ++exchange) {
      std::size_t low = 0, high = 0;
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (std::size_t k = 0; k < count_; ++k) {
        const double slope = planes_[k].value + tau * planes_[k].gradient.dot(sum);
        if (slope < least) {
          least = slope;
          low = k;
        }
        if (weight[k] > 0.0 && slope > most) {
          most = slope;
          high = k;
        }
      }
      const Vector3d change = planes_[low].gradient - planes_[high].gradient;
      const double curvature = tau * change.squaredNorm();
      if (low == high || most - least <= 1e-6 * tau) break;
      const double moved = curvature > 0.0 ? std::min(weight[high], (most - least) / curvature) : weight[high];
      weight[low] += moved;
      weight[high] -= moved;
      sum += moved * change;
    }
    return tau * sum;
  }

  double value_at(const Vector3d& step) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < count_; ++k) least = std::min(least, planes_[k].value + planes_[k].gradient.dot(step));
    return least;
  }

 private:
  std::array<Plane, k_planes> planes_;
  std::size_t count_ = 0;
};

Vector3d normal_of(const Mesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles()[triangle];
  const std::vector<Vector3d>& v = mesh.vertices();
  return (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).normalized();
}

/// Gradient of the depth in the mesh's frame: a unit vector.
Vector3d gradient_of(const DepthNode& node, const Mesh& mesh) {
  if (std::abs(node.s) <= k_on_surface * node.p.norm()) return -normal_of(mesh, node.triangle);
  return node.to_surface / node.s;
}

}  // namespace

CommonPoint CommonPointSearch::at(const Vector3d& p, const Pose& X_AB, std::uint32_t triangle_a,
                                  std::uint32_t triangle_b) {
  ++measurements_;
  return {.p = p, .a = in_a_.at(p, triangle_a), .b = in_b_.at(X_AB.R.transpose() * (p - X_AB.t), triangle_b)};
}

CommonPoint CommonPointSearch::at(const Vector3d& p, const Pose& X_AB, const CommonPoint& near) {
  ++measurements_;
  return {.p = p, .a = in_a_.at(p, near.a), .b = in_b_.at(X_AB.R.transpose() * (p - X_AB.t), near.b)};
}

CommonPoint CommonPointSearch::ascend(const CommonPoint& start, const Pose& X_AB, double tau, const Effort& effort) {
  CommonPoint current = start;
  Bundle bundle;
  // Bounds of a point, seen from the current one.
  const auto add = [&](const CommonPoint& point) {
    const Vector3d back = current.p - point.p;
    const Vector3d of_a = gradient_of(point.a, mesh_a_), of_b = X_AB.R * gradient_of(point.b, mesh_b_);
    // Where a body is not convex a bound may lie below the depth of the current point, where it cannot hold.
    const double least = current.depth();
    bundle.add({of_a, std::max(least, -point.a.s + of_a.dot(back))});
    bundle.add({of_b, std::max(least, -point.b.s + of_b.dot(back))});
  };
  add(current);
  const double shortest = k_shortest_step * (current.p.norm() + X_AB.t.norm());
  for (int i = 0; i < effort.most && tau > shortest; ++i) {
    const double depth = current.depth();
    if (depth > 0.0 && depth >= effort.enough) break;
    Vector3d step = bundle.best_step(tau);
    double promised = bundle.value_at(step) - depth;
    // A short step promises little where the bodies' surfaces meet at a small angle. So a small promise is the end only
    // if longer steps have none either.
    while (depth > 0.0 && promised <= effort.gain * depth && tau < k_longest_step * depth) {
      tau *= k_longer;
      step = bundle.best_step(tau);
      promised = bundle.value_at(step) - depth;
    }
    if (depth > 0.0 && promised <= effort.gain * depth) break;
    if (!(promised > 0.0) || step.norm() <= shortest) break;
    const CommonPoint next = at(current.p + step, X_AB, current);
    const double gain = next.depth() - depth;
    if (gain >= k_serious * promised) {
      bundle.move(step, next.depth());
      current = next;
      add(current);
      if (gain >= k_as_promised * promised) tau *= 2.0;
    } else {
      add(next);
      tau *= 0.5;
    }
  }
  return current;
}

}  // namespace sixdof::detail
