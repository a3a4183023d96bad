#include <sixdof/stability/ray_algorithm.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/generation/volume_generator.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/stability/bodies.h>
#include <sixdof/stability/judge_shot.h>
#include <sixdof/stability/reference.h>

namespace sixdof::stability {
namespace {

using Translations = std::vector<double>;

Eigen::Vector4d rotation_of(const Shot& shot) {
  return {shot.X_AB.q.w(), shot.X_AB.q.x(), shot.X_AB.q.y(), shot.X_AB.q.z()};
}

/// From A's box centre to B's, in A's frame.
Eigen::Vector3d centre_offset(const Shot& shot) {
  return shot.X_AB.pose() * shot.b->box().center() - shot.a->box().center();
}

/// A ray of a shot, with how far a target is passed on it.
class Measure {
 public:
  Measure(TargetKind kind, const Shot& shot, const Eigen::Vector3d& direction)
      : kind_(kind),
        shot_(shot),
        ray_(*shot.a, *shot.b, rotation_of(shot), direction),
        a_(transformed(*shot.a, {-shot.a->box().center(), Eigen::Quaterniond::Identity()})),
        b_(transformed(*shot.b, {-shot.b->box().center(), Eigen::Quaterniond::Identity()})) {}

  /// A length: the target less the distance or, of volumes, the volume less the target over the area that may move. It
  /// changes by no more than s does.
  double passed(double s, double target) const {
    // In frames at the box centres, where nothing cancels.
    const Pose X{ray_.R, s * ray_.direction};
    if (kind_ == TargetKind::distance) return target - static_cast<double>(reference_distance(*a_, *b_, X));
    return (overlap_volume_by_columns(*a_, *b_, X) - target) / moving_area(shot_);
  }

  /// Where no target is met yet.
  double outside(double target) const {
    const double reach = 0.5 * (shot_.a->diagonal() + shot_.b->diagonal());
    return 1.01 * reach + (kind_ == TargetKind::distance ? target : 0.0);
  }

  /// The greatest passed() from outside to `s`: steps of conservative advancement, none shorter than a part of the way.
  double greatest_passed(double s, double target) const {
    constexpr double k_most_steps = 32.0;
    const double start = outside(target), least_step = (start - s) / k_most_steps;
    double greatest = -std::numeric_limits<double>::infinity();
    for (double at = start; at > s;) {
      const double passed_here = passed(at, target);
      greatest = std::max(greatest, passed_here);
      at -= std::max(-passed_here, least_step);
    }
    return greatest;
  }

  Pose pose(double s) const { return ray_.pose(s); }

  /// Of the shot with B at translation s.
  Bounds bounds(double s) const {
    Shot there = shot_;
    there.X_AB.t = pose(s).t;
    return bounds_of(there, {});
  }

