#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/own_command.h>
#include <sixdof/conformance/checks.h>
#include <sixdof/conformance/declared.h>
#include "bench/cli/commands.h"
#include "bench/cli/rival_claims.h"
#include "bench/cli/shared.h"
#include "bench/common/interrupt.h"
#include "bench/common/json_text.h"
#include "bench/common/rivals.h"
#include "bench/common/run_guarded.h"
#include "bench/harness/query_command.h"

namespace sixdof::cli {
namespace {

using conformance::Check;
using conformance::Declaration;
using conformance::Finding;
using conformance::Subject;
using conformance::Verdict;
using Json = nlohmann::ordered_json;

constexpr const char* k_details =
    "Each line is one check: passed; failed; known failure (failed as declared); not answered (the algorithm gives no "
    "such answers); not claimed. Below a failure stands a command that asks the same. Exit code 3 if a check failed, "
    "or a known failure passes.\n\n"
    "Claims: collide=surfaces|bodies (yes/no where one body is inside the other), open_meshes=yes|no, and the largest "
    "errors distance_error, witness_error, volume_error, force_degrees, order_error, motion_error, scale_error, "
    "repeat_error, cast_error, contact_error, contact_degrees, depth_error, contact_change_degrees: a number, or none. "
    "Without them an algorithm is held to the claims of an exact one that sees "
    "surfaces; those of sixdof's own algorithms and adapters are known, those of rivals stand in their recipes. An "
    "algorithm about convex hulls is asked about hulls. lib/sixdof/conformance/README.md has the checks and units, "
    "lib/sixdof/query/README.md the rules.\n\n"
    "An algorithm in this process that crashes ends the command; with --isolate that is a failed check.";

struct Options {
  std::vector<std::string> algorithms, checks, parameters, claims, known_failures;
  std::string meshes = "conform-meshes", json;
  ProcessOptions process;
};

/// Those that are named; else those that were added to this program's own; else those of default runs.
/// @throws BadArgument for an algorithm that does not exist
std::vector<const Algorithm*> chosen_algorithms(const Registry& registry, const std::vector<std::string>& added,
                                                const Options& options) {
  std::vector<std::string> names = options.algorithms.empty() ? added : with_rivals(options.algorithms, registry);
  if (names.empty()) {
    for (const auto& algorithm : registry.all()) {
      // `null` answers with constants.
      const Traits& traits = algorithm->traits();
      if (traits.in_default_runs() && traits.name != "null") names.push_back(traits.name);
    }
  }
  std::vector<const Algorithm*> chosen;
  for (const std::string& name : names) {
    const Algorithm& algorithm = registry.find(name);
    if (std::ranges::find(chosen, &algorithm) == chosen.end()) chosen.push_back(&algorithm);
  }
  return chosen;
}

/// "ALGORITHM:NAME=VALUE"
struct Assignment {
  std::string algorithm, name, value;
};

/// @throws BadArgument for a text of another form, and for an algorithm that is not asked
std::vector<Assignment> parse_assignments(const char* option, const std::vector<std::string>& texts,
                                          const std::vector<const Algorithm*>& algorithms) {
  std::vector<Assignment> list;
  for (const std::string& text : texts) {
    const std::size_t colon = text.find(':');
    const std::size_t equals = colon == std::string::npos ? colon : text.find('=', colon);
    if (equals == std::string::npos) {
      throw BadArgument(fmt::format("{} {}: must read ALGORITHM:NAME=VALUE", option, text));
    }
    Assignment parsed{text.substr(0, colon), text.substr(colon + 1, equals - colon - 1), text.substr(equals + 1)};
    const bool is_asked =
        std::ranges::any_of(algorithms, [&](const Algorithm* each) { return each->traits().name == parsed.algorithm; });
    if (!is_asked) {
      throw BadArgument(fmt::format("{} {}: {} is not among the algorithms", option, text, parsed.algorithm));
    }
    list.push_back(std::move(parsed));
  }
  return list;
}

/// What is known of the algorithm, and what the options say beyond it.
Declaration declaration_for(const Algorithm& algorithm, const std::vector<Assignment>& parameters,
                            const std::vector<Assignment>& claims, const std::vector<Assignment>& known_failures) {
  const std::string& name = algorithm.traits().name;
  Declaration declaration =
      algorithm.traits().is_rival() ? declaration_of_rival(rivals_folder(), name) : conformance::declaration_of(name);
  for (const Assignment& each : parameters) {
    if (each.algorithm == name) declaration.settings.push_back(fmt::format("{}={}", each.name, each.value));
  }
  for (const Assignment& each : claims) {
    if (each.algorithm == name) conformance::set_claim(declaration, each.name, each.value);
  }
  for (const Assignment& each : known_failures) {
    if (each.algorithm == name) declaration.known_failures.push_back({each.name, each.value, {}});
  }
  return declaration;
}

std::vector<const Check*> chosen_checks(const std::vector<std::string>& names) {
  std::vector<const Check*> chosen;
  for (const std::string& name : names) chosen.push_back(&conformance::find_check(name));
  if (!names.empty()) return chosen;
  for (const Check& check : conformance::all_checks()) chosen.push_back(&check);
  return chosen;
}

void print_finding(const Finding& finding) {
  const std::size_t others = finding.failures.empty() ? 0 : finding.failures.size() - 1;
  const bool has_others = finding.verdict == Verdict::failed && others > 0;
  fmt::print("  {:<13}  {}{}{}{}\n", to_string(finding.verdict), finding.check, finding.why.empty() ? "" : ": ",
             finding.why, has_others ? fmt::format(" (and {} more)", others) : std::string());
  if (finding.verdict == Verdict::failed) {
    for (const auto& query : finding.failures.front().queries) fmt::print("                 {}\n", query.command);
  }
  std::fflush(stdout);  // the next check may take long, or end the program
}

Json as_json(const Finding& finding) {
  Json failures = Json::array();
  for (const conformance::Failure& failure : finding.failures) {
    Json commands = Json::array();
    for (const auto& query : failure.queries) commands.push_back(query.command);
    failures.push_back({{"what", failure.what}, {"commands", std::move(commands)}});
  }
  return {{"check", finding.check},
          {"verdict", to_string(finding.verdict)},
          {"why", finding.why.empty() ? Json() : Json(finding.why)},
          {"failures", std::move(failures)}};
}

/// "mine: 12 passed, 1 failed"
std::string summary(const std::string& name, const std::vector<Finding>& findings) {
  std::string text;
  for (const Verdict verdict :
       {Verdict::passed, Verdict::failed, Verdict::known_failure, Verdict::not_answered, Verdict::not_claimed}) {
    const auto count = std::ranges::count(findings, verdict, &Finding::verdict);
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, to_string(verdict));
  }
  return fmt::format("{}: {}", name, text);
}

/// Runs the checks and prints a line for each.
std::vector<Finding> run_checks(const std::vector<const Check*>& checks, const Subject& subject) {
  const Traits& traits = subject.traits();
  fmt::print("{} {}\n", traits.name, traits.version);
  std::vector<Finding> findings;
  for (const Check* const check : checks) {
    InterruptGuard::check();
    findings.push_back(conformance::run_check(*check, subject));
    print_finding(findings.back());
  }
  fmt::print("{}\n", summary(traits.name, findings));
  return findings;
}

void run(const Options& options) {
  Registry registry;
  const std::vector<std::string> added = register_all_algorithms(registry, options.process);
  const std::vector<const Algorithm*> algorithms = chosen_algorithms(registry, added, options);
  const std::vector<const Check*> checks = chosen_checks(options.checks);
  const auto parameters = parse_assignments("--parameter", options.parameters, algorithms);
  const auto claims = parse_assignments("--claim", options.claims, algorithms);
  const auto known_failures = parse_assignments("--known-failure", options.known_failures, algorithms);
  std::vector<std::unique_ptr<Subject>> subjects;
  for (const Algorithm* const algorithm : algorithms) {
    subjects.push_back(std::make_unique<Subject>(
        *algorithm, declaration_for(*algorithm, parameters, claims, known_failures),
        conformance::Commands{
            .program = own_command("sixdof"), .options = bench::process_option(*algorithm), .folder = options.meshes}));
  }
  Json json = Json::array();
  std::string failed;
  for (const auto& subject : subjects) {
    const Traits& traits = subject->traits();
    Json list = Json::array();
    for (const Finding& finding : run_checks(checks, *subject)) {
      list.push_back(as_json(finding));
      if (finding.verdict != Verdict::failed) continue;
      failed += fmt::format("{}{} of {}", failed.empty() ? "" : ", ", finding.check, traits.name);
    }
    json.push_back({{"algorithm", traits.name},
                    {"version", traits.version},
                    {"settings", subject->settings.to_string()},
                    {"checks", std::move(list)}});
  }
  if (!options.json.empty()) write_file_atomically(options.json, json_text(json) + "\n");
  if (!failed.empty()) throw DefectsFound("these checks failed: " + failed);
}

}  // namespace

