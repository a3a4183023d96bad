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
#include <sixdof/oracle/solid.h>
#include <sixdof/query/ask.h>

namespace sixdof {
namespace {

/// Rounding of a target, in units of A's diagonal or volume: the product of percentage and scale may be evaluated in
/// another order than the writer of the set did.
constexpr double k_target_rounding = 1e-14;

/// Translations at which a march that looked for the target with the makers' oracle is checked with the method of
/// measure(): one where the target seemed nearest, the others at random.
constexpr int k_checks_of_a_march = 3;

/// A quantity that is measured along rays; by itself a distance.
class Quantity {
 public:
  explicit Quantity(std::string method) : name(std::move(method)) {}
  virtual ~Quantity() = default;
  virtual double measure(const ConfigurationRay& ray, double s) = 0;
  /// How far the target is from being met at s: positive outside of the hit, negative beyond it.
  virtual double remaining(const ConfigurationRay& ray, double s, double target) { return measure(ray, s) - target; }
  /// A displacement inwards within which the target cannot be met.
  virtual double safe_displacement(const ConfigurationRay& /*ray*/, double remaining) { return remaining; }
  /// Whether remaining() is by another method than measure(): as measured, the target is passed at s by more than
  /// `tolerance`. False where remaining() says the same already.
  virtual bool also_passed(const ConfigurationRay& /*ray*/, double /*s*/, double /*target*/, double /*tolerance*/) {
    return false;
  }

  const std::string name;  ///< Of the method.
};

class DistanceQuantity final : public Quantity {
 public:
  DistanceQuantity(const Algorithm& oracle, const Mesh& a, const Mesh& b)
      : Quantity(oracle.traits().name), query_(oracle.prepare(a, b, oracle.settings())) {}
  double measure(const ConfigurationRay& ray, double s) override {
    return require_distance(*query_, name, ray.pose(s)).distance;
  }