 private:
  TargetKind kind_;
  const Shot& shot_;
  ConfigurationRay ray_;
  MeshPointer a_, b_;
};

void judge_target(const Measure& measure, double target, double s, double size, std::size_t index,
                  std::vector<Finding>& findings) {
  const bool met = !std::isnan(s);
  const double end = met ? s : 0.0;
  const Bounds bounds = measure.bounds(measure.outside(target));
  if (met) {
    const double off = measure.passed(s, target);
    findings.push_back(length_finding("target", std::abs(off), size, bounds, index,
                                      fmt::format("target {} is passed by {} at translation {}", target, off, s)));
  }
  const double earlier = measure.greatest_passed(end, target);
  findings.push_back(length_finding(met ? "earlier hit" : "missed hit", std::max(0.0, earlier), size, bounds, index,
                                    fmt::format("target {} is passed by {} farther out than {}", target, earlier, s)));
}

bool is_too_large(const Shot& shot) {
  constexpr std::size_t k_most_pairs = 40'000;
  return shot.a->triangles().size() * shot.b->triangles().size() > k_most_pairs;
}

/// Shots that have rays of their own. Those of a sequence differ from the first by their translations.
std::size_t ray_shots(const Case& member) {
  return member.relation == Relation::same || member.relation == Relation::none ? member.shots.size() : 1;
}

RayAlgorithm::MakeSolver solver_maker(TargetKind kind) {
  if (kind == TargetKind::distance) {
    return [](const Mesh& a, const Mesh& b) { return make_ray_cast()->prepare(a, b); };
  }
  return [touching = std::shared_ptr<DistanceGenerator>(make_ray_cast())](const Mesh& a, const Mesh& b) {
    return volume_solvers(*touching, a, b)();
  };
}

}  // namespace

RayAlgorithm::RayAlgorithm(TargetKind kind)
    : RayAlgorithm(kind, kind == TargetKind::distance ? "generate-distances" : "generate-volumes", solver_maker(kind)) {
}

RayAlgorithm::RayAlgorithm(TargetKind kind, std::string name, MakeSolver make_solver)
    : kind_(kind), make_solver_(std::move(make_solver)) {
  traits_.name = std::move(name);
  traits_.version = SIXDOF_VERSION;
  traits_.summary = "configurations on the rays of hard cases";
}

std::unique_ptr<Query> RayAlgorithm::prepare(const Mesh&, const Mesh&, const Settings&) const {
  throw BadArgument(traits_.name + " makes configuration sets and answers no query");
}

RayProblem RayAlgorithm::problem(const Shot& first, const Shot& shot) const {
  const Eigen::Vector3d offset = centre_offset(shot);
  const bool together = offset.norm() <= shot.rounding();
  const Eigen::Vector3d direction = together ? shot.turn * Eigen::Vector3d(0.48, 0.64, 0.6) : offset;
  RayProblem problem{.direction = direction.normalized(), .targets = {}};
  if (kind_ == TargetKind::distance) {
    constexpr double k_targets[] = {0.2, 0.01, k_contact_target};
    for (const double part : k_targets) problem.targets.push_back(part * first.a->diagonal() * shot.scale);
  } else {
    const double smaller = std::min(std::abs(first.a->volume()), std::abs(first.b->volume()));
    for (const double part : {0.01, 0.5}) problem.targets.push_back(part * smaller * std::pow(shot.scale, 3));
  }
  return problem;
}

Judgement RayAlgorithm::judge_rays(const Case& member, const std::function<void(const Pose&)>& asks) const {
  Judgement judgement;
  const Shot& first = member.shots.front();
  const double size = member.size();
  Translations of_first;
  const auto fails = [&](Verdict verdict, std::size_t index, const char* words) {
    judgement.findings.push_back({.verdict = verdict, .metric = "ray", .unit = "1", .shot = index, .words = words});
  };
  for (std::size_t i = 0; i < ray_shots(member); ++i) {
    const Shot& shot = member.shots[i];
    if (shot.raw) continue;
    const RayProblem ray = problem(first, shot);
    const Measure measure(kind_, shot, ray.direction);
    Translations found(ray.targets.size()), residuals = found, again = found;
    try {
      const std::unique_ptr<RaySolver> solver = make_solver_(*shot.a, *shot.b);
      solver->set_rotation(rotation_of(shot));
      asks(measure.pose(measure.outside(ray.targets.front())));
      const double begin = thread_seconds();
      solver->solve(ray.direction, ray.targets, found, residuals);
      const double seconds = thread_seconds() - begin;
      if (seconds > judgement.slowest_seconds) judgement.slowest_seconds = seconds, judgement.slowest_shot = i;
      const std::unique_ptr<RaySolver> second = make_solver_(*shot.a, *shot.b);
      second->set_rotation(rotation_of(shot));
      second->solve(ray.direction, ray.targets, again, residuals);
    } catch (const BadMesh& e) {
      fails(Verdict::unsupported, i, e.what());
      continue;
    } catch (const std::exception& e) {
      fails(Verdict::threw, i, e.what());
      continue;
    }
    if (i == 0) of_first = found;
    const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    const bool repeats = std::ranges::equal(found, again, same);
    judgement.findings.push_back({.verdict = repeats ? Verdict::exact : Verdict::wrong,
                                  .metric = "second object",
                                  .unit = "1",
                                  .shot = i,
                                  .words = "translations of two solvers"});
    if (is_too_large(shot)) continue;
    for (std::size_t k = 0; k < found.size(); ++k)
      judge_target(measure, ray.targets[k], found[k], size * shot.scale, i, judgement.findings);
    // On one ray the translations are the same, whatever the frames: box centres are those of the bodies where bodies
    // are symmetric about a point.
    const Eigen::Vector3d moved = shot.scale * (shot.turn * centre_offset(first));
    const bool same_ray = member.relation == Relation::same && i > 0 && of_first.size() == found.size() &&
                          (moved - centre_offset(shot)).norm() <= shot.rounding();
    for (std::size_t k = 0; same_ray && k < found.size(); ++k) {
      const double s = shot.scale * of_first[k];
      if (std::isnan(s) || std::isnan(found[k])) continue;  // judged as a missed hit
      const double off = std::abs(measure.passed(s, ray.targets[k]));
      const Bounds here = measure.bounds(s), there = bounds_of(first, {});
      const Bounds both{.rounding = here.rounding + shot.scale * there.rounding,
                        .resolution = 0.0,
                        .slack = here.slack + shot.scale * there.slack};
      judgement.findings.push_back(
          length_finding("same translation", off, size * shot.scale, both, i,
                         fmt::format("translation {} and, at the case's first pose, {}", found[k], of_first[k])));
    }
  }
  if (judgement.findings.empty()) fails(Verdict::unsupported, 0, "no ray");
  return judgement;
}

}  // namespace sixdof::stability
