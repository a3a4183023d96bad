#pragma once

#include <cmath>

#include <boost/math/quadrature/gauss.hpp>

namespace sixdof {

/// Integral of `f` from `from` to `to` by Gauss-Legendre quadrature with 30 nodes: to rounding for integrands that are
/// smooth between the limits. Split at kinks; the ideal models of this room do, so their integrals are as good as
/// closed forms.
template <class F>
double integrate(const F& f, double from, double to) {
  return from < to ? boost::math::quadrature::gauss<double, 30>::integrate(f, from, to) : 0.0;
}

/// The same for an integrand that behaves like a square root at both limits, as lengths of chords do. Substituting
/// x = middle - half * cos(t) makes it smooth.
template <class F>
double integrate_chords(const F& f, double from, double to) {
  if (!(from < to)) return 0.0;
  const double middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from);
  constexpr double k_pi = 3.14159265358979323846;
  return integrate([&](double t) { return f(middle - half * std::cos(t)) * half * std::sin(t); }, 0.0, k_pi);
}

}  // namespace sixdof