 private:
  std::unique_ptr<Query> query_;
};

class VolumeQuantity final : public Quantity {
 public:
  VolumeQuantity(const Mesh& a, const Mesh& b)
      : Quantity("columns"),
        a_(a),
        b_(b),
        tree_a_(a),
        tree_b_(b),
        solid_a_(a, tree_a_),
        solid_b_(b, tree_b_),
        query_(solid_a_, solid_b_),
        areas_a_(area_vectors(tree_a_)),
        areas_b_(area_vectors(tree_b_)) {}
  double measure(const ConfigurationRay& ray, double s) override {
    return overlap_volume_by_columns(a_, b_, ray.pose(s));
  }
  double remaining(const ConfigurationRay& ray, double s, double target) override {
    return target - query_.evaluate(ray.pose(s)).volume;
  }
  bool also_passed(const ConfigurationRay& ray, double s, double target, double tolerance) override {
    return measure(ray, s) > target + tolerance;
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
    total_ = set_.buckets().size() * sample_.size;
    Bucket before;
    for (const BucketSummary& summary : set_.buckets()) {
      Bucket bucket{.summary = summary, .translations = set_.read(summary.key)};
      check_repeats(bucket);
      check_summary(summary);
      // Buckets ascend: distances from near to far, volumes from contact inwards.
      if (!before.translations.empty() && before.summary.key.kind == summary.key.kind) {
        const bool inwards = summary.key.kind == BucketKind::volume;
        check_order(inwards ? bucket : before, inwards ? before : bucket);
      }
      measure_sample(bucket);
      before = std::move(bucket);
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

  void check_summary(const BucketSummary& bucket) {
    const bool distance = bucket.key.kind == BucketKind::distance;
    const BucketSummary expected =
        distance ? distance_bucket(a_, bucket.key.percent) : volume_bucket(a_, bucket.key.percent);
    const double rounding = k_target_rounding * (distance ? a_.diagonal() : a_.volume());
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
  void check_repeats(const Bucket& bucket) {
    const auto& [summary, translations] = bucket;
    const Grid& grid = set_.grid(summary.key.kind);
    const std::size_t n = grid.directions.size();
    const auto representative = DistinctRotations(grid.rotations).representative;
    for (std::size_t r = 0; r < representative.size(); ++r) {
      if (std::memcmp(&translations[r * n], &translations[representative[r] * n], n * sizeof(double)) == 0) continue;
      return add_problem(fmt::format("{}: rotations {} and {} are equal, their translations are not",
                                     summary.key.name(), representative[r], r));
    }
  }

  /// The inner target is met at no greater translation than the outer one, and nowhere if the outer one is not met.
  void check_order(const Bucket& inner, const Bucket& outer) {
    const std::size_t n = set_.grid(inner.summary.key.kind).directions.size();
    for (std::size_t i = 0; i < inner.translations.size(); ++i) {
      const double near = inner.translations[i];
      const double far = outer.translations[i];
      if (std::isnan(near) || near <= far) continue;
      return add_problem(fmt::format("rotation {}, direction {}: {} is met at {}, {} at {}", i / n, i % n,
                                     inner.summary.key.name(), near, outer.summary.key.name(), far));
    }
  }

  void measure_sample(const Bucket& measured) {
    const auto& [bucket, translations] = measured;
    const bool volume = bucket.key.kind == BucketKind::volume;
    const bool by_volume = volume && bucket.key.percent != 0;  // contact is measured as a distance
    if (by_volume && !volume_) volume_.emplace(a_, b_);
    Quantity& quantity = by_volume ? static_cast<Quantity&>(*volume_) : distance_;
    BucketSummary target = bucket;
    if (volume && !by_volume) {
      target.target = distance_bucket(a_, 0).target;
      target.tolerance = distance_bucket(a_, 0).tolerance;
    }
    BucketVerdict verdict{.summary = bucket,
                          .oracle = quantity.name,
                          .scale = by_volume ? a_.volume() : a_.diagonal(),
                          .tolerance = target.tolerance};
    for (std::size_t k = 0; k < sample_.size; ++k) {
      run_.check_cancelled();
      measure_one(quantity, target, random_() % translations.size(), translations, verdict);
      ++verdict.sampled;
      if (run_.progress) run_.progress(++done_, total_);
    }
    result_.buckets.push_back(std::move(verdict));
  }

  /// @param target its target and tolerance
  void measure_one(Quantity& quantity, const BucketSummary& target, std::size_t i,
                   const std::vector<double>& translations, BucketVerdict& verdict) {
    const BucketSummary& bucket = verdict.summary;
    const Grid& grid = set_.grid(bucket.key.kind);
    const std::size_t n = grid.directions.size();
    const ConfigurationRay ray(a_, b_, grid.rotations[i / n], grid.directions[i % n]);
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
    const double residual = std::abs(measured - target.target);
    verdict.largest_residual = std::max(verdict.largest_residual, residual);
    if (!(residual <= target.tolerance) && ++verdict.wrong_value == 1) {
      add_problem(fmt::format("{}: {} instead of {}", configuration(bucket, i), measured, target.target));
    }
    const double hit = march(quantity, ray, target, s);
    if (!std::isnan(hit) && ++verdict.earlier_hit == 1) {
      add_problem(
          fmt::format("{}: s = {}, but the target is passed before, at s = {}", configuration(bucket, i), s, hit));
    }
  }

  /// Marches from outside to `end`. @return a translation at which the target has been passed; NaN if there is none
  double march(Quantity& quantity, const ConfigurationRay& ray, const BucketSummary& target, double end) {
    const double step = k_march_step * a_.diagonal();
    double start = 0.5 * (a_.diagonal() + b_.diagonal());
    if (target.key.kind == BucketKind::distance) start += target.target;
    if (!(start > end)) return std::numeric_limits<double>::quiet_NaN();
    double nearest = start;
    double least = std::numeric_limits<double>::infinity();
    for (double s = start; s > end;) {
      const double remaining = quantity.remaining(ray, s, target.target);
      if (remaining < -target.tolerance) return s;
      if (remaining < least) {
        least = remaining;
        nearest = s;
      }
      s -= std::max(quantity.safe_displacement(ray, remaining), step);
    }
    for (int k = 0; k < k_checks_of_a_march; ++k) {
      const double s = k == 0 ? nearest : std::uniform_real_distribution(end, start)(random_);
      if (quantity.also_passed(ray, s, target.target, target.tolerance)) return s;
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
