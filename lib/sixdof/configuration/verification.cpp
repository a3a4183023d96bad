#include <sixdof/configuration/verification.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <random>

#include <fmt/format.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/oracle/overlap_by_columns.h>
#include <sixdof/oracle/solid.h>
#include <sixdof/query/require_distance.h>

namespace sixdof {
namespace {

/// Rounding of a target, in units of A's diagonal or volume: the product of percentage and scale may be evaluated in
/// another order than the writer of the set did.
constexpr double k_target_rounding = 1e-14;

/// A quantity that is measured along rays.
class Quantity {
 public:
  virtual ~Quantity() = default;
  virtual std::string name() const = 0;
  virtual double measure(const ConfigurationRay& ray, double s) = 0;
  /// How far the target is from being met at s: positive outside of the hit, negative beyond it.
  virtual double remaining(const ConfigurationRay& ray, double s, double target) = 0;
  /// A displacement inwards within which the target cannot be met.
  virtual double safe_displacement(const ConfigurationRay& ray, double remaining) = 0;
};

class DistanceQuantity final : public Quantity {
 public:
  DistanceQuantity(const Algorithm& oracle, const Mesh& a, const Mesh& b)
      : name_(oracle.traits().name), query_(oracle.prepare(a, b, oracle.settings())) {}
  std::string name() const override { return name_; }
  double measure(const ConfigurationRay& ray, double s) override {
    return require_distance(*query_, name_, ray.pose(s)).distance;
  }
  double remaining(const ConfigurationRay& ray, double s, double target) override { return measure(ray, s) - target; }
  double safe_displacement(const ConfigurationRay& /*ray*/, double remaining) override { return remaining; }

 private:
  std::string name_;
  std::unique_ptr<Query> query_;
};

class VolumeQuantity final : public Quantity {
 public:
  VolumeQuantity(const Mesh& a, const Mesh& b)
      : a_(a),
        b_(b),
        tree_a_(a),
        tree_b_(b),
        solid_a_(a, tree_a_),
        solid_b_(b, tree_b_),
        query_(solid_a_, solid_b_),
        areas_a_(area_vectors(tree_a_)),
        areas_b_(area_vectors(tree_b_)) {}
  std::string name() const override { return "columns"; }
  double measure(const ConfigurationRay& ray, double s) override {
    return overlap_volume_by_columns(a_, b_, ray.pose(s));
  }
  double remaining(const ConfigurationRay& ray, double s, double target) override {
    return target - query_.evaluate(ray.pose(s)).volume;
  }
  /// Every column along the ray gains at most the displacement in length, and the columns that overlap lie in the
  /// projections of both meshes.
  double safe_displacement(const ConfigurationRay& ray, double remaining) override {
    const auto projected = [](const std::vector<Eigen::Vector3d>& areas, const Eigen::Vector3d& direction) {
      double sum = 0.0;
      for (const Eigen::Vector3d& area : areas) sum += 0.5 * std::abs(area.dot(direction));
      return sum;
    };
    if (ray.direction != direction_ || ray.R != R_) {
      direction_ = ray.direction;
      R_ = ray.R;
      area_ = std::min(projected(areas_a_, direction_), projected(areas_b_, R_.transpose() * direction_));
    }
    return remaining / area_;
  }

 private:
  const Mesh& a_;
  const Mesh& b_;
  Tree tree_a_, tree_b_;
  Solid solid_a_, solid_b_;
  OverlapQuery query_;
  std::vector<Eigen::Vector3d> areas_a_, areas_b_;
  double area_ = 0.0;  ///< Upper bound on the area of the overlap projected along direction_, for the rotation R_.
  Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_ = Eigen::Matrix3d::Zero();
};

class Verifier {
 public:
  Verifier(const ConfigurationSet& set, const Mesh& a, const Mesh& b, const Algorithm& oracle,
           const VerificationSample& sample, const RunOptions& run)
      : set_(set), a_(a), b_(b), distance_(oracle, a, b), sample_(sample), run_(run), random_(sample.seed) {}

