#include "bench/cli/commands.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <sixdof/models/suggestions.h>

#include "bench/cli/algorithms.h"
#include "bench/cli/generate.h"
#include "bench/cli/info.h"
#include "bench/cli/merge.h"
#include "bench/cli/models.h"
#include "bench/cli/quality.h"
#include "bench/cli/query.h"
#include "bench/cli/show.h"
#include "bench/cli/table.h"
#include "bench/cli/verify.h"
#include "bench/common/examples.h"
#include "bench/common/run_guarded.h"

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

void add_commands(CLI::App& app) {
  add_models_command(app);
  add_info_command(app);
  add_algorithms_command(app);
  add_query_command(app);
  add_show_command(app);
  add_quality_command(app);
  add_generate_command(app);
  add_merge_command(app);
  add_verify_command(app);
  add_table_command(app);
  add_examples(app, "sixdof models list", k_first_query);
}

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

/// The one of `names` that `word` probably means; empty if none is similar.
std::string nearest(const std::string& word, const std::vector<std::string>& names) {
  if (const std::vector<std::string> near = suggestions(word, names); !near.empty()) return near.front();
  // Exchanged letters, which are too many edits for a short word.
  const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return std::is_permutation(word.begin(), word.end(), name.begin(), name.end());
  });
  return found == names.end() ? std::string() : *found;
}

/// "no such option; did you mean --grid?"
std::string no_such(const char* what, const std::string& word, const std::vector<std::string>& names,
                    const std::string& prefix, const std::string& command) {
  const std::string meant = nearest(word, names);
  if (meant.empty()) return fmt::format("no such {} ({} --help lists them)", what, command);
  return fmt::format("no such {}; did you mean {}{}?", what, prefix, meant);
}

std::string explain(const UnknownWord& unknown) {
  const auto& [command, word] = unknown;
  const std::string name = full_name(command);
  std::vector<std::string> names;
  if (word.starts_with('-')) {
    for (const CLI::Option* option : command.get_options()) {
      const auto& long_names = option->get_lnames();
      names.insert(names.end(), long_names.begin(), long_names.end());
    }
    const std::string option = word.substr(0, word.find('='));
    const std::string bare = option.substr(std::min(option.find_first_not_of('-'), option.size()));
    return fmt::format("{}: {}", option, no_such("option", bare, names, "--", name));
  }
  for (const CLI::App* each : command.get_subcommands({})) names.push_back(each->get_name());
  if (names.empty()) return fmt::format("{}: unexpected argument ({} --help)", word, name);
  return fmt::format("{}: {}", word, no_such("command", word, names, "", name));
}

}  // namespace

int run(int argc, const char* const* argv) {
  if (argc < 2) {
    fmt::print(stderr, k_first_steps, k_first_query);
    return k_exit_usage;
  }
  CLI::App app("sixdof: speed and correctness of collision queries in six degrees of freedom", "sixdof");
  app.set_version_flag("--version", std::string("sixdof ") + SIXDOF_VERSION);
  app.require_subcommand(1);
  add_commands(app);
  try {
    return run_guarded("sixdof", [&] { app.parse(argc, argv); });
  } catch (const CLI::Success& e) {
    return app.exit(e);  // help or version
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