void add_conform_command(CLI::App& app) {
  auto* const command =
      app.add_subcommand("conform", "Check an algorithm of your own, or any other, against the rules for adapters");
  const auto options = std::make_shared<Options>();
  command
      ->add_option("--algorithms,--algorithm", options->algorithms,
                   "Algorithms to check, one or more; rivals: all that are set up")
      ->type_name("ALGORITHM")
      ->default_str("those of --external and those added to this program; without any, those of default runs")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--checks", options->checks, "Only these checks: Collide,Distance")
      ->type_name("CHECK")
      ->default_str("all")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option("-p,--parameter", options->parameters,
                   "Parameter of an algorithm (sixdof algorithms lists them); may be repeated")
      ->type_name("ALGORITHM:NAME=VALUE")
      ->allow_extra_args(false);
  command->add_option("--claim", options->claims, "What an algorithm claims (below); may be repeated")
      ->type_name("ALGORITHM:NAME=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option("--known-failure", options->known_failures,
                   "A check that an algorithm fails for a known reason; may be repeated")
      ->type_name("ALGORITHM:CHECK=REASON")
      ->allow_extra_args(false);
  command
      ->add_option("--meshes", options->meshes,
                   "Folder for meshes of commands below failures; made where one is needed")
      ->type_name("FOLDER")
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the findings to this file (JSON)")->type_name("FILE");
  add_process_options(*command, options->process);
  command->callback([options] { run(*options); });
  add_examples(*command, "sixdof conform --algorithm exact,fcl-rss",
               "sixdof conform --algorithm brute-force --checks Collide,Distance --json findings.json", k_details);
}

}  // namespace sixdof::cli