  Verdict verify() {
    check_identity("A", set_.description().a, a_);
    check_identity("B", set_.description().b, b_);
    std::vector<double> previous;
    total_ = set_.buckets().size() * sample_.size;
    const BucketSummary* before = nullptr;
    for (const BucketSummary& bucket : set_.buckets()) {
      std::vector<double> translations = set_.read(bucket.key);
      check_repeats(bucket, translations);
      check_summary(bucket);
      // Buckets ascend: distances from near to far, volumes from contact inwards.
      if (before != nullptr && before->key.kind == bucket.key.kind) {
        const bool inwards = bucket.key.kind == BucketKind::volume;
        check_order(inwards ? bucket : *before, inwards ? translations : previous, inwards ? *before : bucket,
                    inwards ? previous : translations);
      }
      measure_sample(bucket, translations);
      previous = std::move(translations);
      before = &bucket;
    }
    return std::move(result_);
  }

 private:
  void add_problem(std::string words) { result_.problems.push_back(std::move(words)); }

  std::string configuration(const BucketSummary& bucket, std::size_t i) const {
    const std::size_t n = set_.grid(bucket.key.kind).directions.size();
    return fmt::format("{}: rotation {}, direction {}", bucket.key.name(), i / n, i % n);
  }

  void check_identity(const char* which, const MeshIdentity& expected, const Mesh& mesh) {
    if (expected.triangles != mesh.triangles().size() || expected.box_min != mesh.box().min() ||
        expected.box_max != mesh.box().max() || expected.volume != mesh.volume()) {
      add_problem(fmt::format("mesh {}: triangle count, box or volume are not those of {}", which, mesh.name()));
    }
  }

  double scale(BucketKind kind) const { return kind == BucketKind::distance ? a_.diagonal() : a_.volume(); }

  void check_summary(const BucketSummary& bucket) {
    const bool distance = bucket.key.kind == BucketKind::distance;
    const BucketSummary expected =
        distance ? distance_bucket(a_, bucket.key.percent) : volume_bucket(a_, bucket.key.percent);
    const double rounding = k_target_rounding * scale(bucket.key.kind);
    if (!(std::abs(bucket.nominal - expected.nominal) <= rounding) ||
        !(std::abs(bucket.target - expected.target) <= rounding)) {
      add_problem(fmt::format("{}: nominal {} and target {} are not {} % of the {}", bucket.key.name(), bucket.nominal,
                              bucket.target, bucket.key.percent, distance ? "diagonal" : "volume"));
    }
    if (!(bucket.tolerance <= expected.tolerance) || !(bucket.largest_residual <= bucket.tolerance)) {
      add_problem(fmt::format("{}: tolerance {} and largest residual {} are not within {}", bucket.key.name(),
                              bucket.tolerance, bucket.largest_residual, expected.tolerance));
    }
  }

  /// Rows of equal rotations are equal.
  void check_repeats(const BucketSummary& bucket, const std::vector<double>& translations) {
    const std::size_t n = set_.grid(bucket.key.kind).directions.size();
    const auto representative = DistinctRotations(set_.grid(bucket.key.kind).rotations).representative;
    for (std::size_t r = 0; r < representative.size(); ++r) {
      if (std::memcmp(&translations[r * n], &translations[representative[r] * n], n * sizeof(double)) == 0) continue;
      return add_problem(fmt::format("{}: rotations {} and {} are equal, their translations are not", bucket.key.name(),
                                     representative[r], r));
    }
  }

  /// The inner target is met at no greater translation than the outer one, and nowhere if the outer one is not met.
  void check_order(const BucketSummary& inner, const std::vector<double>& near, const BucketSummary& outer,
                   const std::vector<double>& far) {
    const std::size_t n = set_.grid(inner.key.kind).directions.size();
    for (std::size_t i = 0; i < near.size(); ++i) {
      if (std::isnan(near[i]) || near[i] <= far[i]) continue;
      return add_problem(fmt::format("rotation {}, direction {}: {} is met at {}, {} at {}", i / n, i % n,
                                     inner.key.name(), near[i], outer.key.name(), far[i]));
    }
  }

