#include <sixdof/conformance/checks.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/conformance/poses.h>
#include <sixdof/geometry/closest_point.h>
#include <sixdof/geometry/tree.h>

namespace sixdof::conformance {
namespace {

/// check(one of the cases, the answers, where) for all cases of all pairs, each pair prepared once.
template <class CheckCase>
void for_each_case(const Subject& subject, Kind kind, Findings& findings, const CheckCase& check) {
  for (const Pair& pair : pairs(subject.traits().body)) {
    const auto query = subject.prepare(pair.a, pair.b);
    for (const Case& each : pair.cases) {
      const At at{subject, pair.a, pair.b, each.pose};
      const Answers answers = subject.ask(*query, kind, each.pose.X_AB);
      if (findings.expect_ok(answers, kind, at)) check(each, answers, at);
    }
  }
}

/// "yes instead of no: ..."
std::string wrong_answer(bool answer, const std::string& why) {
  return fmt::format("{} instead of {}: {}", yes_or_no(answer), yes_or_no(!answer), why);
}

void check_collide(const Subject& subject, Findings& findings) {
  for_each_case(subject, Kind::collide, findings, [&](const Case& each, const Answers& answers, const At& at) {
    if (each.place == Place::contained) return;
    const bool answer = answers.collide.value;
    if (answer == (each.place == Place::overlapping)) return;
    const std::string why =
        fmt::format("the surfaces are {:.6g} apart, the overlap is {:.6g}", each.distance, each.volume);
    findings.fail(wrong_answer(answer, why), at);
  });
}

void check_contained_collide(const Subject& subject, Findings& findings) {
  for_each_case(subject, Kind::collide, findings, [&](const Case& each, const Answers& answers, const At& at) {
    if (each.place != Place::contained) return;
    const bool answer = answers.collide.value;
    const bool wanted = subject.declared.collide == Meaning::bodies;
    if (answer == wanted) return;
    findings.fail(wrong_answer(answer, fmt::format("one body is inside the other, and yes/no is claimed for {}",
                                                   wanted ? "bodies" : "surfaces")),
                  at);
  });
}

void check_distance(const Subject& subject, Findings& findings) {
  for_each_case(subject, Kind::distance, findings, [&](const Case& each, const Answers& answers, const At& at) {
    const double distance = answers.distance.value.distance;
    const bool touching = each.place == Place::contained && subject.traits().limits.distance_of_bodies;
    findings.expect_near("the distance", distance, touching ? 0.0 : each.distance,
                         subject.declared.distance_error * at.a.diagonal(), at);
    if (distance < 0.0) findings.fail(fmt::format("the distance is negative: {}", distance), at);
  });
}

void check_witnesses(const Subject& subject, Findings& findings) {
  if (subject.declared.witness_error == k_no_claim) return findings.has_no_claim("witness_error");
  bool judged = false;
  for (const Pair& pair : pairs(subject.traits().body)) {
    const Tree tree_a(pair.a), tree_b(pair.b);
    const auto query = subject.prepare(pair.a, pair.b);
    const double allowed = subject.declared.witness_error * pair.a.diagonal();
    for (const Case& each : pair.cases) {
      const At at{subject, pair.a, pair.b, each.pose};
      const Answers answers = subject.ask(*query, Kind::distance, each.pose.X_AB);
      const Separation& gap = answers.distance.value;
      if (!findings.expect_ok(answers, Kind::distance, at) || !gap.has_witnesses) continue;
      judged = true;
      findings.expect_near("the distance of the witnesses", (gap.witness_a - gap.witness_b).norm(), gap.distance,
                           allowed, at);
      const auto expect_on = [&](const char* what, const Tree& tree, const Eigen::Vector3d& witness) {
        const auto closest = closest_point(tree, witness);
        if (closest && closest->distance <= allowed) return;
        const std::string away = closest ? fmt::format("{:.3g} away", closest->distance) : "not finite";
        findings.fail(fmt::format("{}: it is {}", what, away), at);
      };
      expect_on("witness_a is not on A", tree_a, gap.witness_a);
      expect_on("witness_b is not on B, or not in A's frame", tree_b, each.pose.X_AB.inverse() * gap.witness_b);
    }
  }
  if (!judged) findings.has_no_answers("its distances have no witnesses");
}

void check_respond(const Subject& subject, Findings& findings) {
  double degrees = 0.0, largest = -1.0;
  int judged = 0;
  std::optional<At> worst;
  for_each_case(subject, Kind::respond, findings, [&](const Case& each, const Answers& answers, const At& at) {
    if (each.place == Place::contained) return;
    const Response& response = answers.respond.value;
    const bool overlap = each.place == Place::overlapping;
    if ((response.penalty > 0.0) != overlap) {
      const char* const bodies = overlap ? "bodies that overlap" : "bodies that are apart";
      findings.fail(fmt::format("penalty {:.6g} of {}", response.penalty, bodies), at);
    }
    if ((response.force.norm() > 0.0) != overlap) {
      findings.fail(overlap ? "no force on bodies that overlap" : "a force on bodies that are apart", at);
    }
    if (!overlap) return;
    const double angle = angle_between(response.force, each.force);
    degrees += angle;
    ++judged;
    if (angle <= largest) return;
    largest = angle;
    worst.emplace(at);
  });
  const double mean = degrees / std::max(judged, 1);
  if (mean <= subject.declared.force_degrees) return;
  const std::string what = fmt::format(
      "the forces are {:.3g} degrees off the exact ones on average, {:.3g} at most; an average of {:.3g} is claimed",
      mean, largest, subject.declared.force_degrees);
  worst ? findings.fail(what, *worst) : findings.fail(what);
}

void check_volume(const Subject& subject, Findings& findings) {
  if (subject.declared.volume_error == k_no_claim) return findings.has_no_claim("volume_error");
  bool judged = false;
  for_each_case(subject, Kind::respond, findings, [&](const Case& each, const Answers& answers, const At& at) {
    const double volume = answers.respond.value.volume;
    if (std::isnan(volume)) return;
    judged = true;
    const double allowed = each.place == Place::apart ? 0.0 : subject.declared.volume_error * each.volume;
    findings.expect_near("the volume", volume, each.place == Place::apart ? 0.0 : each.volume, allowed, at);
  });
  if (!judged) findings.has_no_answers("its responses have no volume");
}

void expect_refusal(const Subject& subject, const Mesh& a, const Mesh& b, Findings& findings) {
  try {
    static_cast<void>(subject.prepare(a, b));
    findings.fail(
        fmt::format("takes {} (A) and {} (B), one with a border; it should be refused by BadMesh", a.name(), b.name()));
  } catch (const BadMesh&) {
  }
}

/// A surface with a border is refused by BadMesh, or yes/no and distance are those of the surface. A response must not
/// be made up: it needs a closed surface, or contacts of triangles.
void check_open_surfaces(const Subject& subject, Findings& findings) {
  if (subject.traits().body == Body::convex_hull) return findings.has_no_answers("a hull is closed, whatever its mesh");
  const Pair pair = open_pair();
  if (!subject.declared.open_meshes) {
    expect_refusal(subject, pair.a, pair.b, findings);
    expect_refusal(subject, pair.b, pair.a, findings);
    return;
  }
  const auto query = subject.prepare(pair.a, pair.b);
  for (const Case& each : pair.cases) {
    const At at{subject, pair.a, pair.b, each.pose};
    const Answers answers = subject.ask(*query, each.pose.X_AB);
    const bool answer = answers.collide.value, meet = each.place == Place::overlapping;
    if (subject.answers(Kind::collide) && findings.expect_ok(answers, Kind::collide, at) && answer != meet) {
      findings.fail(wrong_answer(answer, fmt::format("the surfaces are {:.6g} apart", each.distance)), at);
    }
    if (subject.answers(Kind::distance) && findings.expect_ok(answers, Kind::distance, at)) {
      findings.expect_near("the distance", answers.distance.value.distance, each.distance,
                           subject.declared.distance_error * pair.a.diagonal(), at);
    }
    const bool is_pushed = answers.respond.ok() && answers.respond.value.force.norm() != 0.0;
    if (each.place == Place::apart && is_pushed) findings.fail("a force on surfaces that are apart", at);
  }
}

constexpr Check k_checks[] = {
    {"Collide", Needs::collide, check_collide},
    {"CollideOfContained", Needs::collide, check_contained_collide},
    {"Distance", Needs::distance, check_distance},
    {"Witnesses", Needs::distance, check_witnesses},
    {"Respond", Needs::respond, check_respond},
    {"Volume", Needs::respond, check_volume},
    {"OpenSurfaces", Needs::nothing, check_open_surfaces},
};

}  // namespace

std::span<const Check> agreement_checks() { return k_checks; }

}  // namespace sixdof::conformance
