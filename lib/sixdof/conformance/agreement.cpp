#include <sixdof/conformance/subject.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/conformance/poses.h>
#include <sixdof/geometry/closest_point.h>
#include <sixdof/geometry/tree.h>

namespace sixdof::conformance {
namespace {

/// check(the pair, one of its cases, the answers) for all cases of all pairs, each pair prepared once.
template <class CheckCase>
void for_each_case(const Subject& subject, Kind kind, const CheckCase& check) {
  for (const Pair& pair : pairs()) {
    const auto query = subject.prepare(pair.a, pair.b);
    for (const Case& each : pair.cases) {
      const At at{subject, pair.a, pair.b, each.pose};
      const Answers answers = subject.ask(*query, kind, each.pose.X_AB);
      EXPECT_EQ(to_string(answers.status(kind)), to_string(Status::ok)) << answers.words << at;
      if (answers.status(kind) == Status::ok) check(each, answers, at);
    }
  }
}

void check_collide(const Subject& subject) {
  for_each_case(subject, Kind::collide, [](const Case& each, const Answers& answers, const At& at) {
    if (each.place == Place::contained) return;
    EXPECT_EQ(answers.collide.value, each.place == Place::overlapping)
        << "the surfaces are " << each.distance << " apart, the overlap is " << each.volume << at;
  });
}

void check_contained_collide(const Subject& subject) {
  for_each_case(subject, Kind::collide, [&](const Case& each, const Answers& answers, const At& at) {
    if (each.place != Place::contained) return;
    EXPECT_EQ(answers.collide.value, subject.declared.collide == Meaning::bodies)
        << "one body is inside the other" << at;
  });
}

void check_distance(const Subject& subject) {
  for_each_case(subject, Kind::distance, [&](const Case& each, const Answers& answers, const At& at) {
    EXPECT_NEAR(answers.distance.value.distance, each.distance, subject.declared.distance_error * at.a.diagonal())
        << at;
    EXPECT_GE(answers.distance.value.distance, 0.0) << at;
  });
}

void check_witnesses(const Subject& subject) {
  if (subject.declared.witness_error == k_no_claim) return;
  for (const Pair& pair : pairs()) {
    const Tree tree_a(pair.a), tree_b(pair.b);
    const auto query = subject.prepare(pair.a, pair.b);
    const double allowed = subject.declared.witness_error * pair.a.diagonal();
    for (const Case& each : pair.cases) {
      const At at{subject, pair.a, pair.b, each.pose};
      const Answers answers = subject.ask(*query, Kind::distance, each.pose.X_AB);
      const Separation& gap = answers.distance.value;
      EXPECT_TRUE(answers.distance.ok()) << answers.words << at;
      if (!answers.distance.ok() || !gap.has_witnesses) continue;
      EXPECT_NEAR((gap.witness_a - gap.witness_b).norm(), gap.distance, allowed)
          << "the witnesses are not `distance` apart" << at;
      EXPECT_LE(closest_point(tree_a, gap.witness_a)->distance, allowed) << "witness_a is not on A" << at;
      EXPECT_LE(closest_point(tree_b, each.pose.X_AB.inverse() * gap.witness_b)->distance, allowed)
          << "witness_b is not on B, or not in A's frame" << at;
    }
  }
}

void check_respond(const Subject& subject) {
  double degrees = 0.0, largest = 0.0;
  int judged = 0;
  for_each_case(subject, Kind::respond, [&](const Case& each, const Answers& answers, const At& at) {
    if (each.place == Place::contained) return;
    const Response& response = answers.respond.value;
    const bool overlap = each.place == Place::overlapping;
    EXPECT_EQ(response.penalty > 0.0, overlap) << "penalty " << response.penalty << at;
    EXPECT_EQ(response.force.norm() > 0.0, overlap) << "a miss, or a force on bodies that are apart" << at;
    if (!overlap) return;
    const double angle = angle_between(response.force, each.force);
    degrees += angle;
    largest = std::max(largest, angle);
    ++judged;
  });
  EXPECT_LE(degrees / std::max(judged, 1), subject.declared.force_degrees)
      << "mean angle of " << subject.traits().name << "'s forces to the exact ones; the largest is " << largest;
}

void check_volume(const Subject& subject) {
  for_each_case(subject, Kind::respond, [&](const Case& each, const Answers& answers, const At& at) {
    const double volume = answers.respond.value.volume;
    if (std::isnan(volume) || subject.declared.volume_error == k_no_claim) return;
    if (each.place == Place::apart) {
      EXPECT_EQ(volume, 0.0) << at;
    } else {
      EXPECT_NEAR(volume, each.volume, subject.declared.volume_error * each.volume) << at;
    }
  });
}

/// A surface with a border is refused by BadMesh, or yes/no and distance are those of the surface. A response must not
/// be made up: it needs a closed surface, or contacts of triangles.
void check_open_surfaces(const Subject& subject) {
  const Pair pair = open_pair();
  if (!subject.declared.open_meshes) {
    EXPECT_THROW(subject.prepare(pair.a, pair.b), BadMesh);
    EXPECT_THROW(subject.prepare(pair.b, pair.a), BadMesh);
    return;
  }
  const auto query = subject.prepare(pair.a, pair.b);
  for (const Case& each : pair.cases) {
    const At at{subject, pair.a, pair.b, each.pose};
    const Answers answers = subject.ask(*query, each.pose.X_AB);
    if (subject.answers(Kind::collide)) {
      EXPECT_TRUE(answers.collide.ok()) << answers.words << at;
      EXPECT_EQ(answers.collide.value, each.place == Place::overlapping) << at;
    }
    if (subject.answers(Kind::distance)) {
      EXPECT_TRUE(answers.distance.ok()) << answers.words << at;
      EXPECT_NEAR(answers.distance.value.distance, each.distance, subject.declared.distance_error * pair.a.diagonal())
          << at;
    }
    if (subject.answers(Kind::respond) && answers.respond.ok() && each.place == Place::apart) {
      EXPECT_EQ(answers.respond.value.force.norm(), 0.0) << at;
    }
  }
}

constexpr Check k_checks[] = {
    {"Collide", if_collide, check_collide},        {"CollideOfContained", if_collide, check_contained_collide},
    {"Distance", if_distance, check_distance},     {"Witnesses", if_distance, check_witnesses},
    {"Respond", if_respond, check_respond},        {"Volume", if_respond, check_volume},
    {"OpenSurfaces", always, check_open_surfaces},
};

}  // namespace

std::span<const Check> agreement_checks() { return k_checks; }

}  // namespace sixdof::conformance