  void measure_sample(const BucketSummary& bucket, const std::vector<double>& translations) {
    // Contact is measured as a distance.
    const bool contact = bucket.key.percent == 0;
    const bool distance = contact || bucket.key.kind == BucketKind::distance;
    if (!distance && !volume_) volume_.emplace(a_, b_);
    Quantity& quantity = distance ? static_cast<Quantity&>(distance_) : *volume_;
    const bool volume_contact = contact && bucket.key.kind == BucketKind::volume;
    const Target target{.kind = bucket.key.kind,
                        .value = volume_contact ? distance_bucket(a_, 0).target : bucket.target,
                        .tolerance = volume_contact ? distance_bucket(a_, 0).tolerance : bucket.tolerance};
    BucketVerdict verdict{.summary = bucket,
                          .oracle = quantity.name(),
                          .scale = scale(distance ? BucketKind::distance : BucketKind::volume),
                          .tolerance = target.tolerance};
    for (std::size_t k = 0; k < sample_.size; ++k) {
      run_.check_cancelled();
      measure_one(quantity, target, random_() % translations.size(), translations, verdict);
      ++verdict.sampled;
      if (run_.progress) run_.progress(++done_, total_);
    }
    result_.buckets.push_back(std::move(verdict));
  }

  struct Target {
    BucketKind kind;
    double value = 0.0, tolerance = 0.0;
  };

  void measure_one(Quantity& quantity, const Target& target, std::size_t i, const std::vector<double>& translations,
                   BucketVerdict& verdict) {
    const BucketSummary& bucket = verdict.summary;
    const Grid& grid = set_.grid(bucket.key.kind);
    const std::size_t n = grid.directions.size();
    ConfigurationRay ray(a_, b_, grid.rotations[i / n]);
    ray.direction = grid.directions[i % n];
    const double s = translations[i];
    if (std::isnan(s)) {
      const double hit = march(quantity, ray, target, 0.0);
      if (!std::isnan(hit) && ++verdict.false_nan == 1) {
        add_problem(fmt::format("{}: unreachable in the set, but the target is passed at s = {}",
                                configuration(bucket, i), hit));
      }
      return;
    }
    ++verdict.reachable;
    const double measured = quantity.measure(ray, s);
    const double residual = std::abs(measured - target.value);
    verdict.largest_residual = std::max(verdict.largest_residual, residual);
    if (!(residual <= target.tolerance) && ++verdict.wrong_value == 1) {
      add_problem(fmt::format("{}: {} instead of {}", configuration(bucket, i), measured, target.value));
    }
    const double hit = march(quantity, ray, target, s);
    if (!std::isnan(hit) && ++verdict.earlier_hit == 1) {
      add_problem(
          fmt::format("{}: s = {}, but the target is passed before, at s = {}", configuration(bucket, i), s, hit));
    }
  }

  /// Marches from outside to `end`. @return a translation at which the target has been passed; NaN if there is none
  double march(Quantity& quantity, const ConfigurationRay& ray, const Target& target, double end) {
    const double step = k_march_step * a_.diagonal();
    double s = 0.5 * (a_.diagonal() + b_.diagonal());
    if (target.kind == BucketKind::distance) s += target.value;
    while (s > end) {
      const double remaining = quantity.remaining(ray, s, target.value);
      if (remaining < -target.tolerance) return s;
      s -= std::max(quantity.safe_displacement(ray, remaining), step);
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

  const ConfigurationSet& set_;
  const Mesh& a_;
  const Mesh& b_;
  DistanceQuantity distance_;
  std::optional<VolumeQuantity> volume_;  ///< Prepared for the first bucket that needs it.
  const VerificationSample& sample_;
  const RunOptions& run_;
  std::mt19937_64 random_;
  Verdict result_;
  std::uint64_t done_ = 0, total_ = 0;
};

}  // namespace

Verdict verify_set(const ConfigurationSet& set, const Mesh& a, const Mesh& b, const Algorithm& oracle,
                   const VerificationSample& sample, const RunOptions& run) {
  set.check_meshes(a, b);
  require_distance_queries(oracle);
  return Verifier(set, a, b, oracle, sample, run).verify();
}

}  // namespace sixdof
