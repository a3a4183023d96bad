#include "bench/cli/commands.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/own_command.h>
#include <sixdof/stability/ray_algorithm.h>
#include "bench/cli/shared.h"
#include "bench/cli/study_options.h"
#include "bench/common/interrupt.h"
#include "bench/common/json_text.h"
#include "bench/common/rivals.h"
#include "bench/common/run_guarded.h"
#include "bench/common/study_progress.h"
#include "bench/study/stress_processes.h"
#include "bench/study/stress_text.h"
#include "bench/study/stress_worker.h"

namespace sixdof::cli {
namespace {

struct Options {
  std::vector<std::string> algorithms, families;
  std::string effort = "quick", output, cases = "stress-cases";
  std::uint64_t seed = 1;
  double timeout_s = 60.0, memory_gb = 4.0;
  std::vector<std::string> external, fail_on;
  bool at_defaults = false, json = false;
};

void add_generators(Registry& registry) {
  registry.add(std::make_unique<stability::RayAlgorithm>(stability::TargetKind::distance));
  registry.add(std::make_unique<stability::RayAlgorithm>(stability::TargetKind::volume));
}

std::set<std::string> own_algorithms() {
  Registry own;
  register_core_algorithms(own);
  add_generators(own);
  std::set<std::string> names;
  for (const auto& algorithm : own.all()) names.insert(algorithm->traits().name);
  return names;
}

study::StressPlan plan_of(const Options& options, const Registry& registry) {
  study::StressPlan plan{
      .algorithms = {},
      .families = {},
      .effort = options.effort == "full" ? study::StressEffort::full() : study::StressEffort::quick(),
      .at_defaults = options.at_defaults,
      .seed = options.seed,
      .timeout_s = options.timeout_s,
      .memory_bytes = 1e9 * options.memory_gb,
      .processes = std::max(1u, std::thread::hardware_concurrency()),
      .external = options.external};
  for (const std::string& name : with_rivals(options.algorithms, registry)) {
    plan.algorithms.push_back(&registry.find(name));
  }
  if (plan.algorithms.empty()) {
    for (const auto& algorithm : registry.all()) {
      const Traits& traits = algorithm->traits();
      // `null` answers with constants.
      if (traits.by_default && traits.body == Body::mesh && traits.name != "null") {
        plan.algorithms.push_back(algorithm.get());
      }
    }
  }
  for (const std::string& name : options.families) plan.families.push_back(&stability::find_family(name));
  if (plan.families.empty()) {
    for (const stability::Family& family : stability::families()) plan.families.push_back(&family);
  }
  return plan;
}

void print_red(const study::StressCell& cell, const study::StressLine& line) {
  fmt::print("\n{} on {}: {}: {} {} ({}{}{}; parameter {:.3g})\n  {}\n  {}\n", cell.name(), cell.family->name,
             line.verdict, line.metric, line.worst, line.member, line.thread.empty() ? "" : ", ", line.thread,
             line.parameter, line.words, line.reproduction);
}

void leave_out(const Options& options, const study::StressPlan& plan, const Registry& registry,
               StudyProgress& progress) {
  if (options.algorithms.empty()) leave_out_unasked(registry, plan.algorithms, progress);
  if (plan.at_defaults) return;
  for (const Algorithm* const algorithm : plan.algorithms) {
    if (!study::has_finer_defaults(*algorithm)) continue;
    progress.leave_out(algorithm->traits().name + " at defaults", "takes hours; asked with --at-defaults");
  }
}

void run_stress_command(const Options& options) {
  Registry registry;
  register_all_algorithms(registry, {.external = options.external});
  add_generators(registry);
  const study::StressPlan plan = plan_of(options, registry);
  for (const std::string& name : options.fail_on) {
    const Algorithm& algorithm = registry.find(name);
    if (std::ranges::find(plan.algorithms, &algorithm) == plan.algorithms.end()) {
      throw BadArgument(fmt::format("--fail-on {}: is not among the algorithms that are asked (--algorithms)", name));
    }
  }
  // Bodies are new for every seed: in the user's cache they would stay for good. Here they are shared by algorithms and
  // by the shots of a case.
  std::filesystem::create_directories(options.cases);
  ::setenv("SIXDOF_CACHE", (std::filesystem::path(options.cases) / "structures").c_str(), 0);
  StudyProgress progress(own_command("sixdof stress"));
  const std::size_t planned = study::cells_of(plan).size();
  progress.begin(fmt::format("families: {}, algorithms: {}, cells: {}, {} at a time", plan.families.size(),
                             plan.algorithms.size(), planned, plan.processes),
                 static_cast<double>(planned));
  const std::vector<study::StressCell> cells = study::run_stress(plan, [&](std::size_t done, std::size_t total) {
    InterruptGuard::check();
    progress.counted(done, total, "cells");
  });
  leave_out(options, plan, registry, progress);
  progress.end();

  const ProcessLimits limits{.query_s = plan.timeout_s,
                             .prepare_s = plan.timeout_s,
                             .memory_bytes = static_cast<std::size_t>(plan.memory_bytes)};
  std::vector<study::StressLine> lines;
  for (const study::StressCell& cell : cells) lines.push_back(study::stress_line(cell, options.cases, limits));
  const nlohmann::ordered_json json = study::stress_json(cells, lines, options.seed);
  if (!options.output.empty()) write_file_atomically(options.output, json_text(json) + "\n");
  std::set<std::string> own = own_algorithms();
  own.insert(options.fail_on.begin(), options.fail_on.end());
  std::string defects;
  if (options.json) fmt::print("{}\n", json_text(json));
  if (!options.json) fmt::print("{}", study::stress_matrix(cells));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!stability::is_red(cells[i].worst.verdict)) continue;
    if (!options.json) print_red(cells[i], lines[i]);
    if (own.contains(cells[i].algorithm->traits().name))
      defects += fmt::format("{}{} on {}", defects.empty() ? "" : ", ", cells[i].name(), cells[i].family->name);
  }
  if (!defects.empty()) throw DefectsFound("these fail: " + defects);
}

}  // namespace

