#include <sixdof/conformance/checks.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof::conformance {
namespace {

/// What is known before anything is prepared: the algorithm's traits and the declaration.
void check_declaration(const Subject& subject, Findings& findings) {
  const Traits& traits = subject.traits();
  if (traits.version.empty()) findings.fail("Traits::version is empty");
  if (traits.summary.empty()) findings.fail("Traits::summary is empty");
  if (!traits.answers.any()) {
    findings.fail("Traits::answers has no kind of query");
  }
  if (traits.answers.respond != (traits.law != ResponseLaw::none)) {
    findings.fail("Traits::law belongs to an algorithm that answers respond, and to no other");
  }
  for (const KnownFailure& known : subject.declared.known_failures) {
    const auto found = std::ranges::find(all_checks(), known.check, [](const Check& each) { return each.name; });
    if (found == all_checks().end() || !applies(*found, traits.answers)) {
      findings.fail(fmt::format("known failure \"{}\": no such check of this algorithm", known.check));
    }
    if (known.reason.empty()) findings.fail(fmt::format("known failure \"{}\": no reason", known.check));
  }
}

std::string why_not_asked(Needs needs) {
  switch (needs) {
    case Needs::nothing:
      break;
    case Needs::collide:
      return "it does not answer yes/no";
    case Needs::distance:
      return "it does not answer distances";
    case Needs::respond:
      return "it does not answer responses";
    case Needs::cast:
      return "it does not answer casts";
    case Needs::contacts:
      return "it does not answer contacts";
    case Needs::a_missing_kind:
      return "it answers every kind of query";
  }
  return {};
}

Findings run_guarded(const Check& check, const Subject& subject) {
  Findings findings;
  try {
    check.run(subject, findings);
  } catch (const std::exception& e) {
    findings.fail(fmt::format("thrown: {}", e.what()));
  }
  return findings;
}

/// Null where the declaration has none. That of the declaration itself is none.
const KnownFailure* known_failure(const Check& check, const Subject& subject) {
  if (check.run == check_declaration) return nullptr;
  for (const KnownFailure& known : subject.declared.known_failures) {
    if (known.check == check.name) return &known;
  }
  return nullptr;
}

}  // namespace

const std::vector<Check>& all_checks() {
  static const std::vector<Check> list = [] {
    std::vector<Check> checks{{"Declaration", Needs::nothing, check_declaration}};
    for (const auto& some :
         {agreement_checks(), cast_checks(), contact_checks(), invariance_checks(), state_checks()}) {
      checks.insert(checks.end(), some.begin(), some.end());
    }
    return checks;
  }();
  return list;
}

const Check& find_check(const std::string& name) {
  std::string names;
  for (const Check& check : all_checks()) {
    if (name == check.name) return check;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", check.name);
  }
  throw BadArgument(fmt::format("{}: no such check; there are {}", name, names));
}

bool applies(const Check& check, const QuerySet& answers) {
  switch (check.needs) {
    case Needs::nothing:
      return true;
    case Needs::collide:
      return answers.collide;
    case Needs::distance:
      return answers.distance;
    case Needs::respond:
      return answers.respond;
    case Needs::cast:
      return answers.cast;
    case Needs::contacts:
      return answers.contacts;
    case Needs::a_missing_kind:
      return !(answers.collide && answers.distance && answers.respond);
  }
  return false;
}

std::string_view to_string(Verdict verdict) {
  constexpr std::string_view k_names[] = {"passed", "failed", "known failure", "not answered", "not claimed"};
  return k_names[static_cast<std::size_t>(verdict)];
}

Finding run_check(const Check& check, const Subject& subject) {
  if (!applies(check, subject.traits().answers)) {
    return {.check = check.name, .verdict = Verdict::not_answered, .why = why_not_asked(check.needs)};
  }
  const Findings findings = run_guarded(check, subject);
  const KnownFailure* const known = known_failure(check, subject);
  Finding result{.check = check.name, .failures = findings.failures()};
  if (known != nullptr && result.failures.empty()) {
    result.failures.push_back({fmt::format("{} is listed as known, but passes: {}", check.name, known->reason), {}});
  } else if (known != nullptr) {
    result.verdict = Verdict::known_failure;
    result.why = known->reason + (known->issue.empty() ? "" : " (" + known->issue + ")");
    return result;
  }
  if (!result.failures.empty()) {
    result.verdict = Verdict::failed;
    result.why = result.failures.front().what;
  } else if (!findings.unclaimed().empty()) {
    result.verdict = Verdict::not_claimed;
    result.why = findings.unclaimed();
  } else if (!findings.unanswered().empty()) {
    result.verdict = Verdict::not_answered;
    result.why = findings.unanswered();
  }
  return result;
}

}  // namespace sixdof::conformance
