#include <sixdof/stability/judge_relations.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include <sixdof/stability/judge_shot.h>

namespace sixdof::stability {
namespace {

Bounds sum(const Bounds& x, const Bounds& y, double scale) {
  return {x.rounding + y.rounding / scale, x.resolution + y.resolution / scale, x.slack + y.slack / scale};
}

/// Directions of two forces that should be the same but for a turn.
void compare_directions(const Case& member, std::size_t index, const Response& first, const Response& other,
                        const Bounds& bounds_first, const Bounds& bounds_other, const Traits& traits,
                        std::vector<Finding>& findings) {
  const Shot& shot = member.shots[index];
  const double depth = -member.shots.front().truth.gap;
  if (first.force.isZero(0.0) || other.force.isZero(0.0) ||
      !(depth > bounds_first.least_depth() + bounds_other.least_depth() / shot.scale)) {
    return;
  }
  const double allowed = rounding_angle(bounds_other, depth * shot.scale) + rounding_angle(bounds_first, depth);
  // The parts that approximate a body lie otherwise in another frame.
  findings.push_back(angle_finding("turned force", shot.turn * first.force, other.force, allowed, traits.approximates,
                                   index, "angle to the force at the case's first pose, in the same frame"));
}

/// Forces by the volume law are areas: they are the same but for a turn and the scale. Where faces lie in one plane the
/// volume has no gradient; truths with a direction are not there.
void compare_areas(const Case& member, std::size_t index, const Response& first, const Response& other,
                   const Bounds& bounds, std::vector<Finding>& findings) {
  const Shot &first_shot = member.shots.front(), &shot = member.shots[index];
  if (!(-first_shot.truth.gap > bounds.rounding)) return;
  const double error = (other.force / (shot.scale * shot.scale) - shot.turn * first.force).norm();
  // The border of the area moves by the rounding; it is a few diagonals long.
  constexpr double k_border = 4.0;
  const double border = k_border * (first_shot.a->diagonal() + first_shot.b->diagonal()), size = member.size();
  Finding finding = length_finding("same force", error / border, size, bounds, index,
                                   "difference to the force at the case's first pose, in the same frame and unit");
  finding.value = error / (size * size);
  finding.unit = "area";
  findings.push_back(std::move(finding));
}

template <class T>
std::uint64_t bits(T x) {
  return std::bit_cast<std::uint64_t>(static_cast<double>(x));
}

/// All that an answer says.
std::vector<double> numbers(const Answers& answers) {
  std::vector<double> all;
  if (answers.collide.outcome.ok()) all.push_back(answers.collide.outcome.value ? 1.0 : 0.0);
  if (answers.distance.outcome.ok()) all.push_back(answers.distance.outcome.value.distance);
  if (answers.respond.outcome.ok()) {
    const Response& response = answers.respond.outcome.value;
    all.push_back(response.penalty);
    for (const Eigen::Vector3d* v : {&response.force, &response.torque}) all.insert(all.end(), v->begin(), v->end());
  }
  return all;
}

bool same_bits(const Answers& x, const Answers& y) {
  const std::vector<double> a = numbers(x), b = numbers(y);
  return std::ranges::equal(a, b, {}, bits<double>, bits<double>);
}

std::vector<Answers> ask_all(const Case& member, const Traits& traits, const Prepare& prepare, bool backwards) {
  PreparedPairs pairs(prepare, traits);
  std::vector<Answers> answers(member.shots.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const std::size_t k = backwards ? answers.size() - 1 - i : i;
    answers[k] = pairs.ask(member.shots[k]);
  }
  return answers;
}

/// The largest relative difference of two lists of answers, or one if their statuses differ.
double difference(const std::vector<Answers>& xs, const std::vector<Answers>& ys) {
  double largest = 0.0;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const std::vector<double> a = numbers(xs[i]), b = numbers(ys[i]);
    if (a.size() != b.size()) return 1.0;
    double scale = 0.0;
    for (const double x : a) scale = std::max(scale, std::abs(x));
    for (std::size_t k = 0; k < a.size(); ++k) {
      if (scale > 0.0) largest = std::max(largest, std::abs(a[k] - b[k]) / scale);
    }
  }
  return largest;
}

/// Steps of Relation::sweep end as near contact as a body of this size allows.
constexpr double k_near = 1e-7;

Shot at_time(const Case& member, double time) {
  Shot shot = member.shots.front();
  shot.truth = {};
  shot.X_AB.t += time * member.motion;
  return shot;
}

/// Yes/no at the start of the sweep and just after the contact.
void judge_contact(const Case& member, const Traits& traits, const Prepare& prepare, const Limits& limits,
                   std::vector<Finding>& findings) {
  const Shot& start = member.shots.front();
  if (!traits.answers.collide || !std::isfinite(member.contact_time)) return;
  const double closing = start.truth.gap / member.contact_time;  // speed along the shortest way
  Shot inside = at_time(member, member.contact_time + 2.0 * k_near * start.a->diagonal() / closing);
  inside.truth.gap = start.truth.gap - closing * (inside.X_AB.t - start.X_AB.t).norm() / member.motion.norm();
  PreparedPairs pairs(prepare, traits);
  const Answers answers = pairs.ask(inside);
  const Case contact{.name = member.name, .shots = {inside}};
  judge_statuses(inside, 0, answers, limits, findings);
  judge_truth(contact, 0, answers, traits, findings);
}

}  // namespace

