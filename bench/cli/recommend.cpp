#include "bench/cli/recommend.h"

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
#include <sixdof/oracle/solid.h>
#include <sixdof/results/results.h>
#include "bench/cli/commands.h"
#include "bench/cli/shared.h"
#include "bench/common/duration.h"
#include "bench/common/json_text.h"
#include "bench/common/progress_line.h"
#include "bench/common/rivals.h"
#include "bench/common/run_guarded.h"
#include "bench/harness/run_context.h"
#include "bench/study/cast_study.h"
#include "bench/study/study_pairs.h"
#include "bench/study/verdict_sample.h"

namespace sixdof::cli {
namespace {

using bench::QueryKind;

/// Enough that two late ones are less than 0.1 %.
constexpr std::size_t k_queries = 2100;
constexpr unsigned k_most_threads = 64;

constexpr const char* k_details =
    R"(Asks every algorithm the same poses of the pair: apart, near contact (0.01 to 0.3 % of the smaller box's
diagonal, apart and pushed in) and overlapping; and motions from contact. Answers are compared with those of exact.
Then every query is timed alone, once, as it comes: the deadline is kept if at most 0.1 % of the queries are late. Beside
them stands how many waits of a loop that asks nothing were late on this machine; nothing is subtracted.

An algorithm that gives one wrong yes/no or contact is unsafe and is not taken. Right answers come before
approximations. Of equally right algorithms the fastest is taken. Where too few poses could be judged, there is no verdict. "0 of 2,100
wrong" means that with 95 % confidence at most 3 of 2,100 are (rule of three).

Exit code 3 if nothing can be taken.

Keys of --json: pair, order, deadline_ns; questions[] {question, metric, judged, missing (why there is no verdict, or
null), candidates[] {standing, algorithm, settings, exact, METRIC, METRIC_low, METRIC_high, mean_ns, late, timed,
idle_late, reason}, again}.)";

/// Enough that one late motion is less than 0.1 %; their truths take milliseconds each.
constexpr std::size_t k_casts = 1050;

/// What can be asked, by Verdict::query, with the error that is to be small where the user names none.
struct Question {
  const char *query, *metric;
};
constexpr Question k_questions[]{
    {"collide", "mismatch"}, {"distance", "error_max"}, {"respond", "gamma_F_deg"}, {results::k_cast, "early_max"}};

/// Of a query that asks poses.
QueryKind kind_of(const std::string& query) {
  return *std::ranges::find_if(bench::k_query_kinds, [&](QueryKind kind) { return to_string(kind) == query; });
}

bool answers_query(const Traits& traits, const std::string& query) {
  return query == results::k_cast ? traits.answers.cast : bench::answers(traits.answers, kind_of(query));
}

/// The question that has the metric among its errors. @throws BadArgument, which lists them
std::string question_of(const std::string& metric) {
  std::vector<std::string> known;
  for (const QueryKind question : {QueryKind::respond, QueryKind::distance, QueryKind::collide}) {
    const std::vector<std::string> metrics = study::error_metrics(question);
    if (std::ranges::find(metrics, metric) != metrics.end()) return std::string(to_string(question));
    known.insert(known.end(), metrics.begin(), metrics.end() - 1);  // all end with "failed"
  }
  const std::vector<std::string> of_casts = study::cast_error_metrics();
  if (std::ranges::find(of_casts, metric) != of_casts.end()) return results::k_cast;
  known.insert(known.end(), of_casts.begin(), of_casts.end() - 1);
  require_metric("--metric", metric, known);
  return "respond";
}

/// What is asked, with the error of each. @throws BadArgument for a metric of another question
std::vector<std::pair<std::string, std::string>> asked(const RecommendOptions& options) {
  if (!options.metric.empty()) {
    const std::string question = question_of(options.metric);
    if (options.question != "all" && options.question != words_of(question)) {
      throw BadArgument(fmt::format("--metric {}: is an error of {}, not of {}", options.metric, words_of(question),
                                    options.question));
    }
    return {{question, options.metric}};
  }
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto& [query, metric] : k_questions) {
    if (options.question == "all" || options.question == words_of(query)) all.emplace_back(query, metric);
  }
  return all;
}

/// `exact` and FCL first, so that no budget leaves them out.
std::vector<const Algorithm*> in_order(std::vector<const Algorithm*> algorithms) {
  const auto place = [](const Algorithm* algorithm) {
    const std::string& name = algorithm->traits().name;
    return name == "exact" ? 0 : name.starts_with("fcl-") ? 1 : 2;
  };
  std::ranges::stable_sort(algorithms, {}, place);
  return algorithms;
}

