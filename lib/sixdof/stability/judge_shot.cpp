#include <sixdof/stability/judge_shot.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <sixdof/stability/reference.h>

namespace sixdof::stability {
namespace {

bool pushes(const Response& response) { return response.penalty != 0.0 || !response.force.isZero(0.0); }

/// Radius of a ball that fits into a body, 0 if it is no solid: a surface that lies deeper than that inside its body
/// may be no surface at all. Both are lower bounds for convex bodies, and the distance of the box's centre from the
/// planes of the faces is the radius where a body is symmetric about it.
double inner_radius(const Mesh& mesh) {
  if (!mesh.solid()) return 0.0;
  const auto& points = mesh.vertices();
  const Eigen::Vector3d center = mesh.box().center();
  double within = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : mesh.triangles()) {
    const Eigen::Vector3d normal = (points[j] - points[i]).cross(points[k] - points[i]);
    if (!normal.isZero(0.0)) within = std::min(within, normal.normalized().dot(points[i] - center));
  }
  return std::max(within, mesh.volume() / mesh.area());
}

double least_radius(const Shot& shot) { return std::min(inner_radius(*shot.a), inner_radius(*shot.b)); }

/// How far surfaces have to move until a miss is right: to where they no longer meet or, for an algorithm that declares
/// a resolution, until one body has vanished.
double distance_to_miss(const Shot& shot, const Answers& answers) {
  const double gap = std::abs(shot.truth.gap);
  return answers.resolution > 0.0 && shot.truth.gap < 0.0 ? std::min(gap, least_radius(shot)) : gap;
}

/// The same for a response: where only points of B's surface count, until none of them is in A.
double distance_to_no_push(const Shot& shot, const Answers& answers, const Traits& traits) {
  const double distance = distance_to_miss(shot, answers), depth_of_b = shot.truth.depth_of_b;
  // Without such points the miss is that of a body inside the other: MethodLimits::surfaces_only.
  return traits.limits.only_points_of_b && depth_of_b > 0.0 ? std::min(distance, depth_of_b) : distance;
}

/// Yes/no, once right and wrong are known: how far from contact the mistake is.
Finding sign_finding(const char* metric, bool right, const Shot& asked, double distance, const Bounds& bounds,
                     std::size_t shot) {
  const double size = asked.a->diagonal(), gap = asked.truth.gap;
  if (right) return {.verdict = Verdict::exact, .metric = metric, .unit = "size", .shot = shot, .words = {}};
  return length_finding(metric, distance, size, bounds, shot,
                        fmt::format("true gap {}, where the answer has the wrong sign", gap));
}

void judge_response(const Case& member, std::size_t index, const Response& response, const Answers& answers,
                    const Traits& traits, std::vector<Finding>& findings) {
  const Shot& shot = member.shots[index];
  const GroundTruth& truth = shot.truth;
  const Bounds bounds = bounds_of(shot, answers);
  const bool excused = truth.contained && traits.limits.surfaces_only.respond;
  if (!std::isnan(truth.gap)) {
    // At a gap of 0 any answer is right.
    const bool right = truth.gap == 0.0 || pushes(response) == (truth.gap < 0.0);
    findings.push_back(excused && !right ? declared_finding("missed", "size", index, "surfaces only")
                                         : sign_finding(truth.gap < 0.0 ? "missed" : "phantom", right, shot,
                                                        distance_to_no_push(shot, answers, traits), bounds, index));
  }
  if (!std::isnan(truth.volume) && std::isfinite(response.volume)) {
    findings.push_back(volume_finding("volume", std::abs(response.volume - truth.volume), shot, bounds, index,
                                      fmt::format("volume {} instead of {}", response.volume, truth.volume)));
  }
  const double depth = -truth.gap;
  // Of a body, as a part of its inner radius, up to which MethodLimits::own_direction promises a direction.
  constexpr double k_shallow = 0.25;
  const bool own_direction = traits.limits.own_direction;
  const bool claimed = !own_direction || depth < k_shallow * least_radius(shot);
  if (truth.push && claimed && depth > bounds.least_depth() && !response.force.isZero(0.0)) {
    findings.push_back(angle_finding("direction", response.force, *truth.push, rounding_angle(bounds, depth),
                                     own_direction, index, "angle of the force to the shortest way out"));
  }
}

/// Lowest point of a mesh along a direction.
double support(const Mesh& mesh, const Pose& X, const Eigen::Vector3d& direction) {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : mesh.vertices()) least = std::min(least, direction.dot(X * p));
  return least;
}

