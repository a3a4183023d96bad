#pragma once

#include <Eigen/Core>

#include <sixdof/scenario/quadrature.h>

namespace sixdof {

/// A force in the x, y plane and a torque about z.
struct PlaneWrench {
  double x = 0.0, y = 0.0, torque = 0.0;

  /// Of `force` at `arm` from the reference point.
  static PlaneWrench of(const Eigen::Vector2d& arm, const Eigen::Vector2d& force) {
    return {force.x(), force.y(), arm.x() * force.y() - arm.y() * force.x()};
  }

  Eigen::Vector2d force() const { return {x, y}; }

  PlaneWrench& operator+=(const PlaneWrench& other) {
    x += other.x;
    y += other.y;
    torque += other.torque;
    return *this;
  }
  friend PlaneWrench operator*(double factor, const PlaneWrench& w) {
    return {factor * w.x, factor * w.y, factor * w.torque};
  }
};

/// Integral of the wrench f(t) from `from` to `to` (integrate()).
template <class F>
PlaneWrench integrate_wrench(const F& f, double from, double to) {
  const auto component = [&](double PlaneWrench::*which) {
    return integrate([&](double t) { return f(t).*which; }, from, to);
  };
  return {component(&PlaneWrench::x), component(&PlaneWrench::y), component(&PlaneWrench::torque)};
}

}  // namespace sixdof
