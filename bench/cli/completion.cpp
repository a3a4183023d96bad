#include "bench/common/completion.h"

#include <memory>
#include <string>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/configuration/set_catalogue.h>
#include <sixdof/conformance/checks.h>
#include <sixdof/measure/metrics.h>
#include <sixdof/stability/families.h>
#include "bench/cli/commands.h"
#include "bench/cli/shared.h"
#include "bench/common/rivals.h"
#include "bench/common/scene_algorithms.h"
#include "bench/harness/options.h"

namespace sixdof::cli {
namespace {

ValueTable values() {
  ValueTable table = common_values();
  const auto add = [&](const char* value, const std::string& word) { table[value].words.push_back(word); };
  Registry registry;
  register_all_algorithms(registry);
  for (const auto& algorithm : registry.all()) add("ALGORITHM", algorithm->traits().name);
  if (!rival_names(registry).empty()) add("ALGORITHM", k_rivals);
  for (const auto& algorithm : all_scene_algorithms()) add("PAIR-FINDER", algorithm->traits().name);
  for (const Metric& metric : metrics()) {
    if (metric.name.find('*') == std::string_view::npos) add("METRIC", std::string(metric.name));
  }
  for (const stability::Family& family : stability::families()) add("FAMILY", std::string(family.name));
  for (const conformance::Check& check : conformance::all_checks()) add("CHECK", check.name);
  try {
    const SetCatalogue catalogue = SetCatalogue::read(bench::default_manifest());
    for (const CatalogueEntry& set : catalogue.sets()) add("PAIR", set.pair);
  } catch (const BadFile&) {
    // Without the committed sets there is no pair to name.
  }
  return table;
}

}  // namespace

void add_completion_command(CLI::App& app) {
  auto* const command =
      app.add_subcommand("completion", "Print a script that lets a shell complete commands and options");
  const auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "The shell")->required()->type_name("SHELL")->check(CLI::IsMember({"bash"}));
  command->callback([&app] { fmt::print("{}", bash_completion(app, app.get_name(), values())); });
  add_examples(
      *command, "sixdof completion bash > sixdof.bash",
      "mkdir -p completions && sixdof completion bash > completions/sixdof",
      "In bash: source sixdof.bash. It completes commands, options, their choices, elements of lists, files, and "
      "names of algorithms, models, metrics and pairs. An installation has this script and that of sixdof-bench "
      "in share/bash-completion/completions, where the package bash-completion finds them.");
}

}  // namespace sixdof::cli
