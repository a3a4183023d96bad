#include <sixdof/generation/sphere_method.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/query/require_distance.h>

namespace sixdof {
namespace {

/// |f - target| at which the search is content, in units of A's box diagonal: rounding of a distance between meshes whose
/// coordinates are about as large as the diagonal is 1e-16 to 1e-15, and a thousandth of k_distance_tolerance leaves
/// room for oracles that round differently.
constexpr double k_content = 1e-12;

/// Measurements on one ray after which the oracle is taken to be no distance function. Smooth cases need ten; a channel
/// as narrow as the resolution needs one per resolution.
constexpr int k_most_measurements = 2'000'000;

/// A measurement at translation s.
struct Sample {
  double s = 0.0;
  double f = 0.0;      ///< Distance.
  double slope = 0.0;  ///< df/ds of the closest pair of points; 0 if not known.
};

class RayMarch {
 public:
  RayMarch(Query& query, const std::string& algorithm, const ConfigurationRay& ray, double diagonal)
      : query_(query), algorithm_(algorithm), ray_(ray), diagonal_(diagonal) {}

  int measurements() const { return measurements_; }

  Sample measure(double s) {
    if (++measurements_ > k_most_measurements) {
      throw Error(fmt::format("no end after {} measurements of the distance", k_most_measurements));
    }
    const Separation d = require_distance(query_, algorithm_, ray_.pose(s));
    Sample sample{.s = s, .f = d.distance};
    if (d.has_witnesses && d.distance > 0.0) sample.slope = (d.witness_b - d.witness_a).dot(ray_.direction) / d.distance;
    return sample;
  }

  /// The first hit at or below `outer.s`, given that there is none above. Nothing if the target is not met down to s = 0;
  /// then `outer` is at s = 0. Otherwise `outer` is the hit.
  bool advance(double target, Sample& outer) {
    for (;;) {
      if (outer.f <= target + content()) return true;
      if (outer.s == 0.0) return false;
      const Sample inner = measure(std::max(0.0, outer.s - step(outer, target)));
      const double clear = clear_above(inner, outer, target);
      const bool gap_closed = clear - inner.s <= resolution();
      if (gap_closed && inner.f >= target - content()) {
        outer = inner;
      } else if (gap_closed) {
        outer = bisect(inner, outer, target);
        return true;
      } else {
        outer = measure(clear);
        // Rounding of a crossing at `clear` itself.
        if (outer.f < target - content()) throw_lost(target, outer);
      }
    }
  }

  /// The same by conservative steps.
  bool advance_conservatively(double target, Sample& outer) {
    while (outer.f > target + content()) {
      if (outer.s == 0.0) return false;
      outer = measure(std::max(0.0, outer.s - (outer.f - target)));
    }
    if (outer.f < target - content()) throw_lost(target, outer);
    return true;
  }

 private:
  double content() const { return k_content * diagonal_; }
  double resolution() const { return k_first_hit_resolution * diagonal_; }

  /// Length of the next step inwards: Newton's where it can be certified, otherwise as far as it could be if the
  /// distance fell no faster than to the target.
  double step(const Sample& outer, double target) const {
    const double above = outer.f - target;
    const double certain = std::max(std::sqrt(above * (outer.f + target)), above + resolution());
    if (outer.slope <= 0.0) return certain;
    return std::clamp(above / outer.slope, above, certain);
  }

  /// The least t in [inner.s, outer.s] such that f > target is certain on (t, outer.s].
  double clear_above(const Sample& inner, const Sample& outer, double target) const {
    const double from_outer = outer.s - (outer.f - target);
    const double from_inner = inner.s + std::max(0.0, inner.f - target);
    // The parabola y^2 + m y + c of f^2 - target^2, y = s - inner.s.
    const double width = outer.s - inner.s;
    const double m = (outer.f - inner.f) * (outer.f + inner.f) / width - width;
    const double c = (inner.f - target) * (inner.f + target);
    const double discriminant = 0.25 * m * m - c;
    if (discriminant < 0.0) return inner.s;
    const double root = m > 0.0 ? -c / (0.5 * m + std::sqrt(discriminant)) : std::sqrt(discriminant) - 0.5 * m;
    if (root >= width) return inner.s;  // f^2 > target^2 at both ends: then the other root is beyond, too
    const double clear = std::min(from_outer, inner.s + root);
    return clear <= from_inner ? inner.s : clear;
  }

  /// A crossing between two samples, f(inner) < target < f(outer).
  Sample bisect(Sample inner, Sample outer, double target) {
    // Illinois: false position that halves the weight of an end that stays; plain halving when that is slow.
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
      const Sample middle = measure(s);
      if (std::abs(middle.f - target) <= content()) return middle;
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

  /// Two neighbouring doubles of s: the better one has to do.
  Sample best(const Sample& inner, const Sample& outer, double target) const {
    const Sample& chosen = std::abs(inner.f - target) < std::abs(outer.f - target) ? inner : outer;
    if (std::abs(chosen.f - target) > k_distance_tolerance * diagonal_) throw_lost(target, chosen);
    return chosen;
  }

  [[noreturn]] void throw_lost(double target, const Sample& sample) const {
    throw Error(fmt::format("the oracle's distance jumps: {} at s = {}, where {} was bound to be met", sample.f,
                            sample.s, target));
  }

  Query& query_;
  const std::string& algorithm_;
  const ConfigurationRay& ray_;
  const double diagonal_;
  int measurements_ = 0;
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
    RayMarch march(*query_, name_, ray_, a_.diagonal());
    // Each mesh lies in the ball of half a diagonal about its centre.
    const double reach = 0.5 * (a_.diagonal() + b_.diagonal());
    const bool alone = march_ == SphereMarch::conservative;
    Sample outer;
    work_.assign(targets.size(), 0);
    for (std::size_t k = 0; k < targets.size(); ++k) {
      const int before = march.measurements();
      if (alone || k == 0) outer = march.measure(reach + targets[k]);
      const bool hit = alone ? march.advance_conservatively(targets[k], outer) : march.advance(targets[k], outer);
      work_[k] = static_cast<std::uint64_t>(march.measurements() - before);
      translations[k] = hit ? outer.s : std::numeric_limits<double>::quiet_NaN();
      residuals[k] = hit ? std::abs(outer.f - targets[k]) : 0.0;
    }
    measurements_ += static_cast<std::uint64_t>(march.measurements());
  }

  std::uint64_t measurements() const override { return measurements_; }
  std::span<const std::uint64_t> work() const override { return work_; }

 private:
  const Mesh& a_;
  const Mesh& b_;
  const SphereMarch march_;
  const std::string& name_;
  std::unique_ptr<Query> query_;
  ConfigurationRay ray_;
  std::uint64_t measurements_ = 0;
  std::vector<std::uint64_t> work_;  // measurements for each target
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
