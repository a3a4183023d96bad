#include <sixdof/generation/overlap_march.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <sixdof/base/error.h>

// Only + - * / and square roots: library functions for powers round differently from one instruction set to the next,
// and where samples lie decides the last bits of a hit.

namespace sixdof {
namespace {

/// Measurements on one ray after which the oracle is taken to measure no volume. The worst honest case halves the whole
/// way down to the resolution, for every target: some 1e5.
constexpr int k_most_measurements = 1'000'000;

/// One step inwards lengthens the way since contact at most by this factor: what was measured so far says little about
/// what comes further in.
constexpr double k_longest_stride = 3.0;
/// The step where nothing says how the volume goes on, by the way since contact.
constexpr double k_blind_stride = 0.5;

/// Steps shorter than the resolution that end without a hit; after them a step is never shorter.
constexpr int k_most_approaches = 5;

/// Share of the resolution left between the ends of a gap and where it is divided.
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

OverlapMarch::OverlapMarch(Measure measure, Peak peak, double contact, const MarchLimits& limits)
    : measure_(std::move(measure)),
      peak_(std::move(peak)),
      contact_(contact),
      limits_(limits),
      content_(k_content * limits.tolerance),
      passed_{{.s = contact}} {}

void OverlapMarch::insert(double s) {
  if (++measurements_ > k_most_measurements) {
    throw Error(fmt::format("no end after {} measurements of the volume", k_most_measurements));
  }
  inner_.push_back(measure_(s, passed_.back().s));
}

/// Where a hit may be hidden up to the sample, if anywhere.
std::optional<double> OverlapMarch::doubt(const OverlapSample& inner, double target) const {
  const OverlapSample& outer = passed_.back();
  if (outer.s - inner.s <= limits_.resolution) return std::nullopt;
  const VolumePeak peak = peak_(outer, inner);
  if (peak.volume <= target + content_) return std::nullopt;
  const double clearance = std::min(k_clearance * limits_.resolution, 0.5 * (outer.s - inner.s));
  return std::clamp(peak.s, inner.s + clearance, outer.s - clearance);
}

/// How far inwards the target should be met: the way as a cubic of the square root of the volume, which is nearly straight
/// where bodies begin to overlap. Two samples about as far apart as the step is long determine it; at contact only the
/// place is known. Nothing sensible: 0.
double OverlapMarch::expected(double target) const {
  const OverlapSample& front = passed_.back();
  if (!(front.volume > 0.0 && front.slope > 0.0)) return 0.0;
  const double root = std::sqrt(front.volume);
  const double pace = 2.0 * root / front.slope;  // way per root
  const double ahead = std::sqrt(target) - root;
  std::size_t i = passed_.size() - 1;
  while (i > 0 && 2.0 * (passed_[i].s - front.s) < pace * ahead) --i;
  const OverlapSample& past = passed_[i];
  const double behind = root - std::sqrt(std::max(past.volume, 0.0));
  const double way = past.s - front.s;
  if (!(behind > 0.0)) return pace * ahead;
  const double bend = (pace - way / behind) / behind;  // divided differences
  double step = pace * ahead + bend * ahead * ahead;
  if (past.volume > 0.0 && past.slope > 0.0) {
    const double past_pace = 2.0 * (root - behind) / past.slope;
    const double past_bend = (way / behind - past_pace) / behind;
    step += (bend - past_bend) / behind * ahead * ahead * (ahead + behind);
  }
  return step > 0.0 ? step : pace * ahead;
}

/// Where to measure next if nothing is known further in.
double OverlapMarch::next(double target) {
  const double front = passed_.back().s;
  const double since_contact = contact_ - front;
  double step = expected(target);
  if (since_contact == 0.0) {
    step = limits_.first_stride;
  } else if (step == 0.0) {
    step = k_blind_stride * since_contact;
  } else {
    step = std::min(step, (k_longest_stride - 1.0) * since_contact);
  }
  if (step < limits_.resolution && (approaches_++ >= k_most_approaches || !(front - step < front))) {
    step = limits_.resolution;
  }
  return std::max(0.0, front - step);
}

/// Where the target is met between two samples, as the cubic through them has it. Nothing between neighbouring doubles.
std::optional<double> OverlapMarch::refine(const OverlapSample& inner, double target) {
  const OverlapSample& outer = passed_.back();
  const double way = outer.s - inner.s;
  double low = 0.0, high = 1.0;
  if (++refinements_ % k_halve_every != 0) {
    // The cubic is below the target at 0 and above at 1.
    constexpr int k_halvings = 54;  // as many as a double has digits
    for (int i = 0; i < k_halvings; ++i) {
      const double x = 0.5 * (low + high);
      (hermite(outer, inner, x) < target ? low : high) = x;
    }
  }
  double s = outer.s - 0.5 * (low + high) * way;
  if (!(s > inner.s && s < outer.s)) s = 0.5 * (inner.s + outer.s);
  if (!(s > inner.s && s < outer.s)) return std::nullopt;
  return s;
}

/// Goes on to the outermost sample further in.
OverlapSample OverlapMarch::pass() {
  passed_.push_back(inner_.back());
  inner_.pop_back();
  return passed_.back();
}

std::optional<OverlapSample> OverlapMarch::advance(double target) {
  refinements_ = 0;
  approaches_ = 0;
  for (;;) {
    if (inner_.empty()) {
      if (passed_.back().s == 0.0) return std::nullopt;
      insert(next(target));
      continue;
    }
    const OverlapSample inner = inner_.back();
    if (inner.volume <= target + content_) {
      if (const std::optional<double> s = doubt(inner, target)) {
        insert(*s);
        continue;
      }
      pass();
      if (inner.volume >= target - content_) return inner;
    } else if (const std::optional<double> s = refine(inner, target)) {
      insert(*s);
    } else if (std::abs(inner.volume - target) <= limits_.tolerance) {
      // Rounding of the volume hides what lies between neighbouring translations.
      return pass();
    } else {
      throw Error(fmt::format("volume {} at translations {} and {} next to it: the target {} is passed over",
                              passed_.back().volume, passed_.back().s, inner.volume, target));
    }
  }
}

}  // namespace sixdof
