#include <sixdof/configuration/verification.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <random>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/configuration/bucket.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/oracle/overlap_global.h>
#include <sixdof/oracle/solid.h>
#include <sixdof/query/require_distance.h>

namespace sixdof {
namespace {

/// Targets are products of a percentage and a diagonal that the set's maker may have rounded in another order.
constexpr double k_target_rounding = 1e-14;

/// One kind of quantity along rays. What it calls missing is positive as long as the target has not been met.
class Gauge {
 public:
  virtual ~Gauge() = default;
  virtual std::string name() const = 0;
  virtual double measure(const ConfigurationRay& ray, double s) = 0;
  virtual double missing(const ConfigurationRay& ray, double s, double target) = 0;
  /// A way inwards on which what is missing cannot be made up.
  virtual double safe_way(const ConfigurationRay& ray, double missing) = 0;
};

class DistanceGauge final : public Gauge {
 public:
  DistanceGauge(const Algorithm& oracle, const Mesh& a, const Mesh& b)
      : name_(oracle.traits().name), query_(oracle.prepare(a, b, oracle.settings())) {}
  std::string name() const override { return name_; }
  double measure(const ConfigurationRay& ray, double s) override { return require_distance(*query_, name_, ray.pose(s)).distance; }
  double missing(const ConfigurationRay& ray, double s, double target) override { return measure(ray, s) - target; }
  double safe_way(const ConfigurationRay& /*ray*/, double missing) override { return missing; }

 private:
  std::string name_;
  std::unique_ptr<Query> query_;
};

class VolumeGauge final : public Gauge {
 public:
  VolumeGauge(const Mesh& a, const Mesh& b)
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
  double missing(const ConfigurationRay& ray, double s, double target) override {
    return target - query_.evaluate(ray.pose(s)).volume;
  }
  /// No column along the ray gains more than the way.
  double safe_way(const ConfigurationRay& ray, double missing) override {
    const auto projected = [](const std::vector<Eigen::Vector3d>& areas, const Eigen::Vector3d& direction) {
      double sum = 0.0;
      for (const Eigen::Vector3d& area : areas) sum += 0.5 * std::abs(area.dot(direction));
      return sum;
    };
    if (ray.direction != direction_ || ray.R != R_) {
      direction_ = ray.direction;
      R_ = ray.R;
      steepest_ = std::min(projected(areas_a_, direction_), projected(areas_b_, R_.transpose() * direction_));
    }
    return missing / steepest_;
  }

 private:
  const Mesh& a_;
  const Mesh& b_;
  Tree tree_a_, tree_b_;
  Solid solid_a_, solid_b_;
  OverlapQuery query_;
  std::vector<Eigen::Vector3d> areas_a_, areas_b_;
  Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_ = Eigen::Matrix3d::Zero();
  double steepest_ = 0.0;  ///< Of these two.
};

class Verifier {
 public:
  Verifier(const ConfigurationSet& set, const Mesh& a, const Mesh& b, const Algorithm& oracle,
           const VerifyOptions& options)
      : set_(set), a_(a), b_(b), distance_(oracle, a, b), options_(options), random_(options.seed) {}

