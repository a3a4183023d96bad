#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/own_command.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/results/results.h>
#include "bench/cli/recommend.h"
#include "bench/common/duration.h"
#include "bench/common/json_text.h"

namespace sixdof::cli {
namespace {

using results::Candidate;
using results::Standing;

std::string name_of(const Verdict& verdict, const Candidate& candidate) {
  const auto& assignments = verdict.assignments[candidate.place];
  return fmt::format("{}{}{}", verdict.rows[candidate.place].fields.algorithm, assignments.empty() ? "" : " ",
                     fmt::join(assignments, " "));
}

/// The same of first contacts.
std::string cast_answers_text(const Verdict& verdict, const Candidate& candidate) {
  const results::Row& row = verdict.rows[candidate.place];
  const double judged = row.count("judged");
  std::string text = fmt::format("0 of {:.0f} contacts missed, late or wrong (at most {:.2g} %, with 95 % confidence)",
                                 judged, 100.0 * results::most_wrong(judged));
  if (row.count("early") > 0.0) {
    text += fmt::format(", {:.0f} early by up to {:.2g} % of the motion", row.count("early"),
                        100.0 * row.count("early_max"));
  }
  return text;
}

/// How right its answers are.
std::string answers_text(const Verdict& verdict, const Candidate& candidate) {
  const results::Row& row = verdict.rows[candidate.place];
  const auto value = [&](const char* name) { return row.value(name).value_or(0.0); };
  const double judged = value("judged_apart") + value("judged_near") + value("judged_overlapping");
  std::string text = row.fields.approximates ? "approximate, " : "";
  if (verdict.query == results::k_cast) return text + cast_answers_text(verdict, candidate);
  if (verdict.query == "collide" || (verdict.query == "distance" && candidate.exact)) {
    text += fmt::format("0 of {:.0f} answers wrong (at most {:.2g} %, with 95 % confidence)", judged,
                        100.0 * results::most_wrong(judged));
  } else if (verdict.query == "distance") {
    text += fmt::format("distances off by at most {:.2g} % of the diagonal of A's box", 100.0 * value("error_max"));
  } else if (row.value("gamma_F_deg").value_or(1.0) <= results::k_rounding) {
    text += fmt::format("the exact force at all {:.0f} poses", judged);
  } else {
    text += fmt::format("force off by {:.1f} degrees on average, {:.0f} at most", value("gamma_F_deg"),
                        value("gamma_max_F_deg"));
  }
  const bool is_usual =
      verdict.metric == "mismatch" || verdict.metric == "error_max" || verdict.metric == "gamma_F_deg";
  return is_usual ? text : text + fmt::format("; {} {:.3g}", verdict.metric, candidate.error.value);
}

std::string time_text(const Verdict& verdict, const Candidate& candidate) {
  const results::Row& row = verdict.rows[candidate.place];
  std::string text = fmt::format("{} on average, {:.0f} of {:.0f} queries late",
                                 duration_text(1e-9 * candidate.mean_ns.value), candidate.late, candidate.timed);
  const double idle = row.count("idle_late");
  if (candidate.late > 0.0 || idle > 0.0) text += fmt::format(" (of a loop that asks nothing: {:.0f})", idle);
  return text;
}

/// Advice where the machine alone misses the deadline, or too often to say what an algorithm does; empty otherwise.
std::string noise_text(const std::vector<Verdict>& verdicts) {
  double idle = 0.0, timed = 0.0;
  bool is_noisy = false;
  for (const Verdict& verdict : verdicts) {
    for (const results::Row& row : verdict.rows) {
      is_noisy |= row.count("idle_late") > results::k_most_late * row.count("timed");
      if (row.count("idle_late") > idle) idle = row.count("idle_late"), timed = row.count("timed");
    }
    is_noisy |= std::ranges::any_of(verdict.choice.candidates, [](const Candidate& candidate) {
      return candidate.standing == Standing::undecided;
    });
  }
  if (!is_noisy) return {};
  return fmt::format(
      "\nThis machine is too noisy for the deadline: a loop that asks nothing was late up to {:.0f} times of {:.0f}.\n"
      "Stop other work, or give the program a core of its own (isolcpus, taskset) and a priority (chrt).\n",
      idle, timed);
}

void print_verdict(const Verdict& verdict) {
  const Candidate* const taken = verdict.choice.taken();
  const std::string label = fmt::format("{:<11}", words_of(verdict.query));
  if (!verdict.choice.missing.empty()) {
    fmt::print("{} cannot say: {}\n", label, verdict.choice.missing);
  } else if (taken == nullptr) {
    fmt::print("{} none: no algorithm keeps the deadline with safe answers\n", label);
  } else {
    fmt::print("{} take {}: {}; {}\n", label, name_of(verdict, *taken), answers_text(verdict, *taken),
               time_text(verdict, *taken));
  }
}

std::string candidate_text(const Verdict& verdict, const Candidate& candidate) {
  switch (candidate.standing) {
    case Standing::left_out:
    case Standing::faulty:
    case Standing::unsafe:
      return candidate.reason;
    case Standing::undecided:
    case Standing::late:
      return fmt::format("{}; {}", candidate.reason, answers_text(verdict, candidate));
    case Standing::not_ranked:
      if (candidate.interpreted) break;
      return fmt::format("{}; {}", answers_text(verdict, candidate), time_text(verdict, candidate));
    case Standing::taken:
      return fmt::format("{}; {}", answers_text(verdict, candidate), time_text(verdict, candidate));
    case Standing::tied:
    case Standing::slower:
    case Standing::less_right:
      break;
  }
  if (candidate.reason == "approximate") {
    return fmt::format("{}; {}", answers_text(verdict, candidate), time_text(verdict, candidate));
  }
  return fmt::format("{}; {}; {}", candidate.reason, answers_text(verdict, candidate), time_text(verdict, candidate));
}

/// Those of one algorithm that were left out for the same reason share a line.
void print_candidates(const Verdict& verdict) {
  std::vector<std::pair<std::string, std::size_t>> told;  // of those left out: algorithm and reason, how many
  for (const Candidate& candidate : verdict.choice.candidates) {
    if (candidate.standing != Standing::left_out) {
      fmt::print("  {:<10} {}: {}\n", to_string(candidate.standing), name_of(verdict, candidate),
                 candidate_text(verdict, candidate));
      continue;
    }
    const std::string words = verdict.rows[candidate.place].fields.algorithm + ": " + candidate.reason;
    const auto same = std::ranges::find(told, words, [](const auto& each) { return each.first; });
    same == told.end() ? static_cast<void>(told.emplace_back(words, 1)) : static_cast<void>(++same->second);
  }
  for (const auto& [words, count] : told) {
    fmt::print("  {:<10} {}{}\n", to_string(Standing::left_out), words,
               count > 1 ? fmt::format(" ({} settings)", count) : std::string());
  }
}

/// The command that measures what was taken again as rows of sixdof-bench.
std::string command_again(const Verdict& verdict, const RecommendOptions& options, const CatalogueEntry& pair) {
  const Candidate& taken = *verdict.choice.taken();
  const results::RowFields& row = verdict.rows[taken.place].fields;
  const std::string& algorithm = row.algorithm;
  std::string text = own_bench_program();
  if (!options.study.a.empty()) text += " --a " + shell_quoted(options.study.a);
  if (!options.study.b.empty()) text += " --b " + shell_quoted(options.study.b);
  for (const std::string& set : options.study.sets) text += " --no-manifest --set " + shell_quoted(set);
  ProcessOptions process = options.study.process;
  if (!row.isolated) process.isolate = ProcessOptions().isolate;
  text += process_words(process);
  for (const std::string& assignment : verdict.assignments[taken.place]) {
    text += fmt::format(" -p {}:{}", algorithm, assignment);
  }
  const std::string rows = fmt::format("{}/algorithm:{}/pair:{}/", verdict.query, algorithm, pair.pair);
  const char* const places = verdict.query == results::k_cast ? "motion:[a-z]+/step:(1|10)"
                             : options.in_motion()            ? "[^/]*/order:motion"
                                                              : "[^/]*";
  const std::string filter = fmt::format("--benchmark_filter=^{}{}$", results::name_expression(rows), places);
  return text + fmt::format(" --suite all {}", shell_quoted(filter));
}

nlohmann::ordered_json as_json(const Verdict& verdict, const Candidate& candidate) {
  const results::Row& row = verdict.rows[candidate.place];
  nlohmann::ordered_json json = {{"standing", to_string(candidate.standing)},
                                 {"algorithm", row.fields.algorithm},
                                 {"settings", row.fields.settings},
                                 {"reason", candidate.reason}};
  if (candidate.standing == Standing::left_out) return json;
  json["exact"] = candidate.exact;
  json[verdict.metric] = candidate.error.value;
  json[verdict.metric + "_low"] = candidate.error.low;
  json[verdict.metric + "_high"] = candidate.error.high;
  json["mean_ns"] = candidate.mean_ns.value;
  json["late"] = candidate.late;
  json["timed"] = candidate.timed;
  json["idle_late"] = row.count("idle_late");
  return json;
}

}  // namespace

std::string words_of(const std::string& query) { return query == "collide" ? "yes-no" : query; }

void print_text(const RecommendOptions& options, double deadline_s, const CatalogueEntry& pair,
                const std::vector<Verdict>& verdicts) {
  fmt::print("{}, a query within {}{}:\n\n", pair.pair, duration_text(deadline_s),
             options.in_motion() ? ", poses that follow each other" : "");
  for (const Verdict& verdict : verdicts) print_verdict(verdict);
  fmt::print("{}", noise_text(verdicts));
  for (const Verdict& verdict : verdicts) {
    if (verdict.choice.candidates.empty()) continue;
    fmt::print("\n{}, {}\n", words_of(verdict.query), verdict.poses);
    print_candidates(verdict);
    if (verdict.choice.taken() != nullptr) fmt::print("  again      {}\n", command_again(verdict, options, pair));
  }
}

void print_json(const RecommendOptions& options, double deadline_s, const CatalogueEntry& pair,
                const std::vector<Verdict>& verdicts) {
  nlohmann::ordered_json json = {{"pair", pair.pair}, {"order", options.order}, {"deadline_ns", 1e9 * deadline_s}};
  json["questions"] = nlohmann::ordered_json::array();
  for (const Verdict& verdict : verdicts) {
    nlohmann::ordered_json entry = {
        {"question", words_of(verdict.query)}, {"metric", verdict.metric}, {"judged", verdict.poses}};
    entry["missing"] =
        verdict.choice.missing.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(verdict.choice.missing);
    entry["candidates"] = nlohmann::ordered_json::array();
    for (const Candidate& candidate : verdict.choice.candidates)
      entry["candidates"].push_back(as_json(verdict, candidate));
    if (verdict.choice.taken() != nullptr) entry["again"] = command_again(verdict, options, pair);
    json["questions"].push_back(std::move(entry));
  }
  fmt::print("{}\n", json_text(json));
}

}  // namespace sixdof::cli
