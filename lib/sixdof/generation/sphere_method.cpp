#include <sixdof/generation/distance_generator.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/query/ask.h>

namespace sixdof {
namespace {

/// |f - target| at which the search has converged, in units of the diagonal of A's box: the rounding of a distance
/// between meshes whose coordinates are about as large as the diagonal is 1e-16 to 1e-15, and a thousandth of
/// k_distance_tolerance leaves room for oracles that round differently.
constexpr double k_converged = 1e-12;

/// Measurements on one ray after which the oracle is taken not to be a distance function. Smooth cases need ten; a
/// channel as narrow as the resolution needs one per resolution.
constexpr std::uint64_t k_most_measurements = 2'000'000;

struct Measurement {
  double s = 0.0;      ///< Translation.
  double f = 0.0;      ///< Distance.
  double slope = 0.0;  ///< df/ds of the closest pair of points; 0 if it is not known.
};

class SphereMethodSolver final : public RaySolver {
 public:
  SphereMethodSolver(const Algorithm& algorithm, SphereMarch march, const Mesh& a, const Mesh& b)
      : a_(a),
        b_(b),
        march_(march),
        name_(algorithm.traits().name),
        query_(algorithm.prepare(a, b, algorithm.settings())) {}

  void set_rotation(const Eigen::Vector4d& rotation) override { ray_ = ConfigurationRay(a_, b_, rotation); }

  void solve(const Eigen::Vector3d& direction, std::span<const double> targets, std::span<double> translations,
             std::span<double> residuals) override {
    ray_.direction = direction;
    of_ray_ = 0;
    // Each mesh lies in the ball of half a diagonal about the centre of its box.
    const double reach = 0.5 * (a_.diagonal() + b_.diagonal());
    const bool conservative = march_ == SphereMarch::conservative;
    Measurement outer;
    for (std::size_t k = 0; k < targets.size(); ++k) {
      if (conservative || k == 0) outer = measure(reach + targets[k]);
      const bool hit = conservative ? advance_conservatively(targets[k], outer) : advance(targets[k], outer);
      translations[k] = hit ? outer.s : std::numeric_limits<double>::quiet_NaN();
      residuals[k] = hit ? std::abs(outer.f - targets[k]) : 0.0;
    }
    measurements_ += of_ray_;
  }

  std::uint64_t measurements() const override { return measurements_; }

 private:
  Measurement measure(double s) {
    if (++of_ray_ > k_most_measurements) {
      throw Error(fmt::format("no end after {} measurements of the distance", k_most_measurements));
    }
    const Separation d = require_distance(*query_, name_, ray_.pose(s));
    Measurement measured{.s = s, .f = d.distance};
    if (d.has_witnesses && d.distance > 0.0) {
      measured.slope = (d.witness_b - d.witness_a).dot(ray_.direction) / d.distance;
    }
    return measured;
  }

  /// Moves `outer` to the first hit at or below `outer.s`, given that there is none above.
  /// @return false if the target is not met down to s = 0; `outer` is at s = 0 then
  bool advance(double target, Measurement& outer) {
    for (;;) {
      if (outer.f <= target + converged()) return true;
      if (outer.s == 0.0) return false;
      const Measurement inner = measure(std::max(0.0, outer.s - step(outer, target)));
      const double clear = clear_above(inner, outer, target);
      const bool closed = clear - inner.s <= resolution();
      if (closed && inner.f >= target - converged()) {
        outer = inner;
      } else if (closed) {
        outer = bisect(inner, outer, target);
        return true;
      } else {
        outer = measure(clear);
        // A crossing at `clear` itself may be rounded to slightly below the target, not to more than that.
        if (outer.f < target - converged()) throw_jump(target, outer);
      }
    }
  }

  /// The same by conservative advancement.
  bool advance_conservatively(double target, Measurement& outer) {
    while (outer.f > target + converged()) {
      if (outer.s == 0.0) return false;
      outer = measure(std::max(0.0, outer.s - (outer.f - target)));
    }
    if (outer.f < target - converged()) throw_jump(target, outer);
    return true;
  }

 private:
  double converged() const { return k_converged * a_.diagonal(); }
  double resolution() const { return k_first_hit_resolution * a_.diagonal(); }