void judge_witnesses(const Case& member, std::size_t index, const Separation& gap, const Bounds& bounds,
                     std::vector<Finding>& findings) {
  const Shot& shot = member.shots[index];
  if (!gap.has_witnesses) return;
  const double size = shot.a->diagonal();
  const Eigen::Vector3d between = gap.witness_b - gap.witness_a;
  findings.push_back(length_finding("witnesses", std::abs(between.norm() - gap.distance), size, bounds, index,
                                    fmt::format("points {} apart at distance {}", between.norm(), gap.distance)));
  if (!member.convex || shot.truth.gap <= 0.0 || !(gap.distance > bounds.least_depth())) return;
  // Along the normal the supporting planes of convex bodies are as far apart as the bodies. Where the distance d is
  // right to e, witnesses on nearly parallel parts may be off sideways by sqrt(2 d e). That turns the normal by
  // sqrt(2 e / d), which moves a support by that times the body's size.
  const Eigen::Vector3d n = between.normalized();
  const double width = support(*shot.b, shot.X_AB.pose(), n) + support(*shot.a, {}, -n);
  Bounds turned = bounds;
  const auto moved = [&](double error) { return (size + shot.b->diagonal()) * std::sqrt(2.0 * error / gap.distance); };
  turned.rounding += moved(bounds.rounding);
  turned.resolution += moved(bounds.resolution);
  findings.push_back(
      length_finding("support", std::abs(width - gap.distance), size, turned, index,
                     fmt::format("planes across the closest points are {} apart, distance {}", width, gap.distance)));
}

void judge_contradictions(std::size_t index, const Shot& shot, const Answers& answers, const Traits& traits,
                          const Bounds& bounds, std::vector<Finding>& findings) {
  if (!answers.collide.outcome.ok() || !answers.distance.outcome.ok()) return;
  const double distance = answers.distance.outcome.value.distance;
  const bool yes = answers.collide.outcome.value;
  const double size = shot.a->diagonal();
  // Inside each other bodies collide though the surfaces are apart.
  const bool unknown = std::isnan(shot.truth.gap);
  const bool may_be_inside = shot.truth.contained || (unknown && !traits.limits.surfaces_only.collide);
  // A distance of bodies is 0 there, where surfaces may not collide.
  const bool may_touch = shot.truth.contained && traits.limits.distance_of_bodies;
  const bool contradict = yes ? distance > 0.0 && !may_be_inside : distance == 0.0 && !may_touch;
  if (!contradict) return;
  const double gap =
      unknown ? static_cast<double>(reference_distance(*shot.a, *shot.b, shot.X_AB.pose())) : std::abs(shot.truth.gap);
  const double by = yes ? distance : gap;
  findings.push_back(length_finding("contradiction", by, size, bounds, index,
                                    fmt::format("collide says {}, distance is {}", yes ? "yes" : "no", distance)));
}

}  // namespace

Bounds bounds_of(const Shot& shot, const Answers& answers) {
  return {.rounding = shot.truth.error + shot.rounding(),
          .resolution = answers.resolution,
          .slack = k_declared_accuracy * shot.a->diagonal()};
}

double rounding_angle(const Bounds& bounds, double depth) {
  constexpr double k_cap = 100.0, k_exact_angle = 1e-9;
  return k_exact_angle + k_cap * bounds.rounding / depth;
}

double moving_area(const Shot& shot) { return shot.a->area() + shot.b->area(); }

Finding length_finding(const char* metric, double error, double size, const Bounds& bounds, std::size_t shot,
                       std::string words) {
  return {.verdict = bounds.verdict(error),
          .metric = metric,
          .value = error / size,
          .unit = "size",
          .excess = error / bounds.rounding,
          .shot = shot,
          .words = std::move(words)};
}

Finding volume_finding(const char* metric, double error, const Shot& measured, const Bounds& bounds, std::size_t shot,
                       std::string words) {
  const double size = measured.a->diagonal();
  Finding finding = length_finding(metric, error / moving_area(measured), size, bounds, shot, std::move(words));
  finding.value = error / (size * size * size);
  finding.unit = "volume";
  return finding;
}

