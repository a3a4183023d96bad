#include "bench/common/help_format.h"

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sixdof {
namespace {

constexpr std::size_t k_indent = 2;
constexpr std::size_t k_column = 26;  // of descriptions

/// "a", "b", "c" of "{a,b,c}", as CLI::IsMember describes itself.
std::vector<std::string> choices_in(std::string_view text) {
  std::vector<std::string> choices;
  const std::size_t open = text.find('{'), close = text.find('}', open);
  if (open == std::string_view::npos || close == std::string_view::npos) return choices;
  text = text.substr(open + 1, close - open - 1);
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    choices.emplace_back(text.substr(0, comma));
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return choices;
}

/// "1 to 64" of "INT in [1 - 64]", as CLI::Range describes itself, and its two numbers with names.
std::string range_in(std::string_view text) {
  if (text.find("POSITIVE") != std::string_view::npos) return "above 0";
  if (text.find("NONNEGATIVE") != std::string_view::npos) return "0 or more";
  const std::size_t open = text.find(" in ["), middle = text.find(" - ", open), close = text.find(']', middle);
  if (open == std::string_view::npos || middle == std::string_view::npos || close == std::string_view::npos) return {};
  const std::size_t first = open + 5, second = middle + 3;
  return fmt::format("{} to {}", text.substr(first, middle - first), text.substr(second, close - second));
}

/// "-o,--output FILE", "--isolate[=WHICH]", "--json"; of an argument the name of its value.
std::string left_side(const CLI::Option& option) {
  const OptionValue value = value_of(option);
  if (option.get_positional()) return value.name;
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  std::string text = fmt::format("{}", fmt::join(names, ","));
  if (value.name.empty()) return text;
  return text + (!option.get_fnames().empty() ? fmt::format("[={}]", value.name) : " " + value.name);
}

/// "-o FILE": with the shortest name only.
std::string short_side(const CLI::Option& option) {
  const std::string text = left_side(option);
  const std::size_t comma = text.find(','), blank = text.find(' ');
  return comma < blank ? text.substr(0, comma) + text.substr(blank) : text;
}

std::string names_of(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::ranges::sort(names);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// "[one of text, json; default: text]".
std::string qualities(const CLI::Option& option) {
  const OptionValue value = value_of(option);
  std::vector<std::string> list;
  if (option.get_required()) list.emplace_back("required");
  if (value.choices.size() > 1) list.push_back(fmt::format("one of {}", fmt::join(value.choices, ", ")));
  if (!value.range.empty()) list.push_back(value.range);
  if (!option.get_needs().empty()) list.push_back("needs " + names_of(option.get_needs()));
  if (!option.get_excludes().empty()) list.push_back("not with " + names_of(option.get_excludes()));
  if (!option.get_default_str().empty()) {
    std::string text = option.get_default_str();
    if (text.front() == '[' && text.back() == ']') text = text.substr(1, text.size() - 2);  // of a list
    if (!text.empty()) list.push_back("default: " + text);
  }
  return list.empty() ? std::string() : fmt::format(" [{}]", fmt::join(list, "; "));
}

/// Appends the words of `text`, from column `at` on; further lines begin with `indent` spaces.
void fill(std::string& out, std::string_view text, std::size_t at, std::size_t indent, std::size_t width) {
  std::istringstream words{std::string(text)};
  bool is_first = true;
  for (std::string word; words >> word;) {
    if (!is_first && at + 1 + word.size() > width) {
      out += '\n' + std::string(indent, ' ');
      at = indent;
    } else if (!is_first) {
      out += ' ';
      ++at;
    }
    out += word;
    at += word.size();
    is_first = false;
  }
  out += '\n';
}

bool takes_many(const CLI::Option& option) {
  return option.get_expected_max() >= CLI::detail::expected_max_vector_size;
}

std::vector<const CLI::Option*> arguments_of(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

std::string entry_of(const CLI::Option& option) {
  return help_entry(left_side(option), option.get_description() + qualities(option));
}

std::string usage(const CLI::App& app, const std::string& name) {
  std::string text = "Usage: " + name;
  bool has_more = false;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) continue;
    if (option->get_required()) text += " " + short_side(*option);
    has_more = has_more || (!option->get_required() && option != app.get_help_ptr());
  }
  for (const CLI::Option* argument : arguments_of(app)) {
    const std::string word = left_side(*argument) + (takes_many(*argument) ? " ..." : "");
    text += argument->get_required() ? " " + word : " [" + word + "]";
  }
  if (has_more) text += " [options]";
  if (!app.get_subcommands({}).empty()) text += " COMMAND [options]";
  std::string out;
  fill(out, text, 0, std::string_view("Usage: ").size(), k_help_width);
  return out;
}

}  // namespace

std::string help_entry(const std::string& left, const std::string& right) {
  std::string out = std::string(k_indent, ' ') + left;
  if (right.empty()) return out + '\n';
  if (out.size() + 1 > k_column) {
    out += '\n' + std::string(k_column, ' ');
  } else {
    out.resize(k_column, ' ');
  }
  fill(out, right, k_column, k_column, k_help_width);
  return out;
}

OptionValue value_of(const CLI::Option& option) {
  // "NAME:CHECK", where a name may have colons of its own.
  const std::string text = option.get_type_name();
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return {.name = text, .choices = {}, .range = {}};
  const std::string check = text.substr(colon + 1);
  OptionValue value{.name = text.substr(0, colon), .choices = choices_in(check), .range = range_in(check)};
  constexpr std::string_view k_existing_file = "FILE";
  if (value.choices.empty() && value.range.empty() && check != k_existing_file) value.name = text;
  return value;
}

CLI::Validator words_of(const std::vector<std::string>& choices) {
  return {[](std::string& /*word*/) { return std::string(); }, fmt::format("{{{}}}", fmt::join(choices, ","))};
}

std::string wrapped(std::string_view text, std::size_t width) {
  std::string out, paragraph;
  const auto flush = [&] {
    if (!paragraph.empty()) fill(out, paragraph, 0, 0, width);
    paragraph.clear();
  };
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!line.empty() && line.front() != ' ') {
      (paragraph += line) += ' ';
      continue;
    }
    flush();
    (out += line) += '\n';
  }
  flush();
  return out;
}

std::string HelpFormat::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode /*mode*/) const {
  std::string out = wrapped(app->get_description()) + '\n' + usage(*app, name);
  if (const auto arguments = arguments_of(*app); !arguments.empty()) {
    out += "\nArguments:\n";
    for (const CLI::Option* argument : arguments) out += entry_of(*argument);
  }
  for (const std::string& group : app->get_groups()) {
    const auto options = app->get_options(
        [&](const CLI::Option* option) { return !option->get_positional() && option->get_group() == group; });
    if (group.empty() || options.empty()) continue;
    out += '\n' + group + ":\n";
    for (const CLI::Option* option : options) out += entry_of(*option);
  }
  std::string group;
  for (const CLI::App* command : app->get_subcommands({})) {
    if (std::exchange(group, command->get_group()) != command->get_group()) out += '\n' + group + ":\n";
    out += help_entry(command->get_name(), command->get_description());
  }
  if (const std::string footer = app->get_footer(); !footer.empty()) out += '\n' + wrapped(footer);
  return out;
}

}  // namespace sixdof