/// The defaults of swept parameters, for algorithms that promise right answers: their sweeps only loosen the promise.
std::vector<study::SweptValues> exact_settings(const std::vector<const Algorithm*>& algorithms,
                                               const std::vector<study::SweptValues>& values) {
  std::vector<study::SweptValues> fixed;
  for (const Algorithm* const algorithm : algorithms) {
    const Traits& traits = algorithm->traits();
    const bool chosen = std::ranges::any_of(values, [&](const auto& each) { return each.algorithm == traits.name; });
    if (traits.approximates || chosen) continue;
    for (const Parameter& parameter : traits.parameters) {
      if (!parameter.sweep.empty()) fixed.push_back({traits.name, parameter.name, {parameter.default_value}});
    }
  }
  return fixed;
}

/// That nothing which was measured can be taken says nothing of what did not fit into the budget.
std::string unmeasured(const results::Choice& choice) {
  const auto count = std::ranges::count_if(choice.candidates, [](const results::Candidate& each) {
    return each.standing == results::Standing::left_out && each.reason.find("budget") != std::string::npos;
  });
  if (choice.taken() != nullptr) return {};
  if (std::ranges::any_of(choice.candidates, [](const results::Candidate& each) {
        return each.interpreted && each.standing == results::Standing::not_ranked;
      })) {
    return "those that keep the deadline are interpreted, and not ranked";
  }
  if (count == 0) return {};
  return fmt::format("nothing that was measured can be taken, and {} of {} settings did not fit into the budget", count,
                     choice.candidates.size());
}

/// The pair's set has no poses for a question.
class NoSample : public BadArgument {
 public:
  using BadArgument::BadArgument;
};

/// One pair with its algorithms, asked one question after the other.
class Recommendation {
 public:
  explicit Recommendation(const RecommendOptions& options)
      : options_(options),
        budget_s_(parse_duration("--budget", options.study.budget)),
        deadline_s_(parse_duration("--deadline", options.deadline)),
        questions_(asked(options)) {
    register_all_algorithms(registry_, options.study.process);
    if (options.study.pairs.size() + options.study.sets.size() > 1) throw BadArgument("one pair at a time");
    pairs_ = std::make_unique<study::StudyPairs>(harness_options(options.study, k_queries, arguments()),
                                                 options.study.pairs);
    context_ = bench::run_context(pairs_->options(), registry_, bench::parse_parameters({}, registry_));
  }

  std::vector<Verdict> run() {
    std::vector<Verdict> verdicts;
    for (std::size_t i = 0; i < questions_.size(); ++i) {
      const double share_s = left_s() / static_cast<double>(questions_.size() - i);
      verdicts.push_back(verdict_on(questions_[i].first, questions_[i].second, share_s));
      rows_.insert(rows_.end(), verdicts.back().rows.begin(), verdicts.back().rows.end());
    }
    write(rows_, false);
    return verdicts;
  }

  const CatalogueEntry& pair() const { return *pairs_->pairs().front(); }
  double deadline_s() const { return deadline_s_; }

 private:
  std::string arguments() const {
    return arguments_of("recommend", options_.study) +
           fmt::format(" --question {} --deadline {} {}--order {} --threads {}", options_.question, options_.deadline,
                       options_.metric.empty() ? "" : "--metric " + options_.metric + " ", options_.order,
                       options_.threads);
  }

  double left_s() const {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
    return budget_s_ - spent.count();
  }

  /// Why the pair cannot be asked, whatever the algorithm; empty if it can.
  std::string why_impossible(const std::string& query) {
    if (query != "respond") return {};
    for (const std::string& key : {pair().a, pair().b}) {
      const Mesh& mesh = pairs_->cache().mesh(key);
      if (mesh.solid()) continue;
      return fmt::format("forces need solid bodies; {}: {}{}", mesh.name(), mesh.why_not_solid(), k_repair_hint);
    }
    if (std::ranges::any_of(pair().buckets, [&](BucketKey key) { return bench::suits(key, QueryKind::respond); }))
      return {};
    std::string why = "there are no poses of known overlap volume, which forces need";
    if (!options_.study.sets.empty()) why += " (sixdof generate --volumes makes some)";
    return why;
  }

  /// Those of --algorithms that answer the question; where a single question is asked, all of them.
  std::vector<std::string> names_that_answer(const std::string& query) const {
    if (questions_.size() == 1) return options_.study.algorithms;
    std::vector<std::string> names = with_rivals(options_.study.algorithms, registry_);
    std::erase_if(names, [&](const std::string& name) {
      const Traits& traits = registry_.find(name).traits();
      const bool is_of_hulls = traits.is_rival() && traits.body != Body::mesh;
      return is_of_hulls || !answers_query(traits, query);
    });
    return names;
  }

