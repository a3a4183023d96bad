#include "bench/cli/commands.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <sixdof/base/own_command.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/models/model_catalogue.h>
#include "bench/cli/scene.h"
#include "bench/cli/shared.h"
#include "bench/common/help_format.h"
#include "bench/common/interrupt.h"
#include "bench/common/program_end.h"
#include "bench/common/run_guarded.h"
#include "bench/common/serve_algorithm.h"
#include "bench/common/unknown_word.h"

namespace sixdof::cli {
namespace {

constexpr const char* k_first_query = "sixdof query --a cone-1k --b torus-1k --pose '0.9 0 0.1 1 0 0 0'";

constexpr const char* k_first_steps =
    R"({0}: no command given. To begin with:
  {0} models list       the models that every command takes by name, besides mesh files
  {1}
                           distance, overlap and force of two bodies at one pose
  {0} generate --help   how to make a configuration set, which {2} runs on
  {0} --help            all commands
)";

/// "sixdof models make".
std::string full_name(const CLI::App& command) {
  const std::string name = command.get_name();
  return command.get_parent() == nullptr ? name : full_name(*command.get_parent()) + " " + name;
}

/// The command that the command line names, as far as it was understood.
const CLI::App& parsed_command(const CLI::App& app) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  return parsed.empty() ? app : parsed_command(*parsed.back());
}

/// The first word that a command does not know, with that command.
struct UnknownWord {
  const CLI::App& command;
  std::string word;
};

std::optional<UnknownWord> find_unknown_word(const CLI::App& app) {
  if (const std::vector<std::string> words = app.remaining(); !words.empty()) return UnknownWord{app, words.front()};
  for (const CLI::App* command : app.get_subcommands()) {
    if (const auto found = find_unknown_word(*command)) return found;
  }
  return std::nullopt;
}

/// The commands below `app` that have an option of this name.
void find_owners(const CLI::App& app, const std::string& option, std::vector<std::string>& owners) {
  const std::vector<const CLI::Option*> options = app.get_options();
  const auto has_name = [&](const CLI::Option* each) { return each->check_lname(option); };
  if (std::ranges::any_of(options, has_name)) owners.push_back(full_name(app));
  for (const CLI::App* command : app.get_subcommands({})) find_owners(*command, option, owners);
}

/// "--grid: sixdof info has no such option; it is one of sixdof generate"; empty if no command has the option.
std::string explain_foreign_option(const CLI::App& app, const UnknownWord& unknown) {
  std::vector<std::string> owners;
  const std::string option = unknown.word.substr(0, unknown.word.find('='));
  if (option.starts_with("--")) find_owners(app, option.substr(2), owners);
  if (owners.empty()) return {};
  return fmt::format("{}: {} has no such option; it is one of {} ({} --help)", option, full_name(unknown.command),
                     fmt::join(owners, ", "), full_name(unknown.command));
}

/// "--gird: no such option; did you mean --grid?"
std::string explain(const CLI::App& app, const UnknownWord& unknown) {
  const auto& [command, word] = unknown;
  const std::string name = full_name(command);
  const bool is_option = word.starts_with('-');
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (is_option) std::ranges::copy(option->get_lnames(), std::back_inserter(names));
  }
  for (const CLI::App* each : command.get_subcommands({})) {
    if (!is_option) names.push_back(each->get_name());
  }
  if (!is_option && names.empty()) return fmt::format("{}: unexpected argument ({} --help)", word, name);
  if (!is_option && word == "help") return fmt::format("help: no such command; did you mean {} --help?", name);
  if (!is_option && names_file(word)) {
    return fmt::format("{0}: no such command ({1} --help lists them); sixdof info {0} says what is in a file",
                       shell_quoted(word), name);
  }
  const std::string text = explain_unknown_word(word, names, name + " --help");
  if (text.find("did you mean") != std::string::npos) return text;
  const std::string foreign = explain_foreign_option(app, unknown);
  return foreign.empty() ? text : foreign;
}

/// Commands that a person looks for in one place.
struct Group {
  const char* title;
  std::vector<void (*)(CLI::App&)> commands;
};

const std::vector<Group>& groups() {
  static const std::vector<Group> list{
      {"Meshes", {add_models_command, add_info_command, add_repair_command, add_show_command}},
      {"Ask (two bodies at one pose)", {add_query_command, add_algorithms_command}},
      {"Sets (thousands of poses of a pair, which sixdof-bench asks)",
       {add_generate_command, add_merge_command, add_verify_command, add_agree_command, add_survey_command}},
      {"Results (of sixdof-bench)",
       {add_table_command, add_report_command, add_history_command, add_compare_command, add_gate_command}},
      {"Studies (many measurements, one answer)",
       {add_recommend_command, add_precision_command, add_equivalent_command, add_quality_command, add_stress_command,
        add_hulls_command}},
      {"Scenes (many bodies that move)", {add_scene_command}},
      {"Your own", {add_new_algorithm_command, add_conform_command, add_completion_command}}};
  return list;
}

void add_commands(CLI::App& app) {
  for (const Group& group : groups()) {
    for (const auto add : group.commands) {
      add(app);
      app.get_subcommands({}).back()->group(group.title);
    }
  }
}

}  // namespace

int run(int argc, const char* const* argv) {
  if (const auto code = serve_if_asked(argc, argv)) return *code;
  if (const auto code = run_stress_cell_if_asked(argc, argv)) return *code;
  const std::string program = own_command("sixdof");
  if (argc < 2) {
    fmt::print(stderr, k_first_steps, program, own_command(k_first_query), own_bench_program());
    return k_exit_usage;
  }
  CLI::App app(
      "Measures the speed and the errors of collision queries on rigid bodies: whether two meshes collide, how far "
      "apart they are, and the force that separates them.",
      program);
  app.formatter(std::make_shared<HelpFormat>());
  app.set_version_flag("--version", std::string("sixdof ") + SIXDOF_VERSION);
  app.require_subcommand(1);
  add_commands(app);
  add_examples(app, "sixdof models list", k_first_query);
  const InterruptGuard interruptible("sixdof");
  try {
    const int code = run_guarded("sixdof", [&] { app.parse(argc, argv); });
    print_cache_refusal("sixdof");
    return code;
  } catch (const CLI::Success& e) {
    const int code = app.exit(e);  // help or version
    return code != 0 ? code : end_output("sixdof");
  } catch (const CLI::ParseError& e) {
    if (const auto unknown = find_unknown_word(app)) {
      print_message(full_name(unknown->command), explain(app, *unknown));
    } else {
      const std::string name = full_name(parsed_command(app));
      print_message(name, fmt::format("{} ({} --help)", e.what(), name));
    }
    return k_exit_usage;
  }
}

}  // namespace sixdof::cli
