#include <sixdof/stability/judge.h>

#include <algorithm>
#include <exception>

#include <sixdof/stability/judge_cast.h>
#include <sixdof/stability/judge_contacts.h>
#include <sixdof/stability/judge_relations.h>
#include <sixdof/stability/judge_shot.h>

namespace sixdof::stability {
namespace {

void measure_times(const std::vector<Answers>& answers, Judgement& judgement) {
  std::vector<double> seconds;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    seconds.push_back(answers[i].seconds);
    if (answers[i].seconds <= judgement.slowest_seconds) continue;
    judgement.slowest_seconds = answers[i].seconds;
    judgement.slowest_shot = i;
  }
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::ranges::nth_element(seconds, middle);
  judgement.median_seconds = *middle;
}

void judge_relation(const Case& member, const std::vector<Answers>& answers, const Traits& traits,
                    const Prepare& prepare, const Limits& limits, std::vector<Finding>& findings) {
  switch (member.relation) {
    case Relation::none:
    case Relation::time:
      return;
    case Relation::same:
      return judge_same(member, answers, traits, findings);
    case Relation::path:
      return judge_path(member, answers, findings);
    case Relation::loop:
      return judge_loop(member, answers, traits, findings);
    case Relation::repeat:
      return judge_repeat(member, answers, traits, prepare, findings);
    case Relation::sweep:
      return judge_sweep(member, traits, prepare, limits, findings);
    case Relation::cast:
      return judge_cast(member, traits, prepare, limits, findings);
    case Relation::contacts:
      return judge_contacts(member, traits, prepare, limits, findings);
    case Relation::bad:
      return judge_bad(member, answers, findings);
  }
}

}  // namespace

const Finding& Judgement::worst() const {
  return *std::ranges::max_element(findings, [](const Finding& x, const Finding& y) { return y.worse_than(x); });
}

Judgement judge(const Case& member, const Traits& traits, const Prepare& prepare, const Limits& limits) {
  Judgement judgement;
  PreparedPairs pairs(prepare, traits);
  std::vector<Answers> answers;
  for (std::size_t i = 0; i < member.shots.size(); ++i) {
    answers.push_back(pairs.ask(member.shots[i]));
    const bool is_pose = !member.shots[i].raw;
    if (is_pose || answers.back().refused || answers.back().prepare_threw) {
      judge_statuses(member.shots[i], i, answers.back(), limits, judgement.findings);
    }
    if (is_pose) judge_truth(member, i, answers.back(), traits, judgement.findings);
  }
  judge_relation(member, answers, traits, prepare, limits, judgement.findings);
  measure_times(answers, judgement);
  if (member.relation == Relation::time && judgement.median_seconds > 0.0) {
    const double ratio = judgement.slowest_seconds / judgement.median_seconds;
    judgement.findings.push_back({.verdict = Verdict::exact,
                                  .metric = "slowest over median",
                                  .value = ratio,
                                  .unit = "1",
                                  .excess = ratio,
                                  .shot = judgement.slowest_shot,
                                  .words = "processor times"});
  }
  if (judgement.findings.empty()) {
    judgement.findings.push_back(declared_finding("none", "1", 0, "answers nothing that is asked"));
  }
  return judgement;
}

}  // namespace sixdof::stability