  /// Whether --params of an algorithm concern a question; those of one that does not answer it do not.
  bool concerns(const std::string& params, const std::string& query) const {
    const std::string name = study::parse_swept_values(params).algorithm;
    return questions_.size() == 1 || answers_query(registry_.find(name).traits(), query);
  }

  /// The values of swept parameters of the algorithms, but for those of --order and --threads.
  std::vector<study::SweptValues> values_of(const std::string& query, const std::vector<const Algorithm*>& algorithms) {
    StudyOptions study = options_.study;
    std::erase_if(study.values, [&](const std::string& text) { return !concerns(text, query); });
    std::vector<study::SweptValues> values = swept_values(study, algorithms);
    std::ranges::move(exact_settings(algorithms, values), std::back_inserter(values));
    return values;
  }

  study::PrecisionPlan plan_of(const std::string& query, const std::string& metric, double budget_s) {
    const QueryKind question = kind_of(query);
    study::PrecisionPlan plan{.question = question, .error = metric};
    plan.cost = "p99_least_ns";
    plan.seed = options_.study.seed;
    plan.single_queries = true;
    plan.deadline_ns = 1e9 * deadline_s_;
    plan.rounds = 1;
    plan.most_rounds = 1;
    plan.budget_s = budget_s;
    plan.algorithms = in_order(study_algorithms(registry_, names_that_answer(query), question));
    plan.values = values_of(query, plan.algorithms);
    if (options_.in_motion()) {
      std::ranges::move(study::warm_starts(plan.algorithms, plan.values), std::back_inserter(plan.values));
    }
    std::ranges::move(study::thread_counts(plan.algorithms, plan.values, options_.threads),
                      std::back_inserter(plan.values));
    return plan;
  }

  Verdict verdict_on(const std::string& query, const std::string& metric, double share_s) {
    const auto begun = std::chrono::steady_clock::now();
    Verdict verdict{.query = query, .metric = metric};
    verdict.choice.missing = why_impossible(query);
    if (!options_.study.algorithms.empty() && names_that_answer(query).empty()) {
      verdict.choice.missing = "none of the chosen algorithms answers it";
    }
    if (!verdict.choice.missing.empty()) return verdict;
    const auto left_s = [&] {
      return share_s - std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    };
    try {
      query == results::k_cast ? measure_casts(verdict, left_s) : measure_poses(verdict, left_s);
    } catch (const BadMesh& e) {
      verdict.choice.missing = e.what();
      return verdict;
    } catch (const NoSample& e) {
      verdict.choice.missing = e.what();
      return verdict;
    }
    verdict.choice = results::choose(verdict.rows, query, metric);
    if (verdict.choice.missing.empty()) verdict.choice.missing = unmeasured(verdict.choice);
    return verdict;
  }

  /// Wraps what draw() throws where a set has no poses for a question.
  template <class Draw>
  static auto sample_of(const Draw& draw) {
    try {
      return draw();
    } catch (const BadArgument& e) {
      throw NoSample(e.what());
    }
  }

  /// So far, with those of the questions before.
  void write_with(std::vector<results::Row> rows) {
    std::vector<results::Row> so_far = rows_;
    std::ranges::move(rows, std::back_inserter(so_far));
    write(so_far, true);
  }

  template <class Left>
  void measure_casts(Verdict& verdict, const Left& left_s) {
    StatusLine status;
    status.show("cast: truth");
    const study::CastSample sample =
        sample_of([&] { return study::draw_cast_sample(pairs_->cache(), pair(), k_casts, options_.study.seed); });
    verdict.poses = study::motions_text(sample);
    const std::vector<const Algorithm*> algorithms = in_order(casting_algorithms());
    const study::CastPlan plan{.algorithms = algorithms,
                               .values = values_of(verdict.query, algorithms),
                               .deadline_ns = 1e9 * deadline_s_,
                               .budget_s = left_s()};
    const std::vector<study::CastPoint> points = study::measure_casts(
        plan, pairs_->cache(), pair(), sample,
        [&](const std::string& what, std::size_t done, std::size_t total) {
          status.show(fmt::format("cast: {}, {} of {} settings", what, done, total));
        },
        [&](const std::vector<study::CastPoint>& done) { write_with(rows_of(done)); });
    status.clear();
    verdict.rows = rows_of(points);
    for (const study::CastPoint& point : points) verdict.assignments.push_back(point.sweep.assignments);
  }

  static std::vector<results::Row> rows_of(const std::vector<study::CastPoint>& points) {
    std::vector<results::Row> rows;
    for (const study::CastPoint& point : points) rows.push_back(point.row);
    return rows;
  }

