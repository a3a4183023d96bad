#include "bench/cli/commands.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "bench/cli/scene.h"
#include "bench/cli/shared.h"
#include "bench/common/interrupt.h"
#include "bench/common/program_end.h"
#include "bench/common/run_guarded.h"
#include "bench/common/serve_algorithm.h"
#include "bench/common/unknown_word.h"

namespace sixdof::cli {
namespace {

constexpr const char* k_first_query = "sixdof query --a cone-1k --b torus-1k --pose '0.9 0 0.1 1 0 0 0'";

constexpr const char* k_first_steps =
    R"(sixdof: no command given. To begin with:
  sixdof models list       the models that every command takes by name, besides mesh files
  {}
                           distance, overlap and force of two bodies at one pose
  sixdof generate --help   how to make a configuration set, which sixdof-bench runs on
  sixdof --help            all commands
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

/// "--gird: no such option; did you mean --grid?"
std::string explain(const UnknownWord& unknown) {
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
  return explain_unknown_word(word, names, name + " --help");
}

}  // namespace

int run(int argc, const char* const* argv) {
  if (const auto code = serve_if_asked(argc, argv)) return *code;
  if (const auto code = run_stress_cell_if_asked(argc, argv)) return *code;
  if (argc < 2) {
    fmt::print(stderr, k_first_steps, k_first_query);
    return k_exit_usage;
  }
  CLI::App app("sixdof: speed and correctness of collision queries in six degrees of freedom", "sixdof");
  app.set_version_flag("--version", std::string("sixdof ") + SIXDOF_VERSION);
  app.require_subcommand(1);
  for (const auto add :
       {add_models_command,     add_info_command,    add_repair_command,    add_algorithms_command,
        add_query_command,      add_show_command,    add_quality_command,   add_generate_command,
        add_merge_command,      add_verify_command,  add_agree_command,     add_table_command,
        add_report_command,     add_history_command, add_precision_command, add_recommend_command,
        add_equivalent_command, add_stress_command,  add_scene_command,     add_new_algorithm_command}) {
    add(app);
  }
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
      print_message(full_name(unknown->command), explain(*unknown));
    } else {
      const std::string name = full_name(parsed_command(app));
      print_message(name, fmt::format("{} ({} --help)", e.what(), name));
    }
    return k_exit_usage;
  }
}

}  // namespace sixdof::cli
