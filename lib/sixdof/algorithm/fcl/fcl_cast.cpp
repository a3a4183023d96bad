#include <fcl/config.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <fcl/math/bv/OBBRSS.h>
#include <fcl/math/bv/RSS.h>
#include <fcl/math/motion/interp_motion.h>
#include <fcl/math/motion/translation_motion.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fcl/narrowphase/detail/conservative_advancement_func_matrix.h>

#include <sixdof/algorithm/fcl/fcl.h>
#include <sixdof/algorithm/fcl/fcl_mesh.h>

namespace sixdof {
namespace {

constexpr const char* k_solver = "solver";
constexpr const char* k_iterations = "iterations";

/// FCL takes the rotation between two poses, which is at most pi. Longer ones are asked in parts of at most this angle.
constexpr double k_most_angle = 3.0;

/// Boxes with swept spheres for yes/no, swept spheres alone for conservative advancement: the bounds on motion of FCL
/// 0.7 are zero for volumes other than RSS (tbv_motion_bound_visitor-inl.h), and yes/no of trees of RSS copies the
/// models.
using NaiveVolume = fcl::OBBRSSd;
using AdvancementVolume = fcl::RSSd;

enum class Solver {
  naive,
  advancement,
  oriented
};

Solver solver_of(const Settings& settings) {
  const std::string& name = settings.choice(k_solver);
  return name == "naive" ? Solver::naive : name == "advancement" ? Solver::advancement : Solver::oriented;
}

template <class BV>
class FclCastQuery final : public LibraryQuery {
 public:
  FclCastQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : models_(ShapePair<Model>::of(a, b, build_fcl_model<BV>)), solver_(solver_of(settings)) {
    request_.num_max_iterations = static_cast<std::size_t>(settings.number(k_iterations));
    request_.toc_err = 1.0 / settings.number(k_iterations);
    request_.ccd_solver_type = solver_ == Solver::naive ? fcl::CCDC_NAIVE : fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
  }

  Outcome<Impact> cast(const Motion& motion) override {
    if (const char* const why = motion.why_invalid(); why != nullptr) return fail(Status::non_finite, why);
    return guarded(motion.start, [&]() -> Outcome<Impact> {
      const double parts = std::max(1.0, std::ceil(motion.rotation.norm() / k_most_angle));
      for (double i = 0.0; i < parts; ++i) {
        const Impact impact = cast_between(motion, i / parts, (i + 1.0) / parts);
        if (impact.hit) return impact;
      }
      return Impact{};
    });
  }

  Footprint footprint() const override {
    Footprint sum;
    double nodes = 0.0;
    models_.for_each([&](const Model& model) {
      nodes += model.getNumBVs();
      sum.bytes += sizeof(model) + static_cast<std::size_t>(model.getNumBVs()) * sizeof(fcl::BVNode<BV>) +
                   static_cast<std::size_t>(model.num_tris) * (sizeof(fcl::Triangle) + sizeof(unsigned)) +
                   static_cast<std::size_t>(model.num_vertices) * sizeof(fcl::Vector3d);
    });
    sum.counts = {{"nodes", nodes}};
    return sum;
  }

 private:
  using Model = fcl::BVHModel<BV>;

  /// The motions are made anew for each query: FCL keeps the time that it reached in them.
  Impact cast_between(const Motion& motion, double from, double to) {
    const Pose start = motion.pose_at(from), end = motion.pose_at(to);
    std::optional<double> time;
    if (motion.is_translation()) {
      time = time_of_contact(fcl::TranslationMotion<double>(to_fcl(start), to_fcl(end)), fcl::CCDM_TRANS);
    } else {
      // Of its constructors only this one sets all that it uses: those without a reference point leave that unset, and
      // the one of two transforms and a point leaves the velocities unset.
      time = time_of_contact(fcl::InterpMotion<double>(start.R, start.t, end.R, end.t, motion.reference),
                             fcl::CCDM_LINEAR);
    }
    if (!time) return {};
    return {.hit = true, .t = std::min(1.0, from + (to - from) * *time)};
  }

  /// The time of contact with B on a motion; none if there is none.
  std::optional<double> time_of_contact(const fcl::MotionBase<double>& moving, fcl::CCDMotionType type) {
    const fcl::TranslationMotion<double> still(fcl::Transform3d::Identity(), fcl::Transform3d::Identity());
    if constexpr (std::is_same_v<BV, AdvancementVolume>) {
      if (solver_ == Solver::oriented) {
        double time = 0.0;
        fcl::CollisionResultd ignored;
        const bool hit = fcl::detail::conservativeAdvancementMeshOriented<
            BV, fcl::detail::MeshConservativeAdvancementTraversalNodeRSS<double>>(
            *models_.a, &still, *models_.b, &moving, fcl::CollisionRequestd(), ignored, time);
        return hit ? std::optional(time) : std::nullopt;
      }
    }
    fcl::ContinuousCollisionRequestd request = request_;
    request.ccd_motion_type = type;
    fcl::ContinuousCollisionResultd result;
    fcl::continuousCollide<double>(models_.a.get(), &still, models_.b.get(), &moving, request, result);
    return result.is_collide ? std::optional(result.time_of_contact) : std::nullopt;
  }

  const ShapePair<Model> models_;
  const Solver solver_;
  fcl::ContinuousCollisionRequestd request_;
};

/// Prepares a query of the solver's volume.
class FclCast final : public Algorithm {
 public:
  explicit FclCast(Traits traits) : traits_(std::move(traits)) {}
  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const override {
    if (solver_of(settings) == Solver::naive) return std::make_unique<FclCastQuery<NaiveVolume>>(a, b, settings);
    return std::make_unique<FclCastQuery<AdvancementVolume>>(a, b, settings);
  }

 private:
  const Traits traits_;
};

}  // namespace

std::unique_ptr<Algorithm> make_fcl_cast_algorithm() {
  return std::make_unique<FclCast>(Traits{
      .name = "fcl-cast",
      .version = FCL_VERSION,
      .summary = "FCL's continuous collision: yes/no at equal steps, or conservative advancement",
      .answers = {.cast = true},
      .limits = {.surfaces_only = {.cast = true}},
      .parameters = {Parameter::choice(
                         k_solver,
                         "FCL's solver: yes/no at equal steps; conservative advancement as its public function "
                         "runs it; the same as its own function for trees of swept spheres does",
                         "naive", {"naive", "advancement", "oriented"}),
                     Parameter::count(k_iterations, "steps of naive; advancement does not look at it", "10", 2.0, 1e6)
                         .swept({"10", "100", "1000"})},
      .by_default = false});
}

}  // namespace sixdof
