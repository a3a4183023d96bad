#include <algorithm>
#include <cmath>
#include <iterator>
#include <list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/own_command.h>
#include <sixdof/results/results.h>
#include "bench/cli/commands.h"
#include "bench/cli/precision_table.h"
#include "bench/cli/shared.h"
#include "bench/cli/study_options.h"
#include "bench/common/duration.h"
#include "bench/common/json_text.h"
#include "bench/common/study_progress.h"
#include "bench/harness/run_context.h"
#include "bench/study/precision.h"
#include "bench/study/study_pairs.h"
#include "bench/study/sweep.h"

namespace sixdof::cli {
namespace {

using bench::QueryKind;

struct Options {
  StudyOptions study;
  std::string question = "respond";
  std::string metric;
  std::string cost = "cpu_time";
  std::size_t sample = 256;
  bool markdown = false;
};

/// Work of a round of timing, of which the measurement of all points is 1.
constexpr double k_round_work = 0.25;

/// A point takes about twice as long as the coarser one before it. @param finished only those that have ended
double work_of(std::span<const study::PrecisionPoint> points, bool finished) {
  double work = 0.0, next = 1.0;
  const Algorithm* before = nullptr;
  for (const study::PrecisionPoint& point : points) {
    next = point.algorithm == before ? 2.0 * next : 1.0;
    before = point.algorithm;
    if (!finished || point.measured() || !point.left_out.empty()) work += next;
  }
  return work;
}

/// Lines about one pair.
class PairProgress {
 public:
  PairProgress(const study::PrecisionStudy& study, StudyProgress& progress) : study_(study), progress_(progress) {}

  /// A point, or a round of timing over all of them, has ended. Further rounds have no number that is known before.
  void step() {
    ++steps_;
    const std::size_t points = study_.points().size(), rounds = steps_ > points ? steps_ - points : 0;
    if (rounds >= study_.plan().rounds) return;
    const double done =
        work_of(study_.points(), true) + k_round_work * static_cast<double>(rounds) * work_of(study_.points(), false);
    const std::string part =
        rounds == 0 ? fmt::format("{} of {} points", steps_, points) : fmt::format("round {} of timing", rounds + 1);
    progress_.finished(fmt::format("{}: {}", study_.pair().pair, part), done - told_);
    told_ = done;
  }

  void end() {
    for (const study::PrecisionPoint& point : study_.points()) {
      if (point.left_out.empty()) continue;
      progress_.leave_out(fmt::format("{}: {} {}", study_.pair().pair, point.algorithm->traits().name,
                                      fmt::join(point.sweep.assignments, " ")),
                          point.left_out);
    }
  }

 private:
  const study::PrecisionStudy& study_;
  StudyProgress& progress_;
  std::size_t steps_ = 0;
  double told_ = 0.0;  ///< Work.
};

/// The studies of all pairs, and the file that they fill.
class PrecisionCommand {
 public:
  explicit PrecisionCommand(const Options& options) : options_(options) {
    register_all_algorithms(registry_, options.study.process);
  }

  void run() {
    plan_.question = parse_question();
    plan_.error = options_.metric.empty() ? study::error_metrics(plan_.question).front() : options_.metric;
    plan_.cost = options_.cost;
    require_metric("--metric", plan_.error, study::error_metrics(plan_.question));
    require_metric("--cost", plan_.cost, study::cost_metrics());
    plan_.single_queries = plan_.cost != "cpu_time" && plan_.cost != "real_time";
    plan_.seed = options_.study.seed;
    plan_.algorithms = study_algorithms(registry_, options_.study.algorithms, plan_.question);
    plan_.values = swept_values(options_.study, plan_.algorithms);
    StudyProgress progress(own_command("sixdof precision"), parse_duration("--budget", options_.study.budget));
    study::StudyPairs pairs(harness_options(options_.study, options_.sample, arguments()), options_.study.pairs);
    context_ = bench::run_context(pairs.options(), registry_, bench::parse_parameters({}, registry_));
    begin(pairs.pairs().size(), progress);
    for (std::size_t i = 0; i < pairs.pairs().size(); ++i) {
      measure(pairs, *pairs.pairs()[i], progress, pairs.pairs().size() - i);
    }
    finish();
    progress.end();
  }

 private:
  std::string arguments() const {
    return arguments_of("precision", options_.study) + fmt::format(" --question {} --metric {} --cost {} --sample {}",
                                                                   options_.question, plan_.error, plan_.cost,
                                                                   options_.sample);
  }

  QueryKind parse_question() const {
    for (const QueryKind question : bench::k_query_kinds) {
      if (to_string(question) == options_.question) return question;
    }
    throw BadArgument(fmt::format("--question {}: must be collide, distance or respond", options_.question));
  }