  /// Those of --algorithms that answer casts, or all about meshes but `null` and rivals: none of them is slow.
  std::vector<const Algorithm*> casting_algorithms() const {
    std::vector<const Algorithm*> chosen;
    if (!options_.study.algorithms.empty()) {
      for (const std::string& name : with_rivals(names_that_answer(results::k_cast), registry_)) {
        const Algorithm& algorithm = registry_.find(name);
        if (!algorithm.traits().answers.cast) throw BadArgument(name + " does not answer cast");
        if (algorithm.traits().body != Body::mesh) throw BadArgument(name + " does not answer for the meshes");
        if (std::ranges::find(chosen, &algorithm) == chosen.end()) chosen.push_back(&algorithm);
      }
      return chosen;
    }
    for (const auto& algorithm : registry_.all()) {
      const Traits& traits = algorithm->traits();
      const bool suits = traits.answers.cast && traits.body == Body::mesh && traits.timed && !traits.is_rival();
      if (suits && traits.name != "null") chosen.push_back(algorithm.get());
    }
    return chosen;
  }

  template <class Left>
  void measure_poses(Verdict& verdict, const Left& left_s) {
    const QueryKind question = kind_of(verdict.query);
    StatusLine status;
    status.show(fmt::format("{}: truth", words_of(verdict.query)));
    study::StudySample sample =
        sample_of([&] { return study::draw_verdict_sample(pairs_->cache(), pair(), question, k_queries); });
    if (options_.in_motion()) {
      sample.motions = study::draw_motions(sample, pairs_->cache().mesh(pair().a), pairs_->cache().mesh(pair().b),
                                           options_.study.seed);
    }
    verdict.poses = study::poses_text(sample);
    study::PrecisionStudy study(plan_of(verdict.query, verdict.metric, left_s()), pairs_->cache(), pair(), sample);
    study.run(
        [&](const std::string& what, std::size_t done, std::size_t total) {
          status.show(fmt::format("{}: {}, {} of {} settings", words_of(verdict.query), what, done, total));
        },
        [&] { write_with(study.rows()); });
    status.clear();
    verdict.rows = study.rows();
    for (const study::PrecisionPoint& point : study.points()) verdict.assignments.push_back(point.sweep.assignments);
  }

  void write(const std::vector<results::Row>& rows, bool interrupted) {
    if (options_.study.output.empty()) return;
    auto context = context_;
    for (const auto& [key, hash] : pairs_->cache().hashes()) context[key] = hash;
    if (interrupted) context["interrupted"] = "true";
    results::write_rows(options_.study.output, context, rows);
  }

  const RecommendOptions& options_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const double budget_s_, deadline_s_;
  const std::vector<std::pair<std::string, std::string>> questions_;
  Registry registry_;
  std::unique_ptr<study::StudyPairs> pairs_;
  decltype(bench::run_context(std::declval<bench::Options>(), registry_, {})) context_;
  std::vector<results::Row> rows_;
};

void run(const RecommendOptions& options) {
  Recommendation recommendation(options);
  const std::vector<Verdict> verdicts = recommendation.run();
  if (options.study.json) {
    print_json(options, recommendation.deadline_s(), recommendation.pair(), verdicts);
  } else {
    print_text(options, recommendation.deadline_s(), recommendation.pair(), verdicts);
  }
  if (std::ranges::none_of(verdicts, [](const Verdict& verdict) { return verdict.choice.taken() != nullptr; })) {
    throw DefectsFound(fmt::format("no algorithm can be taken for a deadline of {}", options.deadline));
  }
}

}  // namespace

void add_recommend_command(CLI::App& app) {
  auto* const command = app.add_subcommand(
      "recommend", "Say which algorithm, with which parameters, keeps a deadline with right answers");
  const auto options = std::make_shared<RecommendOptions>();
  add_study_options(*command, options->study);
  command->add_option("--deadline", options->deadline, "Longest time of a query: 1ms, 200us")
      ->type_name("TIME")
      ->capture_default_str();
  command
      ->add_option("--question", options->question,
                   "What is asked: yes-no (do the bodies touch?), distance, respond (force and torque), cast (first "
                   "contact), or all")
      ->check(CLI::IsMember({"yes-no", "distance", "respond", "cast", "all"}))
      ->type_name("QUESTION")
      ->capture_default_str();
  command
      ->add_option("--metric", options->metric,
                   "Error to minimise instead of the usual one of its question: gamma_F_deg (mean angle of the force, "
                   "degrees), magnitude_error_F, error_rms (distance, diagonals of A), ...")
      ->type_name("METRIC");
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
      "sixdof recommend --a cone-1k --b torus-1k --order motion --question distance --algorithms exact,fcl-rss",
      k_details);
}

}  // namespace sixdof::cli
