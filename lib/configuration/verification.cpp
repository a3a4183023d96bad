#include <sixdof/configuration/verification.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/configuration/distance_generator.h>

namespace sixdof {
namespace {

/// Targets are products of a percentage and a diagonal that the set's maker may have rounded in another order.
constexpr double k_target_rounding = 1e-14;

class Verifier {
 public:
  Verifier(const ConfigurationSet& set, const Mesh& a, const Mesh& b, const DistanceSource& oracle,
           const VerifyOptions& options)
      : set_(set), a_(a), b_(b), probe_(oracle.prepare(a, b)), options_(options), random_(options.seed) {}

  Verdict run() {
    check_stamp("A", set_.description().a, a_);
    check_stamp("B", set_.description().b, b_);
    std::vector<double> nearer;
    std::string nearer_name;
    total_ = set_.buckets().size() * options_.sample;
    for (const BucketSummary& bucket : set_.buckets()) {
      const std::vector<double> travel = set_.read(bucket.key);
      check_copies(bucket, travel);
      BucketVerdict verdict{.summary = bucket};
      if (bucket.key.kind == BucketKind::distance) {
        check_summary(bucket);
        if (!nearer.empty()) check_order(nearer_name, nearer, bucket.key.name(), travel);
        nearer = travel;
        nearer_name = bucket.key.name();
        measure_sample(travel, verdict);
      }
      result_.buckets.push_back(verdict);
    }
    return std::move(result_);
  }

 private:
  void note(std::string words) { result_.problems.push_back(std::move(words)); }

  std::string place(const BucketSummary& bucket, std::size_t i) const {
    const std::size_t n = set_.grid().directions.size();
    return fmt::format("{}: rotation {}, direction {}", bucket.key.name(), i / n, i % n);
  }

  void check_stamp(const char* which, const MeshStamp& stamp, const Mesh& mesh) {
    if (stamp.triangles != mesh.triangles().size() || stamp.box_min != mesh.box().min() ||
        stamp.box_max != mesh.box().max() || stamp.volume != mesh.volume()) {
      note(fmt::format("mesh {}: triangle count, box or volume are not those of {}", which, mesh.name()));
    }
  }

  void check_summary(const BucketSummary& bucket) {
    const BucketSummary expected = distance_bucket(a_, bucket.key.percent);
    const double rounding = k_target_rounding * a_.diagonal();
    if (!(std::abs(bucket.target - expected.target) <= rounding) ||
        !(std::abs(bucket.aim - expected.aim) <= rounding)) {
      note(fmt::format("{}: target {} and aim {} are not {} % of the diagonal", bucket.key.name(), bucket.target,
                       bucket.aim, bucket.key.percent));
    }
    if (!(bucket.tolerance <= expected.tolerance) || !(bucket.largest_residual <= bucket.tolerance)) {
      note(fmt::format("{}: tolerance {} and largest residual {} are not within {}", bucket.key.name(),
                       bucket.tolerance, bucket.largest_residual, expected.tolerance));
    }
  }

  /// Equal rotations have equal rows.
  void check_copies(const BucketSummary& bucket, const std::vector<double>& travel) {
    const std::size_t n = set_.grid().directions.size();
    const auto representative = representatives(set_.grid().rotations);
    for (std::size_t r = 0; r < representative.size(); ++r) {
      if (std::memcmp(&travel[r * n], &travel[representative[r] * n], n * sizeof(double)) == 0) continue;
      return note(fmt::format("{}: rotations {} and {} are equal, their travels are not", bucket.key.name(),
                              representative[r], r));
    }
  }

  /// A smaller target is met further in, and is unreachable where a larger one is.
  void check_order(const std::string& near_name, const std::vector<double>& near, const std::string& far_name,
                   const std::vector<double>& far) {
    const std::size_t n = set_.grid().directions.size();
    for (std::size_t i = 0; i < near.size(); ++i) {
      if (std::isnan(near[i]) || near[i] <= far[i]) continue;
      return note(fmt::format("rotation {}, direction {}: {} is met at {}, {} at {}", i / n, i % n, near_name, near[i],
                              far_name, far[i]));
    }
  }

  void measure_sample(const std::vector<double>& travel, BucketVerdict& verdict) {
    verdict.measured = true;
    for (std::size_t k = 0; k < options_.sample; ++k) {
      if (options_.cancelled && options_.cancelled()) throw Interrupted("interrupted");
      measure_one(random_() % travel.size(), travel, verdict);
      ++verdict.sampled;
      if (options_.progress) options_.progress(++done_, total_);
    }
  }

  void measure_one(std::size_t i, const std::vector<double>& travel, BucketVerdict& verdict) {
    const std::size_t n = set_.grid().directions.size();
    const BucketSummary& bucket = verdict.summary;
    ConfigurationRay ray(a_, b_, set_.grid().rotations[i / n]);
    ray.direction = set_.grid().directions[i % n];
    const double s = travel[i];
    if (std::isnan(s)) {
      const double hit = march(ray, bucket, 0.0);
      if (!std::isnan(hit) && ++verdict.false_nan == 1) {
        note(fmt::format("{}: said to be unreachable, but nearer than the target at s = {}", place(bucket, i), hit));
      }
      return;
    }
    ++verdict.reachable;
    const double measured = probe_->measure(ray.pose(s)).distance;
    const double residual = std::abs(measured - bucket.aim);
    verdict.largest_residual = std::max(verdict.largest_residual, residual);
    if (!(residual <= bucket.tolerance) && ++verdict.wrong_distance == 1) {
      note(fmt::format("{}: distance {} instead of {}", place(bucket, i), measured, bucket.aim));
    }
    const double hit = march(ray, bucket, s);
    if (!std::isnan(hit) && ++verdict.earlier_hit == 1) {
      note(fmt::format("{}: s = {}, but nearer than the target at s = {} already", place(bucket, i), s, hit));
    }
  }

  /// From outside down to `end`: the first travel above it at which the distance is below the aim; NaN if there is
  /// none.
  double march(const ConfigurationRay& ray, const BucketSummary& bucket, double end) {
    const double step = k_march_step * a_.diagonal();
    double s = 0.5 * (a_.diagonal() + b_.diagonal()) + bucket.aim;
    while (s > end) {
      const double above = probe_->measure(ray.pose(s)).distance - bucket.aim;
      if (above < -bucket.tolerance) return s;
      s -= std::max(above, step);
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

  const ConfigurationSet& set_;
  const Mesh& a_;
  const Mesh& b_;
  std::unique_ptr<DistanceProbe> probe_;
  const VerifyOptions& options_;
  std::mt19937_64 random_;
  Verdict result_;
  std::uint64_t done_ = 0, total_ = 0;
};

}  // namespace

Verdict verify_set(const ConfigurationSet& set, const Mesh& a, const Mesh& b, const DistanceSource& oracle,
                   const VerifyOptions& options) {
  set.check_meshes(a, b);
  return Verifier(set, a, b, oracle, options).run();
}

}  // namespace sixdof
