#include <sixdof/generation/impact_truth.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <sixdof/configuration/bucket.h>
#include <sixdof/oracle/distance.h>
#include <sixdof/oracle/ray_cast_search.h>

namespace sixdof {
namespace {

/// How far a line may pass the centre of A's box, in units of A's diagonal: a tenth of the ray cast's target, by which
/// the bodies are apart at its hit.
constexpr double k_offset = 0.1 * k_contact_target;

/// Largest deviation from a rotation for the ray cast, which takes it for one: the error is less than k_offset.
constexpr double k_rotation_error = 1e-13;

/// A translation as a ray: the centre of B's box is at distance s from that of A's box.
struct Ray {
  Eigen::Vector3d direction;  ///< Unit vector, from A to B.
  double start, length;       ///< s at t = 0; s falls by the length until t = 1.

  double time_of(double s) const { return (start - s) / length; }
};

}  // namespace

struct ImpactTruth::State {
  State(const Mesh& mesh_a, const Mesh& mesh_b)
      : a(mesh_a),
        b(mesh_b),
        oracle(a, b),
        query(oracle),
        cast_a(std::make_shared<const Tree>(a)),
        cast_b(std::make_shared<const Tree>(b)),
        search(cast_a, cast_b) {}

  /// None if the motion is not one, or does not go towards A.
  std::optional<Ray> ray_of(const Motion& motion) const {
    const double length = motion.translation.norm();
    if (!motion.is_translation() || !(length > 0.0)) return {};
    if ((motion.start.R.transpose() * motion.start.R - Eigen::Matrix3d::Identity()).norm() > k_rotation_error)
      return {};
    const Ray ray{motion.translation / -length, 0.0, length};
    const Eigen::Vector3d centers = motion.start * b.center() - a.center();
    const double start = centers.dot(ray.direction);
    if (start <= 0.0 || ray.direction.cross(centers).norm() > k_offset * a.diagonal()) return {};
    return Ray{ray.direction, start, length};
  }

  /// Up to when the bodies are apart by the ray cast: 0 where it does not tell, such as behind a hit from outside.
  double apart_by_ray(const Ray& ray, const Motion& motion, double& residual) {
    const double target = k_contact_target * a.diagonal();
    search.set_rotation(motion.start.R);
    search.start_ray(ray.direction);
    const ray_cast::Hit* const hit = search.find_next(target);
    if (hit == nullptr) return std::clamp(ray.time_of(0.0), 0.0, 1.0);
    if (hit->translation >= ray.start) return 0.0;
    const double t = ray.time_of(hit->translation);
    if (t >= 1.0) return 1.0;
    const double distance = query.distance(motion.pose_at(t)).distance;
    residual = std::abs(distance - target);
    return distance > 0.0 ? t : 0.0;
  }

  const Mesh& a;
  const Mesh& b;
  DistanceOracle oracle;
  DistanceQuery query;
  ray_cast::CastMesh cast_a, cast_b;
  ray_cast::RaySearch search;
};

ImpactTruth::ImpactTruth(const Mesh& a, const Mesh& b) : state_(std::make_unique<State>(a, b)) {}
ImpactTruth::~ImpactTruth() = default;

TrueImpact ImpactTruth::find(const Motion& motion) {
  TrueImpact found;
  AdvancementOptions options;
  if (motion.why_invalid() == nullptr && !state_->query.collide(motion.start)) {
    if (const auto ray = state_->ray_of(motion)) {
      options.from = state_->apart_by_ray(*ray, motion, found.residual);
      found.by_ray_cast = options.from > 0.0;
    }
  }
  if (options.from == 1.0) {
    found.bracket = {.kind = ImpactBracket::Kind::none, .t_free = 1.0, .t_touch = 1.0};
    found.bracket.closest = state_->query.distance(motion.pose_at(1.0));
  } else {
    found.bracket = advance(state_->query, state_->b.box(), motion, options);
  }
  found.clearance_at_end = distance_at(motion, 1.0);
  return found;
}

double ImpactTruth::distance_at(const Motion& motion, double t) {
  return state_->query.distance(motion.pose_at(t)).distance;
}

}  // namespace sixdof
