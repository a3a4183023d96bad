#include <sixdof/generation/overlap_march.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <sixdof/base/error.h>

// Notation: s is a translation, V(s) the volume; inwards is towards smaller s. `passed_` holds the measurements from
// contact down to the front, up to which the target is certainly not met. `inner_` holds those beyond.
// - Nothing beyond: predict where the target is met from the last measurements, and measure there.
// - V below the target at the next measurement: if the bounds allow a peak above the target in between, divide the
//   interval; else the measurement becomes the front.
// - V above the target there: the interval brackets a hit. Refine it by a polynomial through both ends.
//
// Only + - * / and square roots, which round alike on every instruction set: where V is measured decides the last bits.

namespace sixdof {
namespace {

/// Measurements on one ray after which the oracle is taken not to measure a volume. The worst case halves every
/// interval down to the resolution, for every target: some 1e5.
constexpr int k_most_measurements = 1'000'000;

/// One step lengthens the displacement since contact at most by this factor: the measurements so far say little about
/// what lies farther inwards.
constexpr double k_step_growth = 3.0;
/// The step where the volume cannot be predicted, as a fraction of the displacement since contact.
constexpr double k_unpredicted_step = 0.5;

/// Steps shorter than this many times the one before are predicted with the curvature.
constexpr double k_curved_steps = 1.5;

/// Number of steps shorter than the resolution towards one target. Later ones have at least its length.
constexpr int k_most_short_steps = 5;

/// Least distance from the ends of an interval to where it is divided, as a fraction of the resolution.
constexpr double k_clearance = 0.9;

/// Every so many refinements of one bracket the interval is halved, so that the slowest case is bisection.
constexpr int k_halve_every = 4;

/// Polynomial with the values and slopes of two measurements and the curvature of one, by the fraction x of the
/// displacement from outer to inner.
class Quartic {
 public:
  Quartic(const OverlapMeasurement& outer, const OverlapMeasurement& inner, bool curved_at_inner)
      : outer_(outer.volume), inner_(inner.volume) {
    const double length = outer.s - inner.s;
    a_ = length * outer.slope - (inner_ - outer_);
    b_ = -length * inner.slope + (inner_ - outer_);
    const double curvature = length * length * (curved_at_inner ? inner : outer).curvature;
    k_ = 0.5 * (curvature - (curved_at_inner ? 2.0 * a_ - 4.0 * b_ : 2.0 * b_ - 4.0 * a_));
  }

  double operator()(double x) const {
    const double y = 1.0 - x;
    return y * outer_ + x * inner_ + x * y * (y * a_ + x * b_ + x * y * k_);
  }

  /// Where it meets a target between low and high, below it at low and above at high.
  double solve(double target, double low, double high) const {
    constexpr int k_halvings = 54;  // One more than the bits of a double's significand.
    for (int i = 0; i < k_halvings; ++i) {
      const double x = 0.5 * (low + high);
      ((*this)(x) < target ? low : high) = x;
    }
    return 0.5 * (low + high);
  }

