#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/results/choice.h>
#include <sixdof/results/results.h>
#include "bench/cli/commands.h"
#include "bench/cli/shared.h"
#include "bench/cli/study_options.h"
#include "bench/common/duration.h"
#include "bench/common/json_text.h"
#include "bench/common/progress_line.h"
#include "bench/common/run_guarded.h"
#include "bench/harness/run_context.h"
#include "bench/study/precision.h"
#include "bench/study/study_pairs.h"

namespace sixdof::cli {
namespace {

using bench::QueryKind;
using results::Candidate;
using results::Choice;
using study::PrecisionPoint;
using study::PrecisionStudy;

/// Enough for a p99.9.
constexpr std::size_t k_queries = 2100;
constexpr unsigned k_most_threads = 64;

struct Options {
  StudyOptions study{.budget = "3min"};
  std::string deadline = "1ms";
  std::string metric = "gamma_F_deg";
  std::string order = "random";
  unsigned threads = 1;

  bool in_motion() const { return order == "motion"; }
};

/// The question that has the metric among its errors. @throws BadArgument, which lists them
QueryKind question_of(const std::string& metric) {
  std::vector<std::string> known;
  for (const QueryKind question : {QueryKind::respond, QueryKind::distance, QueryKind::collide}) {
    const std::vector<std::string> metrics = study::error_metrics(question);
    if (std::ranges::find(metrics, metric) != metrics.end()) return question;
    known.insert(known.end(), metrics.begin(), metrics.end() - 1);  // all end with "failed"
  }
  known.emplace_back("failed");
  require_metric("--metric", metric, known);
  return QueryKind::respond;
}

std::string name_of(const PrecisionPoint& point) {
  const auto& assignments = point.sweep.assignments;
  return fmt::format("{}{}{}", point.algorithm->traits().name, assignments.empty() ? "" : " ",
                     fmt::join(assignments, " "));
}

std::string error_text(const Candidate& candidate, const PrecisionPoint& point, const std::string& metric) {
  std::string text = fmt::format("{} {:.3g}", metric, candidate.error.value);
  if (candidate.error.low < candidate.error.high) {
    text += fmt::format(" [{:.3g}, {:.3g}]", candidate.error.low, candidate.error.high);
  }
  if (metric != "gamma_F_deg") return text;
  const auto p95 = point.metric("gamma_F_p95_deg"), most = point.metric("gamma_max_F_deg");
  if (p95 && most) text += fmt::format(", 95 % below {:.3g}, largest {:.3g}", p95->value, most->value);
  return text;
}

std::string line(const Candidate& candidate, const Choice& choice, const PrecisionStudy& study) {
  const PrecisionPoint& point = study.points()[candidate.place];
  return fmt::format("{}: {} {} ({} in one pass), {}", name_of(point), choice.tail,
                     duration_text(1e-9 * candidate.tail_ns), duration_text(1e-9 * candidate.tail_once_ns),
                     error_text(candidate, point, study.plan().error));
}

/// The command that measures the recommended point again as rows of sixdof-bench.
std::string command_again(const PrecisionPoint& point, const Options& options, const CatalogueEntry& pair) {
  const std::string& algorithm = point.algorithm->traits().name;
  std::string text = "sixdof-bench";
  if (!options.study.a.empty()) text += " --a " + options.study.a;
  if (!options.study.b.empty()) text += " --b " + options.study.b;
  for (const std::string& set : options.study.sets) text += " --no-manifest --set " + set;
  for (const std::string& assignment : point.sweep.assignments) {
    text += fmt::format(" -p {}:{}", algorithm, assignment);
  }
  return text + fmt::format(" --suite all --benchmark_filter='^{}/algorithm:{}/pair:{}/[^/]*{}$'",
                            to_string(question_of(options.metric)), algorithm, pair.pair,
                            options.in_motion() ? "/order:motion" : "");
}

nlohmann::ordered_json as_json(const Candidate& candidate, const PrecisionStudy& study) {
  const PrecisionPoint& point = study.points()[candidate.place];
  const std::string& metric = study.plan().error;
  return {{"algorithm", point.algorithm->traits().name},
          {"settings", point.sweep.settings.to_string()},
          {"tail_ns", candidate.tail_ns},
          {"tail_once_ns", candidate.tail_once_ns},
          {metric, candidate.error.value},
          {metric + "_low", candidate.error.low},
          {metric + "_high", candidate.error.high}};
}

void print_text(const Options& options, double deadline_s, const Choice& found, const PrecisionStudy& study) {
  const study::StudySample& sample = study.sample();
  std::vector<std::string> buckets;
  for (const BucketKey key : sample.buckets) buckets.push_back(key.name());
  fmt::print("pair        {}: {} configurations of each algorithm, of {}\n", study.pair().pair, sample.poses.size(),
             fmt::join(buckets, " "));
  if (options.in_motion()) {
    fmt::print("timed       {} motions from some of these, poses {} to {} of each\n",
               sample.motions.poses.size() / sample.motions.period, sample.motions.lead + 1, sample.motions.period);
  }
  fmt::print("deadline    {}, for the {} of a query (the least of three times of each)\n", options.deadline,
             found.tail);
  if (found.best) {
    fmt::print("take        {}\n", line(*found.best, found, study));
    fmt::print("because     its {} is the smallest of all that keep the deadline; its {} is {:.0f} % of it\n",
               options.metric, found.tail, 1e-7 * found.best->tail_ns / deadline_s);
  } else {
    fmt::print("take        none: no algorithm keeps this deadline\n");
  }
  for (const Candidate& slow : found.too_slow) {
    fmt::print("too slow    {}\n", line(slow, found, study));
  }
  if (found.second) fmt::print("runner-up   {}\n", line(*found.second, found, study));
  for (const study::PrecisionPoint& point : study.points()) {
    const std::string name = name_of(point);
    if (!point.left_out.empty()) fmt::print("left out    {}: {}\n", name, point.left_out);
    if (point.measured() && point.faulty()) {
      fmt::print("fault       {}: {}\n", name, results::to_string(point.faults(sample.asked())));
    }
  }
  if (found.best)
    fmt::print("again       {}\n", command_again(study.points()[found.best->place], options, study.pair()));
}

void print_json(const Options& options, double deadline_s, const Choice& found, const PrecisionStudy& study) {
  nlohmann::ordered_json json = {{"pair", study.pair().pair},
                                 {"order", options.order},
                                 {"deadline_ns", 1e9 * deadline_s},
                                 {"tail", found.tail},
                                 {"metric", options.metric}};
  json["best"] = found.best ? as_json(*found.best, study) : nlohmann::ordered_json();
  json["second"] = found.second ? as_json(*found.second, study) : nlohmann::ordered_json();
  json["too_slow"] = nlohmann::ordered_json::array();
  for (const Candidate& slow : found.too_slow) json["too_slow"].push_back(as_json(slow, study));
  if (found.best) json["again"] = command_again(study.points()[found.best->place], options, study.pair());
  fmt::print("{}\n", json_text(json));
}

void run(const Options& options) {
  Registry registry;
  register_all_algorithms(registry, options.study.process);
  const double deadline_s = parse_duration("--deadline", options.deadline);
  study::PrecisionPlan plan{.question = question_of(options.metric), .error = options.metric};
  plan.cost = "p99_least_ns";
  plan.seed = options.study.seed;
  const double budget_s = parse_duration("--budget", options.study.budget);
  const auto start = std::chrono::steady_clock::now();
  plan.single_queries = true;
  plan.deadline_ns = 1e9 * deadline_s;
  plan.rounds = 1;
  plan.most_rounds = 1;
  plan.algorithms = study_algorithms(registry, options.study.algorithms, plan.question);
  plan.values = swept_values(options.study, plan.algorithms);
  if (options.in_motion()) {
    std::ranges::move(study::warm_starts(plan.algorithms, plan.values), std::back_inserter(plan.values));
  }
  std::ranges::move(study::thread_counts(plan.algorithms, plan.values, options.threads),
                    std::back_inserter(plan.values));
  if (options.study.pairs.size() + options.study.sets.size() > 1) throw BadArgument("one pair at a time");
  study::StudyPairs pairs(
      harness_options(options.study, k_queries,
                      arguments_of("recommend", options.study) +
                          fmt::format(" --deadline {} --metric {} --order {} --threads {}", options.deadline,
                                      options.metric, options.order, options.threads)),
      options.study.pairs);
  const CatalogueEntry& pair = *pairs.pairs().front();
  const auto started = bench::run_context(pairs.options(), registry, bench::parse_parameters({}, registry));
  StatusLine status;
  status.show("truth");
  study::StudySample sample = study::draw_sample(pairs.cache(), pair, plan.question, pair.buckets, k_queries);
  if (options.in_motion()) {
    sample.motions = study::draw_motions(sample, pairs.cache().mesh(pair.a), pairs.cache().mesh(pair.b), plan.seed);
  }
  plan.budget_s = budget_s - std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  study::PrecisionStudy study(plan, pairs.cache(), pair, sample);
  const auto write = [&](bool interrupted) {
    if (options.study.output.empty()) return;
    auto context = started;
    for (const auto& [key, hash] : pairs.cache().hashes()) context[key] = hash;
    if (interrupted) context["interrupted"] = "true";
    results::write_rows(options.study.output, context, study.rows());
  };
  study.run([&](const std::string& what, std::size_t done,
                std::size_t total) { status.show(fmt::format("{}, {} of {} points", what, done, total)); },
            [&] { write(true); });
  status.clear();
  write(false);
  const Choice found = results::choose(study.rows(), study.plan().error, 1e9 * deadline_s);
  options.study.json ? print_json(options, deadline_s, found, study) : print_text(options, deadline_s, found, study);
  if (!found.best) throw DefectsFound(fmt::format("no algorithm keeps a deadline of {}", options.deadline));
}

}  // namespace

void add_recommend_command(CLI::App& app) {
  auto* const command = app.add_subcommand(
      "recommend", "Say which algorithm, with which parameters, keeps a deadline with the least error");
  const auto options = std::make_shared<Options>();
  add_study_options(*command, options->study);
  command->add_option("--deadline", options->deadline, "Longest time of a query: 1ms, 200us")
      ->type_name("TIME")
      ->capture_default_str();
  command
      ->add_option("--metric", options->metric,
                   "Error to minimise: gamma_F_deg (angle of the force, degrees), magnitude_error_F, error_rms "
                   "(distance, diagonals of A), ...")
      ->type_name("METRIC")
      ->capture_default_str();
  command
      ->add_option(
          "--order", options->order,
          "Poses that are timed. random: poses of the set, far from each other. motion: small steps from pose to pose, "
          "as in a haptic loop; warm starts are tried as well")
      ->type_name("ORDER")
      ->check(CLI::IsMember({"random", "motion"}))
      ->capture_default_str();
  command
      ->add_option("--threads", options->threads,
                   "Most threads of one query. Algorithms with a parameter `threads` are tried with N, N/2, ... and 1 "
                   "threads")
      ->type_name("N")
      ->check(CLI::Range(1u, k_most_threads))
      ->capture_default_str();
  command->callback([options] { run(*options); });
  add_examples(
      *command, "sixdof recommend --a cone-1k --b torus-1k --deadline 1ms --algorithms exact,vps --budget 30s",
      "sixdof recommend --a cone-1k --b torus-1k --order motion --metric error_rms --algorithms exact,fcl-rss");
}

}  // namespace sixdof::cli
