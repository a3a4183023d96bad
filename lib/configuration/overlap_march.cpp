#include <sixdof/configuration/overlap_march.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

/// Measurements on one ray after which the oracle is taken to measure no volume. The worst honest case halves the whole
/// way down to the resolution, for every aim: some 1e5.
constexpr int k_most_measurements = 1'000'000;

/// One step inwards lengthens the way since contact at most by this factor: powers fitted to a trace of an overlap say
/// little about what comes further in.
constexpr double k_longest_stride = 3.0;

/// Exponents that the volume may grow with: 1 for faces that meet flat, 3 for a corner that meets a face; growth by
/// leaps behind the first contact looks steeper.
constexpr double k_least_power = 1.0, k_most_power = 8.0;

/// The factor, up to k_longest_stride, whose power is `ratio`. By halving: library functions for powers round
/// differently from one instruction set to the next, and where samples lie decides the last bits of a hit.
double stride(double ratio, int power) {
  constexpr int k_halvings = 20;
  double low = 1.0, high = k_longest_stride;
  for (int i = 0; i < k_halvings; ++i) {
    const double middle = 0.5 * (low + high);
    double value = 1.0;
    for (int k = 0; k < power; ++k) value *= middle;
    (value < ratio ? low : high) = middle;
  }
  return high;
}

/// Share of the resolution left between a hit and the sample taken to clear the way up to it.
constexpr double k_clearance = 0.9;

/// Every so many refinements of one bracket the interval is halved, so that the slowest case is bisection.
constexpr int k_halve_every = 4;

/// Cubic with the values and slopes of two samples, at share x of the way in.
double hermite(const OverlapSample& outer, const OverlapSample& inner, double x) {
  const double way = outer.s - inner.s;
  const double a = way * outer.slope - (inner.volume - outer.volume);
  const double b = -way * inner.slope + (inner.volume - outer.volume);
  const double y = 1.0 - x;
  return y * outer.volume + x * inner.volume + x * y * (y * a + x * b);
}

}  // namespace

OverlapMarch::OverlapMarch(Measure measure, Bounds bounds, double contact, const MarchLimits& limits)
    : measure_(std::move(measure)),
      bounds_(std::move(bounds)),
      contact_(contact),
      limits_(limits),
      content_(k_content * limits.tolerance),
      front_{.s = contact} {}

void OverlapMarch::insert(double s) {
  if (++measurements_ > k_most_measurements) {
    throw Error(fmt::format("no end after {} measurements of the volume", k_most_measurements));
  }
  inner_.push_back(measure_(s));
}

/// Whether no hit can be in the gap, or it is too short to look into.
bool OverlapMarch::closed(const OverlapSample& outer, const OverlapSample& inner, double aim) const {
  const double way = outer.s - inner.s;
  return way <= limits_.resolution || bounds_(inner.s).peak(outer.volume, inner.volume, way) <= aim + content_;
}

/// Where to measure next if nothing is known further in than the front.
double OverlapMarch::next(double aim) const {
  const double gap = aim - front_.volume;
  // As far as the volume certainly stays below the aim. Bounds grow with the way, so halving finds the limit.
  constexpr int k_halvings = 20;
  double certain = 0.0, beyond = front_.s;
  for (int i = 0; i < k_halvings; ++i) {
    const double way = 0.5 * (certain + beyond);
    (bounds_(front_.s - way).rise * way <= gap ? certain : beyond) = way;
  }
  double expected = 0.0;
  const double since_contact = contact_ - front_.s;
  if (front_.volume > 0.0 && since_contact > 0.0) {
    const double power = std::clamp(front_.slope * since_contact / front_.volume, k_least_power, k_most_power);
    expected = since_contact * (stride(aim / front_.volume, static_cast<int>(std::lround(power))) - 1.0);
  }
  return std::max(0.0, front_.s - std::max({certain, expected, limits_.resolution}));
}

/// Where to divide a gap that may hide a hit: just outside of its inner end if that would leave no doubt, else halfway.
double OverlapMarch::divide(const OverlapSample& outer, const OverlapSample& inner, double aim) const {
  const double way = outer.s - inner.s;
  const double near = 1.0 - k_clearance * limits_.resolution / way;
  const double foreseen = hermite(outer, inner, near);
  const double s = outer.s - near * way;
  if (foreseen < aim && bounds_(s).peak(outer.volume, foreseen, near * way) <= aim) return s;
  return outer.s - 0.5 * way;
}

/// Where the aim is met between two samples, as the cubic through them has it. Nothing between neighbouring doubles.
std::optional<double> OverlapMarch::refine(const OverlapSample& outer, const OverlapSample& inner, double aim) {
  const double way = outer.s - inner.s;
  double low = 0.0, high = 1.0;
  if (++refinements_ % k_halve_every != 0) {
    // The cubic is below the aim at 0 and above at 1.
    constexpr int k_halvings = 54;  // as many as a double has digits
    for (int i = 0; i < k_halvings; ++i) {
      const double x = 0.5 * (low + high);
      (hermite(outer, inner, x) < aim ? low : high) = x;
    }
  }
  double s = outer.s - 0.5 * (low + high) * way;
  if (!(s > inner.s && s < outer.s)) s = 0.5 * (inner.s + outer.s);
  if (!(s > inner.s && s < outer.s)) return std::nullopt;
  return s;
}

std::optional<OverlapSample> OverlapMarch::advance(double aim) {
  refinements_ = 0;
  for (;;) {
    if (inner_.empty()) {
      if (front_.s == 0.0) return std::nullopt;
      insert(next(aim));
      continue;
    }
    const OverlapSample inner = inner_.back();
    if (inner.volume <= aim + content_) {
      if (!closed(front_, inner, aim)) {
        insert(divide(front_, inner, aim));
        continue;
      }
      front_ = inner;
      inner_.pop_back();
      if (inner.volume >= aim - content_) return inner;
    } else if (const std::optional<double> s = refine(front_, inner, aim)) {
      insert(*s);
    } else if (std::abs(inner.volume - aim) <= limits_.tolerance) {
      // Rounding of the volume hides what lies between neighbouring travels.
      front_ = inner;
      inner_.pop_back();
      return inner;
    } else {
      throw Error(fmt::format("volume {} at travel {} and {} next to it: the aim {} is passed over", front_.volume,
                              front_.s, inner.volume, aim));
    }
  }
}

}  // namespace sixdof
