#include <sixdof/conformance/checks.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/conformance/poses.h>
#include <sixdof/oracle/impact_verdict.h>
#include <sixdof/query/ask.h>

namespace sixdof::conformance {
namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

/// The answer of a cast. What is thrown counts as failed; `words` has why.
Outcome<Impact> cast(Query& query, const Motion& motion, std::string& words) {
  const auto keep = [&](const std::string& why) { words = why; };
  Outcome<Impact> answer = ask_guarded([&] { return query.cast(motion); }, keep);
  examine(query, answer, [&](const std::string& why) {
    if (words.empty()) words = why;
  });
  return answer;
}

/// From a pose apart: towards A, past it, turning on the spot, tumbling towards A.
std::vector<Motion> motions_from(const Pair& pair, const Case& apart) {
  const Pose& start = apart.pose.X_AB;
  const Eigen::Vector3d inwards = pair.a.center() - start * pair.b.center();
  const Eigen::Vector3d side = inwards.cross(Eigen::Vector3d(0.36, -0.48, 0.8));
  const Eigen::Vector3d spin(0.9, 1.2, -2.0);
  return {Motion::of(pair.b, start, 0.9 * inwards), Motion::of(pair.b, start, -inwards),
          Motion::of(pair.b, start, Eigen::Vector3d::Zero(), spin), Motion::of(pair.b, start, 0.9 * inwards, spin),
          Motion::of(pair.b, start, side, 2.0 * spin)};
}

/// Calls use(pair, case, query) for the cases of a place.
template <class Use>
void for_cases(const Subject& subject, Place place, const Use& use) {
  for (const Pair& pair : pairs()) {
    const auto query = subject.prepare(pair.a, pair.b);
    for (const Case& each : pair.cases) {
      if (each.place == place) use(pair, each, *query);
    }
  }
}

/// Hits, their times and misses as conservative advancement proves them.
void check_casts(const Subject& subject, Findings& findings) {
  if (subject.declared.cast_error == k_no_claim) return findings.has_no_claim("cast_error");
  for_cases(subject, Place::apart, [&](const Pair& pair, const Case& each, Query& query) {
    const DistanceOracle oracle(pair.a, pair.b);
    DistanceQuery distance(oracle);
    for (const Motion& motion : motions_from(pair, each)) {
      const ImpactBracket truth = advance(distance, pair.b.box(), motion);
      std::string words;
      const Outcome<Impact> answer = cast(query, motion, words);
      const double tolerance =
          std::max(subject.declared.cast_error, impact_tolerance(motion, pair.b.box(), pair.a.diagonal()));
      const JudgedImpact judged = judge_impact(truth, answer, tolerance);
      if (judged.verdict == ImpactVerdict::right || judged.verdict == ImpactVerdict::not_judged) continue;
      findings.fail(
          fmt::format("cast by ({}, {}, {}), rotation ({}, {}, {}): {}{}{}; the contact is at {}",
                      motion.translation.x(), motion.translation.y(), motion.translation.z(), motion.rotation.x(),
                      motion.rotation.y(), motion.rotation.z(), to_string(judged.verdict), words.empty() ? "" : ": ",
                      words, truth.kind == ImpactBracket::Kind::hit ? fmt::format("{}", truth.t_touch) : "no time"),
          {subject, pair.a, pair.b, each.pose});
    }
  });
}

/// Overlapping bodies are in contact at t = 0, whatever the motion.
void check_contact_at_start(const Subject& subject, Findings& findings) {
  for_cases(subject, Place::overlapping, [&](const Pair& pair, const Case& each, Query& query) {
    for (const Motion& motion : motions_from(pair, each)) {
      std::string words;
      const Outcome<Impact> answer = cast(query, motion, words);
      if (answer.ok() && answer.value.at_start()) continue;
      findings.fail(fmt::format("cast of overlapping bodies: {}; it should be a hit at 0",
                                answer.ok() ? fmt::format("hit {} at {}", answer.value.hit, answer.value.t) : words),
                    {subject, pair.a, pair.b, each.pose});
    }
  });
}

/// Bodies that are apart and do not move never touch.
void check_no_motion(const Subject& subject, Findings& findings) {
  for_cases(subject, Place::apart, [&](const Pair& pair, const Case& each, Query& query) {
    std::string words;
    const Outcome<Impact> answer = cast(query, Motion::of(pair.b, each.pose.X_AB, Eigen::Vector3d::Zero()), words);
    if (answer.ok() && !answer.value.hit) return;
    findings.fail(fmt::format("cast without a motion: {}", answer.ok() ? "a hit" : words),
                  {subject, pair.a, pair.b, each.pose});
  });
}

void check_motions_not_finite(const Subject& subject, Findings& findings) {
  const Pair& pair = pairs().front();
  const auto query = subject.prepare(pair.a, pair.b);
  const Motion good = Motion::of(pair.b, pair.cases.front().pose.X_AB, {0.1, 0.2, 0.3}, {0.3, 0.2, 0.1});
  std::vector<Motion> bad(3, good);
  bad[0].translation.y() = k_nan;
  bad[1].rotation.z() = std::numeric_limits<double>::infinity();
  bad[2].start.t.x() = k_nan;
  for (const Motion& motion : bad) {
    std::string words;
    const Status status = cast(*query, motion, words).status;
    if (status != Status::failed && status != Status::non_finite) {
      findings.fail(fmt::format("cast of a motion that is not finite: status {}; it should be failed or non_finite",
                                to_string(status)));
    }
  }
}

constexpr Check k_checks[] = {{"Cast", Needs::cast, check_casts},
                              {"CastAtStart", Needs::cast, check_contact_at_start},
                              {"CastWithoutMotion", Needs::cast, check_no_motion},
                              {"MotionsNotFinite", Needs::cast, check_motions_not_finite}};

}  // namespace

std::span<const Check> cast_checks() { return k_checks; }

}  // namespace sixdof::conformance
