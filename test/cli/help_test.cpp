// What holds of every help text: short, the same form, and nothing that only the parser's author would understand.

#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "bench/common/help_format.h"
#include "run_program.h"

namespace sixdof {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A screen or a little more: what is longer belongs into a README.
constexpr std::size_t k_most_lines = 66;
/// Of lines of prose. Examples and tables may be longer.
constexpr std::size_t k_most_columns = 120;

const std::vector<std::string>& commands() {
  static const std::vector<std::string> list{
      "",           "models",   "models list", "models make", "info",       "repair",        "show",    "query",
      "algorithms", "generate", "merge",       "verify",      "agree",      "survey",        "table",   "report",
      "history",    "compare",  "gate",        "precision",   "recommend",  "equivalent",    "quality", "stress",
      "hulls",      "scene",    "scene make",  "scene info",  "scene play", "new-algorithm", "conform", "completion"};
  return list;
}

std::string help(const std::string& command) {
  const auto result = test::run_program(std::string(SIXDOF_PROGRAM) + " " + command + " --help");
  EXPECT_EQ(result.exit_code, 0) << command;
  EXPECT_EQ(result.err, "") << command;
  return result.out;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Help, OfEveryCommandIsShortAndOfOneForm) {
  for (const std::string& command : commands()) {
    SCOPED_TRACE(command);
    const std::string text = help(command);
    const std::vector<std::string> lines = lines_of(text);
    EXPECT_LE(lines.size(), k_most_lines);
    for (const std::string& line : lines) {
      if (line.find("sixdof") != std::string::npos) continue;
      EXPECT_LE(line.size(), k_most_columns) << line;
    }
    EXPECT_THAT(text, HasSubstr("\nUsage: sixdof" + (command.empty() ? "" : " " + command)));
    // Every value has a name of its own.
    for (const char* parsers_word : {" TEXT", " UINT", " INT", " FLOAT", "REQUIRED", "Excludes", "ENUM"}) {
      EXPECT_THAT(text, Not(HasSubstr(parsers_word)));
    }
  }
}

TEST(Help, ShowsTheCommandsInGroups) {
  const std::vector<std::string> lines = lines_of(help(""));
  std::vector<std::string> groups;
  std::set<std::string> listed;
  for (const std::string& line : lines) {
    if (!line.empty() && line.front() != ' ' && line.back() == ':') groups.push_back(line.substr(0, line.find(' ')));
    if (line.starts_with("  ") && line[2] != ' ' && line[2] != '-')
      listed.insert(line.substr(2, line.find(' ', 2) - 2));
  }
  EXPECT_THAT(groups, ::testing::ElementsAre("Options:", "Meshes:", "Ask", "Sets", "Results", "Studies", "Scenes",
                                             "Your", "Examples:"));
  for (const std::string& command : commands()) {
    if (command.empty() || command.find(' ') != std::string::npos) continue;
    EXPECT_TRUE(listed.contains(command)) << command;
  }
}

TEST(Help, HasRequiredOptionsInItsUsageAndChoicesBesideTheirOption) {
  const std::string query = help("query");
  EXPECT_THAT(query, HasSubstr("Usage: sixdof query --a MESH --b MESH --pose POSE [options]\n"));
  EXPECT_THAT(query, HasSubstr("[one of collide, distance,\n"));
  EXPECT_THAT(query, HasSubstr("default: exact"));
  EXPECT_THAT(query, HasSubstr("--isolate[=WHICH]"));
  EXPECT_THAT(query, HasSubstr("\nAlgorithms in processes of their own:\n"));
  EXPECT_THAT(help("table"), HasSubstr("Usage: sixdof table FILE ... [options]\n"));
  EXPECT_THAT(help("scene make"), HasSubstr("Usage: sixdof scene make -o FILE [FAMILY] [options]\n"));
}

TEST(Help, SaysWhatTouchingMeansInBothPlaces) {
  EXPECT_THAT(help("query"), HasSubstr("inside the other"));
  EXPECT_THAT(help("scene play"), HasSubstr("inside another one touches it, as in sixdof query"));
}

TEST(HelpFormat, FillsParagraphsAndKeepsIndentedLines) {
  EXPECT_EQ(wrapped("one two\nthree four\n\n  kept   as it is\nfive", 9),
            "one two\nthree\nfour\n\n  kept   as it is\nfive\n");
  EXPECT_EQ(wrapped("averylongword b", 5), "averylongword\nb\n");
  EXPECT_EQ(wrapped(""), "");
}

TEST(HelpFormat, ReadsWhatAnOptionIsTold) {
  CLI::App app;
  std::string word;
  double number = 0.0;
  auto* const choice = app.add_option("--choice", word)->type_name("WORD")->check(CLI::IsMember({"a", "b"}));
  EXPECT_EQ(value_of(*choice).name, "WORD");
  EXPECT_THAT(value_of(*choice).choices, ::testing::UnorderedElementsAre("a", "b"));
  auto* const range = app.add_option("--range", number)->type_name("X")->check(CLI::Range(1.0, 2.5));
  EXPECT_EQ(value_of(*range).range, "1 to 2.5");
  EXPECT_TRUE(value_of(*range).choices.empty());
  EXPECT_EQ(value_of(*app.add_option("--above", number)->type_name("X")->check(CLI::PositiveNumber)).range, "above 0");
  EXPECT_EQ(value_of(*app.add_option("--least", number)->type_name("X")->check(CLI::NonNegativeNumber)).range,
            "0 or more");
  EXPECT_EQ(value_of(*app.add_flag("--flag")).name, "");
  auto* const named = app.add_option("--named", word)->check(words_of({"x", "y"}));
  EXPECT_THAT(value_of(*named).choices, ::testing::ElementsAre("x", "y"));
  app.parse("--named z");
  EXPECT_EQ(word, "z") << "the words are for the help; the command refuses others";
}

}  // namespace
}  // namespace sixdof
