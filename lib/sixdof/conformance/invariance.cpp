#include <sixdof/conformance/checks.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <sixdof/conformance/poses.h>

namespace sixdof::conformance {
namespace {

constexpr double k_small = 1e-3, k_large = 1e3;  ///< Metres for a model in millimetres, and the other way round.

void expect_same_wrench(const Response& first, const Response& second, double length, double allowed, const At& at,
                        const At& there, Findings& findings) {
  if (wrench_difference(first, second, length) <= allowed) return;
  findings.fail(fmt::format("the wrench differs: force {} and {}, torque {} and {}", text_of(first.force),
                            text_of(second.force), text_of(first.torque), text_of(second.torque)),
                at, there);
}

/// Asks one kind at all cases of all pairs, and the same kind of the pair that `change` makes.
/// @param change changed(pair) with members a, b and pose(X_AB)
/// @param compare compare(first answers, second answers, case, changed pair, place of the first, place of the second)
template <Kind kind, class Change, class Compare>
void compare_all(const Subject& subject, Findings& findings, const Change& change, const Compare& compare) {
  for (const Pair& pair : pairs(subject.traits().body)) {
    const auto changed = change(pair);
    const auto query = subject.prepare(pair.a, pair.b), other = subject.prepare(changed.a, changed.b);
    for (const Case& each : pair.cases) {
      const TypedPose there = TypedPose::of(changed.pose(each.pose.X_AB));
      const Answers first = subject.ask(*query, kind, each.pose.X_AB), second = subject.ask(*other, kind, there.X_AB);
      const At at{subject, pair.a, pair.b, each.pose}, at_there{subject, changed.a, changed.b, there};
      const bool is_first = findings.expect_ok(first, kind, at), is_second = findings.expect_ok(second, kind, at_there);
      if (is_first && is_second) compare(first, second, each, changed, at, at_there);
    }
  }
}

struct Swapped {
  explicit Swapped(const Pair& pair) : a(pair.b), b(pair.a) {}
  Pose pose(const Pose& X_AB) const { return X_AB.inverse(); }
  const Mesh &a, &b;
};
const auto swapped = [](const Pair& pair) { return Swapped(pair); };

struct Moved {
  explicit Moved(const Pair& pair) : a(moved(pair.a, X_a)), b(moved(pair.b, X_b)) {}
  Pose pose(const Pose& X_AB) const { return X_a * X_AB * X_b.inverse(); }
  Pose X_a = generic_motion(5), X_b = generic_motion(6);
  Mesh a, b;
};
const auto moved_both = [](const Pair& pair) { return Moved(pair); };

struct Scaled {
  Scaled(const Pair& pair, double by) : factor(by), a(scaled(pair.a, by)), b(scaled(pair.b, by)) {}
  Pose pose(const Pose& X_AB) const { return {X_AB.R, factor * X_AB.t}; }
  double factor;
  Mesh a, b;
};

template <class Change>
void expect_same_collide(const Subject& subject, Findings& findings, const Change& change) {
  compare_all<Kind::collide>(
      subject, findings, change,
      [&](const Answers& first, const Answers& second, const Case&, const auto&, const At& at, const At& there) {
        if (first.collide.value == second.collide.value) return;
        findings.fail(
            fmt::format("{}, and {} after the change", yes_or_no(first.collide.value), yes_or_no(second.collide.value)),
            at, there);
      });
}

/// Two distances differ by the declared error each.
/// @param factor of lengths, by the change
template <class Change>
void expect_same_distances(const Subject& subject, Findings& findings, const Change& change, double factor = 1.0) {
  compare_all<Kind::distance>(
      subject, findings, change,
      [&](const Answers& first, const Answers& second, const Case&, const auto&, const At& at, const At& there) {
        const double diagonal = std::max(factor * at.a.diagonal(), there.a.diagonal());
        findings.expect_near("the distance after the change", second.distance.value.distance,
                             factor * first.distance.value.distance, 2.0 * subject.declared.distance_error * diagonal,
                             at, there);
      });
}

void check_order_of_collide(const Subject& subject, Findings& findings) {
  expect_same_collide(subject, findings, swapped);
}
void check_order_of_distance(const Subject& subject, Findings& findings) {
  expect_same_distances(subject, findings, swapped);
}
void check_order_of_respond(const Subject& subject, Findings& findings) {
  if (subject.declared.order_error == k_no_claim) return findings.has_no_claim("order_error");
  compare_all<Kind::respond>(subject, findings, swapped,
                             [&](const Answers& first, const Answers& second, const Case& each, const Swapped&,
                                 const At& at, const At& there) {
                               // The wrench on A in B's frame becomes the opposite one on B in A's frame.
                               const Pose& X_AB = each.pose.X_AB;
                               Response back = second.respond.value;
                               back.force = -(X_AB.R * back.force);
                               back.torque = -(X_AB.R * back.torque);
                               back.reference = X_AB * back.reference;
                               const Response& forth = first.respond.value;
                               expect_same_wrench(forth, back.about(forth.reference), at.a.diagonal(),
                                                  subject.declared.order_error, at, there, findings);
                             });
}

void check_motion_of_collide(const Subject& subject, Findings& findings) {
  expect_same_collide(subject, findings, moved_both);
}
void check_motion_of_distance(const Subject& subject, Findings& findings) {
  expect_same_distances(subject, findings, moved_both);
}
void check_motion_of_respond(const Subject& subject, Findings& findings) {
  if (subject.declared.motion_error == k_no_claim) return findings.has_no_claim("motion_error");
  compare_all<Kind::respond>(
      subject, findings, moved_both,
      [&](const Answers& first, const Answers& second, const Case&, const Moved& both, const At& at, const At& there) {
        Response expected = first.respond.value;
        expected.force = both.X_a.R * expected.force;
        expected.torque = both.X_a.R * expected.torque;
        expected.reference = both.X_a * expected.reference;
        expect_same_wrench(expected, second.respond.value.about(expected.reference), at.a.diagonal(),
                           subject.declared.motion_error, at, there, findings);
      });
}

void check_scale_of_collide(const Subject& subject, Findings& findings) {
  for (const double factor : {k_small, k_large}) {
    expect_same_collide(subject, findings, [factor](const Pair& pair) { return Scaled(pair, factor); });
  }
}

void check_scale_of_distance(const Subject& subject, Findings& findings) {
  for (const double factor : {k_small, k_large}) {
    expect_same_distances(
        subject, findings, [factor](const Pair& pair) { return Scaled(pair, factor); }, factor);
  }
}

/// Volumes grow with the third power, penalties with the first (depth) or third (volume), forces with one whole power
/// at all poses, torques with one more.
void check_scale_of_respond(const Subject& subject, Findings& findings) {
  const double allowed = subject.declared.scale_error;
  if (allowed == k_no_claim) return findings.has_no_claim("scale_error");
  const double penalty_power = subject.traits().law == ResponseLaw::volume ? 3.0 : 1.0;
  std::optional<double> power;
  for (const double factor : {k_small, k_large}) {
    compare_all<Kind::respond>(
        subject, findings, [factor](const Pair& pair) { return Scaled(pair, factor); },
        [&](const Answers& first, const Answers& second, const Case& each, const Scaled&, const At& at,
            const At& there) {
          Response expected = first.respond.value;
          const Response& got = second.respond.value;
          const double before = expected.force.norm(), after = got.force.norm();
          if ((before > 0.0) != (after > 0.0)) {
            findings.fail(fmt::format("a force of {:.3g}, and of {:.3g} after the change", before, after), at, there);
          }
          if (!(before > 0.0 && after > 0.0) || each.place != Place::overlapping) return;
          if (!power) power = std::round(std::log(after / before) / std::log(factor));
          expected.force *= std::pow(factor, *power);
          expected.torque *= std::pow(factor, *power + 1.0);
          expected.reference *= factor;
          expect_same_wrench(expected, got.about(expected.reference), factor * at.a.diagonal(), allowed, at, there,
                             findings);
          const double penalty = expected.penalty * std::pow(factor, penalty_power);
          findings.expect_near("the penalty after the change", got.penalty, penalty, allowed * penalty, at, there);
          if (std::isnan(expected.volume) || subject.declared.volume_error == k_no_claim) return;
          const double volume = expected.volume * std::pow(factor, 3.0);
          findings.expect_near("the volume after the change", got.volume, volume, allowed * volume, at, there);
        });
  }
}

constexpr Check k_checks[] = {
    {"OrderOfCollide", Needs::collide, check_order_of_collide},
    {"OrderOfDistance", Needs::distance, check_order_of_distance},
    {"OrderOfRespond", Needs::respond, check_order_of_respond},
    {"MotionOfCollide", Needs::collide, check_motion_of_collide},
    {"MotionOfDistance", Needs::distance, check_motion_of_distance},
    {"MotionOfRespond", Needs::respond, check_motion_of_respond},
    {"ScaleOfCollide", Needs::collide, check_scale_of_collide},
    {"ScaleOfDistance", Needs::distance, check_scale_of_distance},
    {"ScaleOfRespond", Needs::respond, check_scale_of_respond},
};

}  // namespace

std::span<const Check> invariance_checks() { return k_checks; }

}  // namespace sixdof::conformance
