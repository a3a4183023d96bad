#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/conformance/findings.h>
#include <sixdof/conformance/subject.h>

/// The checks of README.md, as functions: the command `sixdof conform` and the GoogleTest cases (conformance.h) run
/// them.

namespace sixdof::conformance {

/// Which algorithms a check is for.
enum class Needs {
  nothing,
  collide,
  distance,
  respond,
  cast,
  contacts,
  a_missing_kind  ///< Those that leave a kind of query unanswered.
};

struct Check {
  const char* name;
  Needs needs;
  void (*run)(const Subject&, Findings&);
};

std::span<const Check> agreement_checks();   ///< With the oracles.
std::span<const Check> invariance_checks();  ///< What must not change the answers.
std::span<const Check> cast_checks();        ///< First contacts.
std::span<const Check> contact_checks();     ///< Contacts, by exact geometry.
std::span<const Check> state_checks();       ///< Statuses, repetition, threads, lifetimes.

/// All of them, in the order in which they are run.
const std::vector<Check>& all_checks();

/// @throws BadArgument that lists the names
const Check& find_check(const std::string& name);

bool applies(const Check& check, const QuerySet& answers);

enum class Verdict {
  passed,
  failed,
  known_failure,  ///< Failed as the declaration says.
  not_answered,   ///< The algorithm gives no such answers.
  not_claimed     ///< The declaration claims nothing here.
};

/// "passed", "failed", "known failure", "not answered", "not claimed"
std::string_view to_string(Verdict verdict);

/// The result of one check.
struct Finding {
  std::string check;
  Verdict verdict = Verdict::passed;
  std::string why = {};                ///< In words; empty if it passed. Of a failure, the first one's.
  std::vector<Failure> failures = {};  ///< Of a check that failed, known or not.
};

/// Runs the check if it applies. What it throws is a failure, too.
Finding run_check(const Check& check, const Subject& subject);

}  // namespace sixdof::conformance