  /// Length of the next step inwards: a Newton step, but no longer than can be certified if the distance at its end is
  /// the target.
  double step(const Measurement& outer, double target) const {
    const double above = outer.f - target;
    const double certain = std::max(std::sqrt(above * (outer.f + target)), above + resolution());
    if (outer.slope <= 0.0) return certain;
    return std::clamp(above / outer.slope, above, certain);
  }

  /// The smallest t in [inner.s, outer.s] such that f > target is certain on (t, outer.s].
  double clear_above(const Measurement& inner, const Measurement& outer, double target) const {
    const double from_outer = outer.s - (outer.f - target);
    const double from_inner = inner.s + std::max(0.0, inner.f - target);
    // The parabola y^2 + m y + c of f^2 - target^2, y = s - inner.s.
    const double width = outer.s - inner.s;
    const double m = (outer.f - inner.f) * (outer.f + inner.f) / width - width;
    const double c = (inner.f - target) * (inner.f + target);
    const double discriminant = 0.25 * m * m - c;
    if (discriminant < 0.0) return inner.s;
    const double root = m > 0.0 ? -c / (0.5 * m + std::sqrt(discriminant)) : std::sqrt(discriminant) - 0.5 * m;
    if (root >= width) return inner.s;  // f^2 > target^2 at both ends, so the other root is beyond as well.
    const double clear = std::min(from_outer, inner.s + root);
    return clear <= from_inner ? inner.s : clear;
  }

  /// A crossing between two measurements, f(inner) < target < f(outer).
  Measurement bisect(Measurement inner, Measurement outer, double target) {
    // Illinois method: false position that halves the weight of an end that is kept. Bisection where that is slow.
    double inner_weight = 1.0, outer_weight = 1.0;
    double width_before = outer.s - inner.s;
    for (int i = 0;; ++i) {
      double s = 0.5 * (inner.s + outer.s);
      const bool slow = i % 4 == 3 && outer.s - inner.s > 0.25 * width_before;
      if (i % 4 == 3) width_before = outer.s - inner.s;
      if (!slow) {
        const double low = inner_weight * (inner.f - target);
        const double high = outer_weight * (outer.f - target);
        s = inner.s - low * (outer.s - inner.s) / (high - low);
      }
      if (!(s > inner.s && s < outer.s)) s = 0.5 * (inner.s + outer.s);
      if (!(s > inner.s && s < outer.s)) return best(inner, outer, target);
      const Measurement middle = measure(s);
      if (std::abs(middle.f - target) <= converged()) return middle;
      if (middle.f > target) {
        outer = middle;
        outer_weight = 1.0;
        inner_weight *= 0.5;
      } else {
        inner = middle;
        inner_weight = 1.0;
        outer_weight *= 0.5;
      }
    }
  }

  /// The better one of two measurements at neighbouring doubles of s.
  Measurement best(const Measurement& inner, const Measurement& outer, double target) const {
    const Measurement& chosen = std::abs(inner.f - target) < std::abs(outer.f - target) ? inner : outer;
    if (std::abs(chosen.f - target) > k_distance_tolerance * a_.diagonal()) throw_jump(target, chosen);
    return chosen;
  }

  [[noreturn]] void throw_jump(double target, const Measurement& measured) const {
    throw Error(
        fmt::format("the oracle's distance jumps: {} at s = {}, past the target {}", measured.f, measured.s, target));
  }

  const Mesh& a_;
  const Mesh& b_;
  const SphereMarch march_;
  const std::string& name_;
  std::unique_ptr<Query> query_;
  ConfigurationRay ray_;
  std::uint64_t of_ray_ = 0;  ///< Measurements.
  std::uint64_t measurements_ = 0;
};

class SphereMethod final : public DistanceGenerator {
 public:
  SphereMethod(const Algorithm& algorithm, SphereMarch march) : algorithm_(algorithm), march_(march) {}
  const std::string& oracle_name() const override { return algorithm_.traits().name; }
  const std::string& oracle_version() const override { return algorithm_.traits().version; }
  std::unique_ptr<RaySolver> prepare(const Mesh& a, const Mesh& b) const override {
    return std::make_unique<SphereMethodSolver>(algorithm_, march_, a, b);
  }

 private:
  const Algorithm& algorithm_;
  const SphereMarch march_;
};

}  // namespace

std::unique_ptr<DistanceGenerator> make_sphere_method(const Algorithm& algorithm, SphereMarch march) {
  require_distance_queries(algorithm);
  return std::make_unique<SphereMethod>(algorithm, march);
}

}  // namespace sixdof
