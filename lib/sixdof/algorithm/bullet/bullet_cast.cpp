#include <sixdof/algorithm/bullet/bullet_cast.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <BulletCollision/NarrowPhaseCollision/btContinuousConvexCollision.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkConvexCast.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btSubSimplexConvexCast.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <sixdof/algorithm/bullet/bullet_mesh.h>
#include <sixdof/oracle/convex_hull.h>

namespace sixdof {
namespace {

constexpr const char* k_caster = "caster";
constexpr const char* k_margin = "margin";

/// Bullet takes the rotation between two transforms, which is at most pi.
constexpr double k_most_angle = 3.0;

class HullCastQuery final : public LibraryQuery {
 public:
  HullCastQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : hull_b_(convex_hull(b)), caster_(settings.choice(k_caster)), margin_(settings.number(k_margin)) {
    shape_a_ = shape_of(convex_hull(a), Eigen::Vector3d::Zero());
    set_reference(b.center());
  }

  Outcome<Impact> cast(const Motion& motion) override {
    if (const char* const why = motion.why_invalid(); why != nullptr) return fail(Status::non_finite, why);
    return guarded(motion.start, [&]() -> Outcome<Impact> {
      if (motion.reference != reference_) set_reference(motion.reference);
      const double parts = std::max(1.0, std::ceil(motion.rotation.norm() / k_most_angle));
      for (double i = 0.0; i < parts; ++i) {
        const Impact impact = cast_between(motion, i / parts, (i + 1.0) / parts);
        if (impact.hit) return impact;
      }
      return Impact{};
    });
  }

  Footprint footprint() const override {
    const auto points = static_cast<std::size_t>(shape_a_->getNumPoints() + shape_b_->getNumPoints());
    return {points * sizeof(btVector3), {{"vertices", static_cast<double>(points)}}};
  }

 private:
  std::unique_ptr<btConvexHullShape> shape_of(const Mesh& hull, const Eigen::Vector3d& origin) const {
    auto shape = std::make_unique<btConvexHullShape>();
    for (const Eigen::Vector3d& v : hull.vertices()) shape->addPoint(to_bullet(Eigen::Vector3d(v - origin)), false);
    shape->recalcLocalAabb();
    shape->setMargin(margin_);
    return shape;
  }

  /// Motions of one row have the same.
  void set_reference(const Eigen::Vector3d& reference) {
    reference_ = reference;
    shape_b_ = shape_of(hull_b_, reference);
  }

  /// Of B's shape.
  btTransform transform_at(const Motion& motion, double t) const {
    const Pose X = motion.pose_at(t);
    return to_bullet(Pose{X.R, X * reference_});
  }

  Impact cast_between(const Motion& motion, double from, double to) {
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver penetration;
    btContinuousConvexCollision continuous(shape_a_.get(), shape_b_.get(), &simplex, &penetration);
    btGjkConvexCast gjk(shape_a_.get(), shape_b_.get(), &simplex);
    btSubsimplexConvexCast subsimplex(shape_a_.get(), shape_b_.get(), &simplex);
    btConvexCast* caster = &continuous;
    if (motion.is_translation() && caster_ == "gjk") caster = &gjk;
    if (motion.is_translation() && caster_ == "subsimplex") caster = &subsimplex;
    btConvexCast::CastResult result;
    result.m_fraction = 1.0;
    const btTransform still = btTransform::getIdentity();
    const btTransform start = transform_at(motion, from), end = transform_at(motion, to);
    if (!caster->calcTimeOfImpact(still, still, start, end, result)) return {};
    Impact impact{.hit = true, .t = std::clamp(from + (to - from) * result.m_fraction, 0.0, 1.0)};
    const Eigen::Vector3d normal(result.m_normal.x(), result.m_normal.y(), result.m_normal.z());
    // Bullet's is on B, towards A.
    if (normal.allFinite() && normal.norm() > 0.0) impact.normal = -normal.normalized();
    return impact;
  }

  const Mesh hull_b_;
  const std::string caster_;
  const double margin_;
  Eigen::Vector3d reference_ = Eigen::Vector3d::Zero();
  std::unique_ptr<btConvexHullShape> shape_a_, shape_b_;
};

}  // namespace

std::unique_ptr<Algorithm> make_bullet_hull_algorithm() {
  return make_algorithm<HullCastQuery>(
      {.name = "bullet-hull",
       .version = fmt::format("{}.{} double", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100),
       .summary = "Bullet's convex casts of the convex hulls of both meshes: first contacts",
       .answers = {.cast = true},
       .parameters = {Parameter::choice(
                          k_caster,
                          "continuous: Bullet's for all motions; gjk (with a margin above 0), subsimplex: for "
                          "those that do not rotate",
                          "continuous", {"continuous", "gjk", "subsimplex"}),
                      Parameter::number(k_margin, "hulls are thickened by this length; Bullet's own default is 0.04",
                                        "length", "0", 0.0, 1e9)},
       .body = Body::convex_hull});
}

}  // namespace sixdof