void judge_same(const Case& member, const std::vector<Answers>& answers, const Traits& traits,
                std::vector<Finding>& findings) {
  const Shot& first = member.shots.front();
  const double size = first.a->diagonal();
  for (std::size_t i = 1; i < answers.size(); ++i) {
    const Shot& shot = member.shots[i];
    const Bounds bounds = sum(bounds_of(first, answers[0]), bounds_of(shot, answers[i]), shot.scale);
    const auto &d0 = answers[0].distance.outcome, &d = answers[i].distance.outcome;
    if (d0.ok() && d.ok()) {
      const double error = std::abs(d.value.distance / shot.scale - d0.value.distance);
      findings.push_back(length_finding(
          "same distance", error, size, bounds, i,
          fmt::format("distance {} and, at the case's first pose, {}", d.value.distance, d0.value.distance)));
    }
    const auto &r0 = answers[0].respond.outcome, &r = answers[i].respond.outcome;
    if (!r0.ok() || !r.ok()) continue;
    if (std::isfinite(r0.value.volume) && std::isfinite(r.value.volume)) {
      const double error = std::abs(r.value.volume / (shot.scale * shot.scale * shot.scale) - r0.value.volume);
      findings.push_back(
          volume_finding("same volume", error, first, bounds, i,
                         fmt::format("volume {} and, at the case's first pose, {}", r.value.volume, r0.value.volume)));
    }
    // Contained bodies may be pushed in any direction.
    if (!first.truth.contained && first.truth.push) {
      compare_directions(member, i, r0.value, r.value, bounds_of(first, answers[0]), bounds_of(shot, answers[i]),
                         traits, findings);
      if (traits.law == ResponseLaw::volume && !traits.approximates)
        compare_areas(member, i, r0.value, r.value, bounds, findings);
    }
  }
}

void judge_path(const Case& member, const std::vector<Answers>& answers, std::vector<Finding>& findings) {
  for (std::size_t i = 1; i < answers.size(); ++i) {
    const Shot &before = member.shots[i - 1], &shot = member.shots[i];
    const double step = (shot.X_AB.t - before.X_AB.t).norm(), size = shot.a->diagonal();
    const Bounds bounds = sum(bounds_of(before, answers[i - 1]), bounds_of(shot, answers[i]), 1.0);
    const auto slope = [&](const char* metric, double change) {
      Finding finding = length_finding(metric, std::max(0.0, change - step), size, bounds, i,
                                       fmt::format("a change of {} in a step of {}", change, step));
      if (finding.verdict == Verdict::exact) finding.value = 0.0;
      findings.push_back(finding);
    };
    const auto &d0 = answers[i - 1].distance.outcome, &d = answers[i].distance.outcome;
    if (d0.ok() && d.ok()) slope("slope of the distance", std::abs(d.value.distance - d0.value.distance));
    const auto &r0 = answers[i - 1].respond.outcome, &r = answers[i].respond.outcome;
    if (r0.ok() && r.ok() && std::isfinite(r.value.volume) && std::isfinite(r0.value.volume)) {
      slope("slope of the volume", std::abs(r.value.volume - r0.value.volume) / moving_area(shot));
    }
  }
}

void judge_loop(const Case& member, const std::vector<Answers>& answers, const Traits& traits,
                std::vector<Finding>& findings) {
  double work = 0.0, length = 0.0, peak = 0.0;
  const bool has_potential = traits.law == ResponseLaw::volume && !traits.approximates;
  for (std::size_t i = 1; i < answers.size(); ++i) {
    const auto &r0 = answers[i - 1].respond.outcome, &r = answers[i].respond.outcome;
    if (!r0.ok() || !r.ok()) return;
    const Eigen::Vector3d step = member.shots[i].X_AB.t - member.shots[i - 1].X_AB.t;
    work += 0.5 * (r0.value.force + r.value.force).dot(step);
    length += step.norm();
    peak = std::max(peak, r.value.force.norm());
  }
  if (peak == 0.0) return;
  // Sums by trapezia of a force with kinks.
  const double steps = static_cast<double>(answers.size()), allowed = 4.0 / steps;
  const double value = std::abs(work) / (peak * length);
  findings.push_back({.verdict = value <= allowed ? Verdict::exact
                                 : has_potential  ? Verdict::wrong
                                                  : Verdict::resolution,
                      .metric = "loop work",
                      .value = value,
                      .unit = "1",
                      .excess = value / allowed,
                      .words = "work over peak force times length"});
}