  Verdict run() {
    check_identity("A", set_.description().a, a_);
    check_identity("B", set_.description().b, b_);
    std::vector<double> previous;
    total_ = set_.buckets().size() * options_.sample;
    const BucketSummary* before = nullptr;
    for (const BucketSummary& bucket : set_.buckets()) {
      std::vector<double> translations = set_.read(bucket.key);
      check_copies(bucket, translations);
      check_summary(bucket);
      // Distances come from near to far, volumes from contact inwards.
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
  void note(std::string words) { result_.problems.push_back(std::move(words)); }

  std::string place(const BucketSummary& bucket, std::size_t i) const {
    const std::size_t n = set_.grid(bucket.key.kind).directions.size();
    return fmt::format("{}: rotation {}, direction {}", bucket.key.name(), i / n, i % n);
  }

  void check_identity(const char* which, const MeshIdentity& stamp, const Mesh& mesh) {
    if (stamp.triangles != mesh.triangles().size() || stamp.box_min != mesh.box().min() ||
        stamp.box_max != mesh.box().max() || stamp.volume != mesh.volume()) {
      note(fmt::format("mesh {}: triangle count, box or volume are not those of {}", which, mesh.name()));
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
      note(fmt::format("{}: target {} and target {} are not {} % of the {}", bucket.key.name(), bucket.nominal, bucket.target,
                       bucket.key.percent, distance ? "diagonal" : "volume"));
    }
    if (!(bucket.tolerance <= expected.tolerance) || !(bucket.largest_residual <= bucket.tolerance)) {
      note(fmt::format("{}: tolerance {} and largest residual {} are not within {}", bucket.key.name(),
                       bucket.tolerance, bucket.largest_residual, expected.tolerance));
    }
  }

  /// Equal rotations have equal rows.
  void check_copies(const BucketSummary& bucket, const std::vector<double>& translations) {
    const std::size_t n = set_.grid(bucket.key.kind).directions.size();
    const auto representative = DistinctRotations(set_.grid(bucket.key.kind).rotations).representative;
    for (std::size_t r = 0; r < representative.size(); ++r) {
      if (std::memcmp(&translations[r * n], &translations[representative[r] * n], n * sizeof(double)) == 0) continue;
      return note(fmt::format("{}: rotations {} and {} are equal, their translations are not", bucket.key.name(),
                              representative[r], r));
    }
  }

  /// What is met further in is unreachable where the other is.
  void check_order(const BucketSummary& inner, const std::vector<double>& near, const BucketSummary& outer,
                   const std::vector<double>& far) {
    const std::size_t n = set_.grid(inner.key.kind).directions.size();
    for (std::size_t i = 0; i < near.size(); ++i) {
      if (std::isnan(near[i]) || near[i] <= far[i]) continue;
      return note(fmt::format("rotation {}, direction {}: {} is met at {}, {} at {}", i / n, i % n, inner.key.name(),
                              near[i], outer.key.name(), far[i]));
    }
  }

  void measure_sample(const BucketSummary& bucket, const std::vector<double>& translations) {
    // Contact is measured as a distance.
    const bool contact = bucket.key.percent == 0;
    const bool distance = contact || bucket.key.kind == BucketKind::distance;
    if (!distance && !volume_) volume_.emplace(a_, b_);
    Gauge& gauge = distance ? static_cast<Gauge&>(distance_) : *volume_;
    const bool volume_contact = contact && bucket.key.kind == BucketKind::volume;
    const Sought sought{.place = bucket.key,
                        .target = volume_contact ? distance_bucket(a_, 0).target : bucket.target,
                        .tolerance = volume_contact ? distance_bucket(a_, 0).tolerance : bucket.tolerance};
    BucketVerdict verdict{.summary = bucket,
                          .oracle = gauge.name(),
                          .scale = scale(distance ? BucketKind::distance : BucketKind::volume),
                          .tolerance = sought.tolerance};
    for (std::size_t k = 0; k < options_.sample; ++k) {
      if (options_.cancelled && options_.cancelled()) throw Interrupted("interrupted");
      measure_one(gauge, sought, random_() % translations.size(), translations, verdict);
      ++verdict.sampled;
      if (options_.progress) options_.progress(++done_, total_);
    }
    result_.buckets.push_back(std::move(verdict));
  }

  struct Sought {
    BucketKey place;
    double target = 0.0, tolerance = 0.0;
  };

  void measure_one(Gauge& gauge, const Sought& sought, std::size_t i, const std::vector<double>& translations,
                   BucketVerdict& verdict) {
    const BucketSummary& bucket = verdict.summary;
    const Grid& grid = set_.grid(bucket.key.kind);
    const std::size_t n = grid.directions.size();
    ConfigurationRay ray(a_, b_, grid.rotations[i / n]);
    ray.direction = grid.directions[i % n];
    const double s = translations[i];
    if (std::isnan(s)) {
      const double hit = march(gauge, ray, sought, 0.0);
      if (!std::isnan(hit) && ++verdict.false_nan == 1) {
        note(fmt::format("{}: said to be unreachable, but the target is passed at s = {}", place(bucket, i), hit));
      }
      return;
    }
    ++verdict.reachable;
    const double measured = gauge.measure(ray, s);
    const double residual = std::abs(measured - sought.target);
    verdict.largest_residual = std::max(verdict.largest_residual, residual);
    if (!(residual <= sought.tolerance) && ++verdict.wrong_value == 1) {
      note(fmt::format("{}: {} instead of {}", place(bucket, i), measured, sought.target));
    }
    const double hit = march(gauge, ray, sought, s);
    if (!std::isnan(hit) && ++verdict.earlier_hit == 1) {
      note(fmt::format("{}: s = {}, but the target is passed at s = {} already", place(bucket, i), s, hit));
    }
  }

  /// From outside down to `end`: the first translation above it at which the target has been passed; NaN if there is none.
  double march(Gauge& gauge, const ConfigurationRay& ray, const Sought& sought, double end) {
    const double step = k_march_step * a_.diagonal();
    double s = 0.5 * (a_.diagonal() + b_.diagonal());
    if (sought.place.kind == BucketKind::distance) s += sought.target;
    while (s > end) {
      const double missing = gauge.missing(ray, s, sought.target);
      if (missing < -sought.tolerance) return s;
      s -= std::max(gauge.safe_way(ray, missing), step);
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

  const ConfigurationSet& set_;
  const Mesh& a_;
  const Mesh& b_;
  DistanceGauge distance_;
  std::optional<VolumeGauge> volume_;  ///< Made when a bucket needs it.
  const VerifyOptions& options_;
  std::mt19937_64 random_;
  Verdict result_;
  std::uint64_t done_ = 0, total_ = 0;
};

}  // namespace

Verdict verify_set(const ConfigurationSet& set, const Mesh& a, const Mesh& b, const Algorithm& oracle,
                   const VerifyOptions& options) {
  set.check_meshes(a, b);
  require_distance_queries(oracle);
  return Verifier(set, a, b, oracle, options).run();
}

}  // namespace sixdof
