#include <sixdof/scenario/plane.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sixdof {
namespace {

/// Area of the segment of a disc of radius r beyond a chord at signed distance `at` from the centre.
double segment_area(double r, double at) {
  if (at >= r) return 0.0;
  if (at <= -r) return std::numbers::pi * r * r;
  const double half_chord = std::sqrt((r - at) * (r + at));
  return r * r * std::atan2(half_chord, at) - at * half_chord;
}

}  // namespace

double lens_area(double r1, double r2, double distance) {
  if (distance >= r1 + r2) return 0.0;
  const double smaller = std::min(r1, r2);
  if (distance <= std::abs(r1 - r2)) return std::numbers::pi * smaller * smaller;
  const double at1 = (distance * distance + (r1 - r2) * (r1 + r2)) / (2.0 * distance);
  return segment_area(r1, at1) + segment_area(r2, distance - at1);
}

double lens_chord(double r1, double r2, double distance) {
  if (distance >= r1 + r2 || distance <= std::abs(r1 - r2)) return 0.0;
  const double at1 = (distance * distance + (r1 - r2) * (r1 + r2)) / (2.0 * distance);
  return 2.0 * std::sqrt(std::max(0.0, (r1 - at1) * (r1 + at1)));
}

DiscPart disc_part(double r, double cut) {
  if (cut >= r) return {};
  const double inside = std::max(cut, -r);
  // Integral of x times the chord 2 sqrt(r^2 - x^2) from the cut to r.
  return {segment_area(r, cut), 2.0 / 3.0 * std::pow((r - inside) * (r + inside), 1.5)};
}

}  // namespace sixdof
