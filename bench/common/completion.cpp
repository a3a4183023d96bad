#include "bench/common/completion.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/models/manifest.h>
#include <sixdof/models/recipe.h>
#include "bench/common/help_format.h"

namespace sixdof {
namespace {

/// {0} is the program, {1} its name as a part of a function's. bash takes "=" for a word of its own.
constexpr std::string_view k_beginning =
    R"(# Completes {0} in bash. Made by the program itself from its commands and options; source it.
_{1}_value() {{
  case $1 in
)";

constexpr std::string_view k_middle = R"(  esac
}}

_{1}() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} option="" path={0} options="" commands="" argument="" i
  local words="" files="" folders="" list="" prefix="" assigned="" taken=""
  COMPREPLY=()
  if [[ $current == "=" ]]; then
    option=${{COMP_WORDS[COMP_CWORD - 1]}} current="" assigned=1
  elif ((COMP_CWORD > 1)) && [[ ${{COMP_WORDS[COMP_CWORD - 1]}} == "=" ]]; then
    option=${{COMP_WORDS[COMP_CWORD - 2]}} assigned=1
  elif [[ ${{COMP_WORDS[COMP_CWORD - 1]}} == -* ]]; then
    option=${{COMP_WORDS[COMP_CWORD - 1]}}
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$path ${{COMP_WORDS[i]}}" in
      {2}) path+=" ${{COMP_WORDS[i]}}" ;;
    esac
  done
  case $path in
)";

constexpr std::string_view k_end = R"(  esac
  if [[ ! $words$files$folders ]]; then
    [[ $taken ]] && return
    if [[ $current == -* ]]; then
      words=$options
    else
      words=$commands list=""
      eval "$argument"
    fi
  fi
  if [[ $list && $current == *,* ]]; then
    prefix=${{current%,*}},
    current=${{current##*,}}
  fi
  mapfile -t COMPREPLY < <(
    [[ $words ]] && compgen -P "$prefix" -W "$words" -- "$current"
    [[ $files ]] && compgen -f -- "${{current/#\~\//$HOME/}}"
    [[ $folders ]] && compgen -d -- "${{current/#\~\//$HOME/}}"
  )
  [[ $files$folders ]] && compopt -o filenames 2>/dev/null
  return 0
}}
complete -F _{1} {0}
)";

/// Counts with which recipes are offered; any other may be typed.
constexpr std::array<std::pair<std::size_t, const char*>, 3> k_counts{
    {{1000, "1k"}, {10'000, "10k"}, {100'000, "100k"}}};

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const auto recipes : {recipes(), recipe_variants()}) {
    for (const Recipe& recipe : recipes) {
      for (const auto& [count, text] : k_counts) {
        if (count >= recipe.minimum) names.push_back(fmt::format("{}-{}", recipe.name, text));
      }
    }
  }
  for (const FetchedModel& model : fetched_models()) names.push_back(model.name);
  for (const CollectionObject& object : collection()) names.push_back(object.name);
  std::ranges::sort(names);
  names.erase(std::ranges::unique(names).begin(), names.end());
  return names;
}

/// "words="a b"", "_sixdof_value MESH list=1": commands that set what completes a value; ":" if nothing does.
std::string commands_for(const CLI::Option& option, const ValueTable& values, const std::string& function) {
  const OptionValue value = value_of(option);
  std::string text;
  if (!value.choices.empty()) {
    text = fmt::format("words=\"{}\"", joined(value.choices));
  } else if (values.contains(value.name)) {
    text = fmt::format("_{}_value {}", function, value.name);
  } else {
    return ":";
  }
  return text + (option.get_delimiter() == '\0' ? "" : "; list=1");
}

class Script {
 public:
  Script(const std::string& program, const ValueTable& values) : program_(program), values_(values), name_(program) {
    std::ranges::replace(name_, '-', '_');
  }

  std::string write(const CLI::App& app, const std::vector<std::string>& more) {
    std::string kinds;
    for (const auto& [name, value] : values_) {
      kinds += fmt::format("    {}) words=\"{}\" files={} folders={} ;;\n", name, joined(value.words),
                           value.files ? "1" : "", value.folders ? "1" : "");
    }
    add_command(app, program_, more);
    return fmt::format(k_beginning, program_, name_) + kinds +
           fmt::format(k_middle, program_, name_, fmt::join(paths_, " | ")) + cases_ +
           fmt::format(k_end, program_, name_);
  }

 private:
  void add_command(const CLI::App& app, const std::string& path, const std::vector<std::string>& more) {
    std::vector<std::string> options = more, commands;
    std::string taken, argument = ":";
    for (const CLI::Option* option : app.get_options()) {
      if (option->get_positional()) {
        if (argument == ":") argument = commands_for(*option, values_, name_);
        continue;
      }
      if (option->get_group().empty()) continue;
      std::vector<std::string> names;
      for (const std::string& name : option->get_snames()) names.push_back("-" + name);
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
      options.push_back(names.back());
      if (value_of(*option).name.empty()) continue;
      // The value of a flag is optional, and follows "=".
      taken += fmt::format("        {}) {}{{ taken=1; {}; }} ;;\n", fmt::join(names, " | "),
                           !option->get_fnames().empty() ? "[[ $assigned ]] && " : "",
                           commands_for(*option, values_, name_));
    }
    for (const CLI::App* command : app.get_subcommands({})) {
      commands.push_back(command->get_name());
      paths_.push_back(fmt::format("\"{} {}\"", path, command->get_name()));
      add_command(*command, path + " " + command->get_name(), {});
    }
    cases_ += fmt::format(
        "    \"{}\")\n      options=\"{}\" commands=\"{}\" argument='{}'\n      case $option in\n{}      esac\n"
        "      ;;\n",
        path, joined(options), joined(commands), argument, taken);
  }

  std::string program_;
  const ValueTable& values_;
  std::string name_;                        ///< Of the function.
  std::vector<std::string> paths_{"\"\""};  ///< Of all commands, quoted; a pattern needs one.
  std::string cases_;
};

}  // namespace

ValueTable common_values() {
  return {{"FILE", {.words = {}, .files = true}},
          {"FOLDER", {.words = {}, .folders = true}},
          {"MESH", {.words = model_names(), .files = true}}};
}

std::string bash_completion(const CLI::App& app, const std::string& program, const ValueTable& values,
                            const std::vector<std::string>& more) {
  return Script(program, values).write(app, more);
}

}  // namespace sixdof