 private:
  double outer_, inner_, a_, b_, k_;
};

}  // namespace

OverlapMarch::OverlapMarch(Measure measure, Peak peak, double contact, const MarchLimits& limits)
    : measure_(std::move(measure)),
      peak_(std::move(peak)),
      contact_(contact),
      limits_(limits),
      converged_(k_converged * limits.tolerance),
      passed_{{.s = contact}} {}

void OverlapMarch::measure_at(double s) {
  if (++measurements_ > k_most_measurements) {
    throw Error(fmt::format("no end after {} measurements of the volume", k_most_measurements));
  }
  inner_.push_back(measure_(s, passed_.back().s));
}

/// Where to divide the interval from the front to `inner`; nothing if it cannot contain a hit.
std::optional<double> OverlapMarch::division(const OverlapMeasurement& inner, double target) const {
  const OverlapMeasurement& outer = passed_.back();
  if (outer.s - inner.s <= limits_.resolution) return std::nullopt;
  const double enough = target + converged_;
  const VolumePeak peak = peak_(outer, inner, enough);
  if (peak.volume <= enough) return std::nullopt;
  const double clearance = std::min(k_clearance * limits_.resolution, 0.5 * (outer.s - inner.s));
  return std::clamp(peak.s, inner.s + clearance, outer.s - clearance);
}

/// Displacement inwards from the front at which the target is predicted to be met; 0 without a prediction. Newton's
/// form of the polynomial for the displacement in the root of the volume, which is nearly linear where bodies begin to
/// overlap. Nodes are the front and an earlier measurement about as far away as the step is long, each with its
/// derivative; at contact only the value is known. Steps that are not much longer than the way between both follow the
/// polynomial that has the front's curvature, too.
double OverlapMarch::predicted_step(double target) const {
  const OverlapMeasurement& front = passed_.back();
  if (!(front.volume > 0.0 && front.slope > 0.0)) return 0.0;
  const double root = std::sqrt(front.volume);
  const double derivative = 2.0 * root / front.slope;  // of the displacement by the root
  const double ahead = std::sqrt(target) - root;
  std::size_t i = passed_.size() - 1;
  while (i > 0 && 2.0 * (passed_[i].s - front.s) < derivative * ahead) --i;
  const OverlapMeasurement& past = passed_[i];
  const double behind = root - std::sqrt(std::max(past.volume, 0.0));
  const double length = past.s - front.s;
  if (!(behind > 0.0)) return derivative * ahead;
  const double second = (derivative - length / behind) / behind;  // divided differences
  double step = derivative * ahead + second * ahead * ahead;
  if (past.volume > 0.0 && past.slope > 0.0) {
    const double past_derivative = 2.0 * (root - behind) / past.slope;
    const double past_second = (length / behind - past_derivative) / behind;
    step += (second - past_second) / behind * ahead * ahead * (ahead + behind);
  }
  if (!(step > 0.0)) return derivative * ahead;
  if (!(past.volume > 0.0 && step < k_curved_steps * length)) return step;
  const Quartic quartic(past, front, true);
  const double most = 1.0 + 2.0 * step / length;
  return quartic(most) > target ? (quartic.solve(target, 1.0, most) - 1.0) * length : step;
}

/// Where to measure if there is no measurement beyond the front.
double OverlapMarch::next_translation(double target) {
  const double front = passed_.back().s;
  const double since_contact = contact_ - front;
  double step = predicted_step(target);
  if (since_contact == 0.0) {
    step = limits_.first_step;
  } else if (step == 0.0) {
    step = k_unpredicted_step * since_contact;
  } else {
    step = std::min(step, (k_step_growth - 1.0) * since_contact);
  }
  if (step < limits_.resolution && (short_steps_++ >= k_most_short_steps || !(front - step < front))) {
    step = limits_.resolution;
  }
  return std::max(0.0, front - step);
}

/// Where the polynomial through the front and `inner` meets the target; nothing between neighbouring doubles.
std::optional<double> OverlapMarch::refine(const OverlapMeasurement& inner, double target) {
  const OverlapMeasurement& outer = passed_.back();
  const double length = outer.s - inner.s;
  double x = 0.5;
  if (++refinements_ % k_halve_every != 0) {
    const bool is_nearer_inner = inner.volume - target < target - outer.volume;
    x = Quartic(outer, inner, is_nearer_inner || outer.s == contact_).solve(target, 0.0, 1.0);
  }
  double s = outer.s - x * length;
  if (!(s > inner.s && s < outer.s)) s = 0.5 * (inner.s + outer.s);
  if (!(s > inner.s && s < outer.s)) return std::nullopt;
  return s;
}

/// Makes the next measurement the front.
OverlapMeasurement OverlapMarch::pass() {
  passed_.push_back(inner_.back());
  inner_.pop_back();
  return passed_.back();
}

std::optional<OverlapMeasurement> OverlapMarch::advance(double target) {
  refinements_ = 0;
  short_steps_ = 0;
  for (;;) {
    if (inner_.empty()) {
      if (passed_.back().s == 0.0) return std::nullopt;
      measure_at(next_translation(target));
      continue;
    }
    const OverlapMeasurement inner = inner_.back();
    if (inner.volume <= target + converged_) {
      if (const std::optional<double> s = division(inner, target)) {
        measure_at(*s);
        continue;
      }
      pass();
      if (inner.volume >= target - converged_) return inner;
    } else if (const std::optional<double> s = refine(inner, target)) {
      measure_at(*s);
    } else if (std::abs(inner.volume - target) <= limits_.tolerance) {
      // The target lies between neighbouring doubles of s, closer than the volume is rounded.
      return pass();
    } else if (inner.volume - passed_.back().volume <= limits_.rounding) {
      throw BadMesh(
          fmt::format("the volume is {} and {} at neighbouring translations: it is not known to the tolerance {}, "
                      "since one body is "
                      "too small for the other's triangles, or both for their coordinates",
                      passed_.back().volume, inner.volume, limits_.tolerance));
    } else {
      throw Error(fmt::format("the volume jumps from {} at s = {} to {} at s = {} next to it, past the target {}",
                              passed_.back().volume, passed_.back().s, inner.volume, inner.s, target));
    }
  }
}

}  // namespace sixdof
