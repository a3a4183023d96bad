#pragma once

#include <cmath>
#include <numbers>

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

}  // namespace sixdof
