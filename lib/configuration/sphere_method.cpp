#include <sixdof/configuration/sphere_method.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

/// |f - aim| at which the search is content, in units of A's box diagonal: rounding of a distance between meshes whose
/// coordinates are about as large as the diagonal is 1e-16 to 1e-15, and a thousandth of k_distance_tolerance leaves
/// room for oracles that round differently.
constexpr double k_content = 1e-12;

/// Measurements on one ray after which the oracle is taken to be no distance function. Smooth cases need ten; a channel
/// as narrow as the resolution needs one per resolution.
constexpr int k_most_measurements = 2'000'000;

/// A measurement at travel s.
struct Sample {
  double s = 0.0;
  double f = 0.0;      ///< Distance.
  double slope = 0.0;  ///< df/ds of the closest pair of points; 0 if not known.
};

class RayMarch {
 public:
  RayMarch(DistanceProbe& probe, const ConfigurationRay& ray, double diagonal)
      : probe_(probe), ray_(ray), diagonal_(diagonal) {}

  int measurements() const { return measurements_; }

  Sample measure(double s) {
    if (++measurements_ > k_most_measurements) {
      throw Error(fmt::format("no end after {} measurements of the distance", k_most_measurements));
    }
    const ProbedDistance d = probe_.measure(ray_.pose(s));
    Sample sample{.s = s, .f = d.distance};
    if (d.has_witnesses && d.distance > 0.0) sample.slope = (d.on_b - d.on_a).dot(ray_.direction) / d.distance;
    return sample;
  }

  /// The first hit at or below `outer.s`, given that there is none above. Nothing if the aim is not met down to s = 0;
  /// then `outer` is at s = 0. Otherwise `outer` is the hit.
  bool advance(double aim, Sample& outer) {
    for (;;) {
      if (outer.f <= aim + content()) return true;
      if (outer.s == 0.0) return false;
      const Sample inner = measure(std::max(0.0, outer.s - step(outer, aim)));
      const double clear = clear_above(inner, outer, aim);
      const bool gap_closed = clear - inner.s <= resolution();
      if (gap_closed && inner.f >= aim - content()) {
        outer = inner;
      } else if (gap_closed) {
        outer = bisect(inner, outer, aim);
        return true;
      } else {
        outer = measure(clear);
        // Rounding of a crossing at `clear` itself.
        if (outer.f < aim - content()) throw_lost(aim, outer);
      }
    }
  }

  /// The same by conservative steps.
  bool advance_conservatively(double aim, Sample& outer) {
    while (outer.f > aim + content()) {
      if (outer.s == 0.0) return false;
      outer = measure(std::max(0.0, outer.s - (outer.f - aim)));
    }
    if (outer.f < aim - content()) throw_lost(aim, outer);
    return true;
  }

 private:
  double content() const { return k_content * diagonal_; }
  double resolution() const { return k_first_hit_resolution * diagonal_; }

  /// Length of the next step inwards: Newton's where it can be certified, otherwise as far as it could be if the
  /// distance fell no faster than to the aim.
  double step(const Sample& outer, double aim) const {
    const double above = outer.f - aim;
    const double certain = std::max(std::sqrt(above * (outer.f + aim)), above + resolution());
    if (outer.slope <= 0.0) return certain;
    return std::clamp(above / outer.slope, above, certain);
  }

  /// The least t in [inner.s, outer.s] such that f > aim is certain on (t, outer.s].
  double clear_above(const Sample& inner, const Sample& outer, double aim) const {
    const double from_outer = outer.s - (outer.f - aim);
    const double from_inner = inner.s + std::max(0.0, inner.f - aim);
    // The parabola y^2 + m y + c of f^2 - aim^2, y = s - inner.s.
    const double width = outer.s - inner.s;
    const double m = (outer.f - inner.f) * (outer.f + inner.f) / width - width;
    const double c = (inner.f - aim) * (inner.f + aim);
    const double discriminant = 0.25 * m * m - c;
    if (discriminant < 0.0) return inner.s;
    const double root = m > 0.0 ? -c / (0.5 * m + std::sqrt(discriminant)) : std::sqrt(discriminant) - 0.5 * m;
    if (root >= width) return inner.s;  // f^2 > aim^2 at both ends: then the other root is beyond, too
    const double clear = std::min(from_outer, inner.s + root);
    return clear <= from_inner ? inner.s : clear;
  }