  /// Counts the work before any of it is measured.
  void begin(std::size_t pairs, StudyProgress& progress) const {
    std::size_t points = 0;
    double work = 0.0;
    for (const Algorithm* const algorithm : plan_.algorithms) {
      const std::size_t sweep = study::sweep_points(*algorithm, plan_.values).size();
      points += sweep;
      work += std::exp2(static_cast<double>(sweep)) - 1.0;
    }
    const double rounds = 1.0 + k_round_work * static_cast<double>(plan_.rounds - 1);
    progress.begin(fmt::format("pairs: {}, algorithms: {}, points of each pair: {}, poses: {} at most", pairs,
                               plan_.algorithms.size(), points, options_.sample),
                   rounds * work * static_cast<double>(pairs));
  }

  /// @param pairs_left which share the time that is left, this one included
  void measure(study::StudyPairs& pairs, const CatalogueEntry& pair, StudyProgress& progress, std::size_t pairs_left) {
    const double until_s = progress.left_s() * (1.0 - 1.0 / static_cast<double>(pairs_left));
    plan_.budget_s = progress.left_s() - until_s;
    progress.status(fmt::format("{}: truth of {} configurations", pair.pair, options_.sample));
    samples_.push_back(study::draw_affordable_sample(plan_, pairs.cache(), pair, options_.sample));
    plan_.budget_s = progress.left_s() - until_s;
    study::PrecisionStudy& study = studies_.emplace_back(plan_, pairs.cache(), pair, samples_.back());
    PairProgress lines(study, progress);
    study.run(
        [&](const std::string& what, std::size_t done, std::size_t total) {
          progress.status(fmt::format("{}: {}, {} of {} points", pair.pair, what, done, total));
        },
        [&] {
          for (const auto& [key, hash] : pairs.cache().hashes()) context_[key] = hash;
          write(true);
          lines.step();
        });
    lines.end();
    write(true);
  }

  std::vector<results::Row> rows() const {
    std::vector<results::Row> all;
    for (const study::PrecisionStudy& study : studies_) std::ranges::move(study.rows(), std::back_inserter(all));
    return all;
  }

  /// Until the study ends, the file says that it is not whole.
  void write(bool interrupted) const {
    if (options_.study.output.empty()) return;
    auto context = context_;
    if (interrupted) context["interrupted"] = "true";
    results::write_rows(options_.study.output, context, rows());
  }

  void finish() const {
    write(false);
    if (options_.study.json) {
      fmt::print("{}\n", json_text(results::document_of(context_, rows())));
      return;
    }
    for (const study::PrecisionStudy& study : studies_) {
      const Sheet sheet = precision_sheet(study);
      fmt::print("{}\n", options_.markdown ? as_markdown(sheet) : as_text(sheet));
    }
    std::vector<const study::PrecisionStudy*> all;
    for (const study::PrecisionStudy& study : studies_) all.push_back(&study);
    for (const std::string& text : gain_spreads(all)) fmt::print("{}\n", text);
  }

  const Options& options_;
  Registry registry_;
  study::PrecisionPlan plan_;
  nlohmann::ordered_json context_;
  std::list<study::StudySample> samples_;     ///< Of studies_.
  std::list<study::PrecisionStudy> studies_;  ///< In the order of the pairs.
};

}  // namespace

void add_precision_command(CLI::App& app) {
  auto* const command =
      app.add_subcommand("precision", "Measure run time against error: every algorithm at every resolution");
  const auto options = std::make_shared<Options>();
  add_study_options(*command, options->study);
  command->add_option("--question", options->question, "What is asked of the algorithms")
      ->type_name("QUESTION")
      ->check(words_of({"collide", "distance", "respond"}))
      ->capture_default_str();
  command->add_option("--metric", options->metric, "Error of the frontier, any metric of the rows")
      ->type_name("METRIC")
      ->default_str("gamma_F_deg for respond, error_rms for distance, mismatch for collide");
  command
      ->add_option("--cost", options->cost, "Cost of the frontier: cpu_time, real_time, p99_ns, bytes, prepare_ns, ...")
      ->type_name("METRIC")
      ->capture_default_str();
  command
      ->add_option("--sample", options->sample,
                   "Poses of a pair, spread evenly over the buckets of its set; fewer if the budget is short")
      ->type_name("N")
      ->check(CLI::Range(std::size_t{8}, std::size_t{1'000'000}))
      ->capture_default_str();
  command->add_flag("--markdown", options->markdown, "Print tables as Markdown");
  command->callback([options] { PrecisionCommand(*options).run(); });
  add_examples(*command, "sixdof precision --a cone-1k --b torus-1k --algorithms vps,exact --sample 32 --budget 20s",
               "sixdof precision --a cone-1k --b torus-1k --question distance --params fcl-rss:relative_error=1,0.01,0 "
               "--algorithms fcl-rss,exact --sample 32 --budget 20s -o precision.json");
}

}  // namespace sixdof::cli
