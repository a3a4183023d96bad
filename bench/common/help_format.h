#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace sixdof {

/// Columns of a help text.
constexpr std::size_t k_help_width = 100;

/// What the value of an option or argument may be, as it is told to the parser: by type_name() and check().
struct OptionValue {
  std::string name;                  ///< In the help: "FILE", "MESH"; empty for a flag.
  std::vector<std::string> choices;  ///< If it is one of a few words.
  std::string range;                 ///< If it is a number in a range: "1 to 64", "above 0".
};
OptionValue value_of(const CLI::Option& option);

/// Names the choices of an option for help and completion; the command itself refuses other words.
CLI::Validator words_of(const std::vector<std::string>& choices);

/// An entry of a list in a help: what, and what it is, in two columns; ends with a line feed.
std::string help_entry(const std::string& left, const std::string& right);

/// Text in lines of at most `width` columns, unless a word is longer. Lines are filled anew from one empty line to the
/// next; those that begin with a space stay as they are.
std::string wrapped(std::string_view text, std::size_t width = k_help_width);

/// The help of all commands of both programs: what is required stands in the usage line; an option has the name of its
/// value, and at the end of its description default, choices and range; lines are wrapped.
class HelpFormat final : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

}  // namespace sixdof
