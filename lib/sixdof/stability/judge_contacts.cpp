#include <sixdof/stability/judge_contacts.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/oracle/contact_truth.h>
#include <sixdof/query/ask.h>
#include <sixdof/query/contacts.h>
#include <sixdof/stability/judge_shot.h>

namespace sixdof::stability {
namespace {

/// More than any library finds on these small bodies.
constexpr std::size_t k_most = 10'000;

constexpr double k_right_angle = 0.5 * std::numbers::pi;
/// Directions that differ by less (radians) are the same.
constexpr double k_same_direction = 1e-6;

double angle(const Eigen::Vector3d& u, const Eigen::Vector3d& v) { return std::atan2(u.cross(v).norm(), u.dot(v)); }

Finding wrong(const char* metric, std::size_t shot, std::string words) {
  return {.verdict = Verdict::wrong, .metric = metric, .unit = "1", .shot = shot, .words = std::move(words)};
}

/// Within the resolution up to a right angle.
Finding direction_finding(const char* metric, const Eigen::Vector3d& u, const Eigen::Vector3d& v, std::size_t shot,
                          const char* words) {
  const double by = angle(u, v);
  return {.verdict = by <= k_same_direction ? Verdict::exact
                     : by < k_right_angle   ? Verdict::resolution
                                            : Verdict::wrong,
          .metric = metric,
          .value = by,
          .unit = "rad",
          .excess = by / k_same_direction,
          .shot = shot,
          .words = words};
}

/// The contacts of a shot; none where there is no answer, which is a finding.
std::optional<Contacts> ask(const Shot& shot, std::size_t index, const Prepare& prepare, const Limits& limits,
                            std::vector<Finding>& findings) {
  std::unique_ptr<Query> query;
  try {
    query = prepare(*shot.a, *shot.b);
  } catch (const Error&) {
    return std::nullopt;  // the shot's other queries have found that
  }
  std::string words;
  const auto begin = std::chrono::steady_clock::now();
  const Outcome<Contacts> answer =
      ask_contacts(*query, shot.pose(), k_most, [&](const std::string& why) { words = why; });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (seconds > limits.seconds) {
    findings.push_back({.verdict = Verdict::hung,
                        .metric = "contacts",
                        .value = seconds,
                        .unit = "s",
                        .shot = index,
                        .words = "too slow"});
  }
  if (answer.ok()) return answer.value;
  findings.push_back(
      {.verdict = verdict_of(answer.status), .metric = "contacts", .unit = "1", .shot = index, .words = words});
  return std::nullopt;
}

/// Each contact against exact geometry.
void judge_each(const Shot& shot, std::size_t index, const Contacts& contacts, std::vector<Finding>& findings) {
  ContactTruth truth(*shot.a, *shot.b);
  truth.move_to(shot.pose());
  const double slack = shot.rounding() + k_contact_slack * shot.a->diagonal();
  for (const Contact& contact : contacts.list) {
    const JudgedContact judged = truth.judge(contact);
    if (const double off = std::min(judged.outside_a, judged.outside_b); off > slack) {
      findings.push_back(wrong("off bodies", index, fmt::format("a contact {} away from the nearer body", off)));
      return;
    }
    if (judged.is_reversed()) {
      findings.push_back(wrong("reversed normal", index,
                               fmt::format("a normal {:.1f} degrees from every true one", judged.normal_angle)));
      return;
    }
  }
}

void judge_depth(const Shot& shot, std::size_t index, const Contacts& contacts, const Traits& traits,
                 std::vector<Finding>& findings) {
  if (traits.depth != ContactDepth::bodies) return;
  double largest = 0.0;
  for (const Contact& each : contacts.list) largest = std::max(largest, each.depth);
  const double depth = -shot.truth.gap;
  findings.push_back(length_finding("depth", std::abs(largest - depth), shot.a->diagonal(), bounds_of(shot, {}), index,
                                    fmt::format("largest depth {} instead of {}", largest, depth)));
}

}  // namespace

void judge_contacts(const Case& member, const Traits& traits, const Prepare& prepare, const Limits& limits,
                    std::vector<Finding>& findings) {
  if (!traits.answers.contacts) return;
  std::optional<Eigen::Vector3d> first;  // mean normal of the first shot
  for (std::size_t i = 0; i < member.shots.size(); ++i) {
    const Shot& shot = member.shots[i];
    const std::optional<Contacts> contacts = ask(shot, i, prepare, limits, findings);
    if (!contacts) continue;
    const Bounds bounds = bounds_of(shot, {});
    if (!(-shot.truth.gap > bounds.largest())) continue;
    if (contacts->list.empty()) {
      findings.push_back(wrong("no contact", i, fmt::format("bodies overlap by {}", -shot.truth.gap)));
      continue;
    }
    judge_each(shot, i, *contacts, findings);
    judge_depth(shot, i, *contacts, traits, findings);
    const Eigen::Vector3d normal = mean_normal(*contacts);
    if (normal.isZero(0.0)) {
      findings.push_back(wrong("no direction", i, "normals cancel"));
      continue;
    }
    if (shot.truth.push) {
      findings.push_back(direction_finding("mean normal", normal, *shot.truth.push, i,
                                           "angle of the mean normal to the shortest way out"));
    }
    if (first) {
      findings.push_back(direction_finding("same normal", shot.turn * *first, normal, i,
                                           "angle to the mean normal at the case's first pose, in the same frame"));
    } else if (i == 0) {
      first = normal;
    }
  }
}

}  // namespace sixdof::stability
