#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <boost/math/quadrature/gauss.hpp>

namespace sixdof {

/// Integral of `f` from `from` to `to` by Gauss-Legendre quadrature with 30 nodes, accurate to rounding if f is smooth
/// between the limits. Callers split an integral at the kinks of f.
template <class F>
double integrate(const F& f, double from, double to) {
  return from < to ? boost::math::quadrature::gauss<double, 30>::integrate(f, from, to) : 0.0;
}

/// The same for an f that behaves like a square root at both limits, as the length of a chord does. Substituting
/// x = middle - half * cos(t) makes it smooth.
template <class F>
double integrate_chords(const F& f, double from, double to) {
  if (!(from < to)) return 0.0;
  const double middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from);
  return integrate([&](double t) { return f(middle - half * std::cos(t)) * half * std::sin(t); }, 0.0,
                   std::numbers::pi);
}

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

/// Area common to two discs of radii r1, r2 >= 0 whose centres are `distance` >= 0 apart:
/// r1^2 (u - sin u cos u) + r2^2 (v - sin v cos v) with the half angles u, v of the two circular segments; 0 if the
/// discs are apart, the smaller disc's area if it is inside the other.
/// https://mathworld.wolfram.com/Circle-CircleIntersection.html
double lens_area(double r1, double r2, double distance);

/// Length of the common chord of the two circles, which is -d lens_area / d distance. 0 where they do not intersect.
double lens_chord(double r1, double r2, double distance);

/// A disc of radius r about the origin, cut to the part with x > cut.
struct DiscPart {
  double area = 0.0;
  double moment_x = 0.0;  ///< Integral of x over the part.
};
DiscPart disc_part(double r, double cut);

}  // namespace sixdof