std::optional<int> run_stress_cell_if_asked(int argc, const char* const* argv) {
  Registry registry;
  return study::run_stress_cell_if_asked(
      argc, argv, [&](const std::string& name, const std::vector<std::string>& external) -> const Algorithm& {
        register_all_algorithms(registry, {.external = external, .reuse = true});
        add_generators(registry);
        return registry.find(name);
      });
}

void add_stress_command(CLI::App& app) {
  auto* const command =
      app.add_subcommand("stress", "Ask algorithms hard cases with known answers, and show where each one fails");
  const auto options = std::make_shared<Options>();
  command
      ->add_option("--algorithms,--algorithm", options->algorithms,
                   "One or more; rivals: all set up; generate-distances, generate-volumes: generators of sets")
      ->type_name("ALGORITHM")
      ->default_str("all but null, slow ones and hulls")
      ->delimiter(',')
      ->allow_extra_args(false);
  std::string names = "Families:\n";
  for (const stability::Family& family : stability::families()) {
    names += help_entry(std::string(family.name), fmt::format("{} Sweep: {}.", family.sentence, family.parameter));
  }
  command->add_option("--families,--family", options->families, "Kinds of hard cases (below), one or more")
      ->type_name("FAMILY")
      ->default_str("all")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--effort", options->effort, "Number of cases, and of steps of the search for worse ones")
      ->type_name("EFFORT")
      ->check(CLI::IsMember({"quick", "full"}))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of the cases and searches")->type_name("N")->capture_default_str();
  command->add_option("--cases", options->cases, "Folder for the meshes and structures of the cases")
      ->type_name("FOLDER")
      ->capture_default_str();
  command->add_option("--query-timeout", options->timeout_s, "Limit of a query and of a preparation")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--memory-limit", options->memory_gb, "Memory of each process, in GB")
      ->type_name("GB")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("-o,--output", options->output,
                   "Write the result of each algorithm on each family to this file (JSON)")
      ->type_name("FILE");
  command
      ->add_option("--external", options->external,
                   "A program that answers the protocol (lib/sixdof/process/README.md)")
      ->type_name("NAME=COMMAND")
      ->allow_extra_args(false);
  command->add_option("--fail-on", options->fail_on, "Exit code 3 if one of these, which are asked, fails, too")
      ->type_name("ALGORITHM")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--at-defaults", options->at_defaults, "Also ask approximations at their defaults; takes hours");
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options] { run_stress_command(*options); });
  add_examples(*command, "sixdof stress --algorithms exact,fcl-obbrss --families kissing,grazing",
               "sixdof stress --algorithms exact --families scale --json -o stability.json", names);
}

}  // namespace sixdof::cli
