#include <sixdof/stability/judge_cast.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/oracle/advancement.h>
#include <sixdof/query/ask.h>
#include <sixdof/stability/judge_shot.h>

namespace sixdof::stability {
namespace {

Finding wrong(const char* metric, std::string words) {
  return {.verdict = Verdict::wrong, .metric = metric, .unit = "1", .words = std::move(words)};
}

/// Of an answer, where the truth is a time.
Finding judge_time(const Case& member, const Impact& impact) {
  if (!impact.hit) return wrong("missed", fmt::format("no hit; the contact is at {}", member.contact_time));
  const Shot& start = member.shots.front();
  const double speed = speed_bound(*member.cast, start.b->box()), size = member.size();
  const double off = (impact.t - member.contact_time) * speed;
  const Bounds bounds{start.rounding() + member.cast->pose_error(start.b->diagonal()), 0.0, k_declared_accuracy * size};
  const std::string words = fmt::format("contact at {} instead of {}", impact.t, member.contact_time);
  if (impact.at_start() && member.contact_time * speed > bounds.largest()) return wrong("false contact", words);
  Finding finding = length_finding("time of impact", std::abs(off), size, bounds, 0, words);
  if (off < 0.0) finding.verdict = std::min(finding.verdict, Verdict::resolution);
  return finding;
}

}  // namespace

void judge_cast(const Case& member, const Traits& traits, const Prepare& prepare, const Limits& limits,
                std::vector<Finding>& findings) {
  if (!traits.answers.cast) return;
  const Shot& start = member.shots.front();
  std::unique_ptr<Query> query;
  try {
    query = prepare(*start.a, *start.b);
  } catch (const Error&) {
    return;  // the shot's other queries have found that
  }
  std::string words;
  const auto keep = [&](const std::string& why) {
    if (words.empty()) words = why;
  };
  const auto begin = std::chrono::steady_clock::now();
  Outcome<Impact> answer = ask_guarded([&] { return query->cast(*member.cast); }, keep);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  examine(*query, answer, keep);
  if (!answer.ok()) {
    findings.push_back({.verdict = verdict_of(answer.status), .metric = "cast", .unit = "1", .words = words});
    return;
  }
  if (seconds > limits.seconds) {
    findings.push_back(
        {.verdict = Verdict::hung, .metric = "cast", .value = seconds, .unit = "s", .words = "too slow"});
  }
  if (std::isfinite(member.contact_time)) {
    findings.push_back(judge_time(member, answer.value));
  } else if (answer.value.hit) {
    findings.push_back(wrong("phantom", fmt::format("a hit at {} of bodies that never touch", answer.value.t)));
  } else {
    findings.push_back({.verdict = Verdict::exact, .metric = "cast", .unit = "1", .words = "no hit"});
  }
}

}  // namespace sixdof::stability