void judge_repeat(const Case& member, const std::vector<Answers>& answers, const Traits& traits, const Prepare& prepare,
                  std::vector<Finding>& findings) {
  // An order or a thread may change rounding only.
  constexpr double k_rounding = 1e-12;
  const auto compare = [&](const char* metric, const std::vector<Answers>& others, bool all_bits) {
    bool equal = true;
    for (std::size_t i = 0; i < others.size(); ++i) equal = equal && same_bits(answers[i], others[i]);
    const double by = difference(answers, others);
    const bool right = all_bits ? equal : by <= k_rounding;
    findings.push_back({.verdict = right ? Verdict::exact : Verdict::wrong,
                        .metric = metric,
                        .value = by,
                        .unit = "1",
                        .excess = by / k_rounding,
                        .words = "relative difference of the answers"});
  };
  compare("second object", ask_all(member, traits, prepare, false), true);
  compare("other order", ask_all(member, traits, prepare, true), false);
  std::vector<Answers> at_once[2];
  {
    std::jthread one([&] { at_once[0] = ask_all(member, traits, prepare, false); });
    std::jthread two([&] { at_once[1] = ask_all(member, traits, prepare, false); });
  }
  for (const auto& others : at_once) compare("two threads", others, true);
}

void judge_sweep(const Case& member, const Traits& traits, const Prepare& prepare, const Limits& limits,
                 std::vector<Finding>& findings) {
  if (!traits.answers.distance) return judge_contact(member, traits, prepare, limits, findings);
  PreparedPairs pairs(prepare, traits);
  const Shot& start = member.shots.front();
  const double size = start.a->diagonal(), speed = member.motion.norm();
  constexpr int k_most_steps = 2000;
  double time = 0.0;
  // A time after which bodies that part are far from each other.
  const double end = std::isfinite(member.contact_time) ? 2.0 * member.contact_time : 4.0 * size / speed;
  Bounds bounds{};
  int steps = 0;
  for (; steps < k_most_steps && time < end; ++steps) {
    const Shot shot = at_time(member, time);
    const Answers answers = pairs.ask(shot);
    judge_statuses(shot, 0, answers, limits, findings);
    if (!answers.distance.outcome.ok()) return;
    bounds = bounds_of(shot, answers);
    const double distance = answers.distance.outcome.value.distance;
    if (distance <= k_near * size) break;
    time += distance / speed;
  }
  const bool touched = time < end && steps < k_most_steps;
  if (!std::isfinite(member.contact_time)) {
    findings.push_back({.verdict = touched ? Verdict::wrong : Verdict::exact,
                        .metric = "phantom",
                        .unit = "size",
                        .words = "bodies that part"});
    return;
  }
  bounds.rounding += 2.0 * k_near * size;
  findings.push_back(
      touched ? length_finding("time of contact", std::abs(time - member.contact_time) * speed, size, bounds, 0,
                               fmt::format("contact at {} instead of {}", time, member.contact_time))
              : Finding{.verdict = Verdict::wrong, .metric = "missed", .unit = "size", .words = "passed through"});
}

void judge_bad(const Case& member, const std::vector<Answers>& answers, std::vector<Finding>& findings) {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!member.shots[i].raw) continue;
    const Pose X = member.shots[i].pose();
    const bool finite = X.R.allFinite() && X.t.allFinite();
    for_each_query(answers[i], [&](const char* query, Status status, const std::string& words) {
      if (status == Status::unsupported) return;
      Finding finding{.metric = query, .unit = "1", .shot = i, .words = words};
      const bool is_nan = status == Status::non_finite && finite && words == "the answer is not finite";
      const bool ended = std::ranges::find(k_counted_statuses, status) != k_counted_statuses.end();
      if (is_nan || ended) finding.verdict = verdict_of(status);
      if (status == Status::ok && !finite) {
        finding.verdict = Verdict::wrong;
        finding.words = "an answer for a pose that is not finite";
      }
      findings.push_back(finding);
    });
  }
}

}  // namespace sixdof::stability