Finding angle_finding(const char* metric, const Eigen::Vector3d& u, const Eigen::Vector3d& v, double allowed,
                      bool excused, std::size_t shot, std::string words) {
  const double angle = std::atan2(u.cross(v).norm(), u.dot(v));
  const bool within_resolution = excused && angle < 0.5 * std::numbers::pi;
  return {.verdict = angle <= allowed    ? Verdict::exact
                     : within_resolution ? Verdict::resolution
                                         : Verdict::wrong,
          .metric = metric,
          .value = angle,
          .unit = "rad",
          .excess = angle / allowed,
          .shot = shot,
          .words = std::move(words)};
}

Finding declared_finding(const char* metric, const char* unit, std::size_t shot, std::string words) {
  return {.verdict = Verdict::unsupported, .metric = metric, .unit = unit, .shot = shot, .words = std::move(words)};
}

Verdict verdict_of(Status status) {
  switch (status) {
    case Status::non_finite:
      return Verdict::non_finite;
    case Status::crashed:
      return Verdict::crashed;
    case Status::timed_out:
      return Verdict::hung;
    case Status::out_of_memory:
      return Verdict::out_of_memory;
    case Status::unsupported:
      return Verdict::unsupported;
    default:
      return Verdict::threw;
  }
}

void judge_statuses(const Shot& shot, std::size_t index, const Answers& answers, const Limits& limits,
                    std::vector<Finding>& findings) {
  const bool solid = shot.a->solid() && shot.b->solid();
  if (answers.refused || answers.prepare_threw) {
    const bool declared = answers.refused;
    findings.push_back({.verdict = declared ? Verdict::unsupported : Verdict::threw,
                        .metric = "prepare",
                        .unit = "1",
                        .shot = index,
                        .words = answers.words});
    return;
  }
  for_each_query(answers, [&](const char* query, Status status, const std::string& words) {
    if (status == Status::ok || status == Status::unsupported) return;
    Verdict verdict = verdict_of(status);
    if (words == "std::bad_alloc") verdict = Verdict::out_of_memory;
    // There is no penalty without an inside.
    const bool no_inside = !solid && query == std::string_view("respond");
    if (verdict == Verdict::threw && no_inside) verdict = Verdict::unsupported;
    findings.push_back({.verdict = verdict, .metric = query, .unit = "1", .shot = index, .words = words});
  });
  if (answers.wall_seconds > limits.seconds) {
    findings.push_back({.verdict = Verdict::hung,
                        .metric = "time",
                        .value = answers.wall_seconds,
                        .unit = "s",
                        .shot = index,
                        .words = "time limit"});
  }
}

void judge_truth(const Case& member, std::size_t index, const Answers& answers, const Traits& traits,
                 std::vector<Finding>& findings) {
  const Shot& shot = member.shots[index];
  const GroundTruth& truth = shot.truth;
  const Bounds bounds = bounds_of(shot, answers);
  const double size = shot.a->diagonal();
  if (answers.collide.outcome.ok() && !std::isnan(truth.gap)) {
    const bool right = answers.collide.outcome.value == (truth.gap <= 0.0);
    const bool excused = truth.contained && traits.limits.surfaces_only.collide;
    findings.push_back(excused && !right ? declared_finding("missed", "size", index, "surfaces only")
                                         : sign_finding(truth.gap <= 0.0 ? "missed" : "phantom", right, shot,
                                                        distance_to_miss(shot, answers), bounds, index));
  }
  if (answers.distance.outcome.ok()) {
    const Separation& gap = answers.distance.outcome.value;
    if (truth.contained && traits.limits.distance_of_bodies && gap.distance == 0.0) {
      findings.push_back(declared_finding("distance", "size", index, "distance of the bodies"));
    } else if (!std::isnan(truth.distance)) {
      findings.push_back(length_finding("distance", std::abs(gap.distance - truth.distance), size, bounds, index,
                                        fmt::format("distance {} instead of {}", gap.distance, truth.distance)));
    }
    judge_witnesses(member, index, gap, bounds, findings);
  }
  if (answers.respond.outcome.ok())
    judge_response(member, index, answers.respond.outcome.value, answers, traits, findings);
  judge_contradictions(index, shot, answers, traits, bounds, findings);
}

}  // namespace sixdof::stability