  /// A crossing between two samples, f(inner) < aim < f(outer).
  Sample bisect(Sample inner, Sample outer, double aim) {
    // Illinois: false position that halves the weight of an end that stays; plain halving when that is slow.
    double inner_weight = 1.0, outer_weight = 1.0;
    double width_before = outer.s - inner.s;
    for (int i = 0;; ++i) {
      double s = 0.5 * (inner.s + outer.s);
      const bool slow = i % 4 == 3 && outer.s - inner.s > 0.25 * width_before;
      if (i % 4 == 3) width_before = outer.s - inner.s;
      if (!slow) {
        const double low = inner_weight * (inner.f - aim);
        const double high = outer_weight * (outer.f - aim);
        s = inner.s - low * (outer.s - inner.s) / (high - low);
      }
      if (!(s > inner.s && s < outer.s)) s = 0.5 * (inner.s + outer.s);
      if (!(s > inner.s && s < outer.s)) return best(inner, outer, aim);
      const Sample middle = measure(s);
      if (std::abs(middle.f - aim) <= content()) return middle;
      if (middle.f > aim) {
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
  Sample best(const Sample& inner, const Sample& outer, double aim) const {
    const Sample& chosen = std::abs(inner.f - aim) < std::abs(outer.f - aim) ? inner : outer;
    if (std::abs(chosen.f - aim) > k_distance_tolerance * diagonal_) throw_lost(aim, chosen);
    return chosen;
  }

  [[noreturn]] void throw_lost(double aim, const Sample& sample) const {
    throw Error(fmt::format("the oracle's distance jumps: {} at s = {}, where {} was bound to be met", sample.f,
                            sample.s, aim));
  }

  DistanceProbe& probe_;
  const ConfigurationRay& ray_;
  const double diagonal_;
  int measurements_ = 0;
};

class SphereMethodSolver final : public RaySolver {
 public:
  SphereMethodSolver(const DistanceSource& oracle, SphereMarch march, const Mesh& a, const Mesh& b)
      : a_(a), b_(b), march_(march), probe_(oracle.prepare(a, b)) {}

  void set_rotation(const Eigen::Vector4d& rotation) override { ray_ = ConfigurationRay(a_, b_, rotation); }

  void solve(const Eigen::Vector3d& direction, std::span<const double> aims, std::span<double> travel,
             std::span<double> residuals) override {
    ray_.direction = direction;
    RayMarch march(*probe_, ray_, a_.diagonal());
    // Each mesh lies in the ball of half a diagonal about its centre.
    const double reach = 0.5 * (a_.diagonal() + b_.diagonal());
    const bool alone = march_ == SphereMarch::conservative;
    Sample outer;
    work_.assign(aims.size(), 0);
    for (std::size_t k = 0; k < aims.size(); ++k) {
      const int before = march.measurements();
      if (alone || k == 0) outer = march.measure(reach + aims[k]);
      const bool hit = alone ? march.advance_conservatively(aims[k], outer) : march.advance(aims[k], outer);
      work_[k] = static_cast<std::uint64_t>(march.measurements() - before);
      travel[k] = hit ? outer.s : std::numeric_limits<double>::quiet_NaN();
      residuals[k] = hit ? std::abs(outer.f - aims[k]) : 0.0;
    }
    measurements_ += static_cast<std::uint64_t>(march.measurements());
  }

  std::uint64_t measurements() const override { return measurements_; }
  std::span<const std::uint64_t> work() const override { return work_; }

 private:
  const Mesh& a_;
  const Mesh& b_;
  const SphereMarch march_;
  std::unique_ptr<DistanceProbe> probe_;
  ConfigurationRay ray_;
  std::uint64_t measurements_ = 0;
  std::vector<std::uint64_t> work_;  // measurements for each aim
};

class SphereMethod final : public DistanceGenerator {
 public:
  SphereMethod(std::shared_ptr<const DistanceSource> oracle, SphereMarch march)
      : oracle_(std::move(oracle)), march_(march) {}
  const std::string& oracle_name() const override { return oracle_->name(); }
  const std::string& oracle_version() const override { return oracle_->version(); }
  std::unique_ptr<RaySolver> prepare(const Mesh& a, const Mesh& b) const override {
    return std::make_unique<SphereMethodSolver>(*oracle_, march_, a, b);
  }

 private:
  std::shared_ptr<const DistanceSource> oracle_;
  const SphereMarch march_;
};

}  // namespace

std::unique_ptr<DistanceGenerator> make_sphere_method(std::shared_ptr<const DistanceSource> oracle, SphereMarch march) {
  return std::make_unique<SphereMethod>(std::move(oracle), march);
}

}  // namespace sixdof
