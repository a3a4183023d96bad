#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/data_folder.h>
#include <sixdof/base/error.h>
#include <sixdof/results/difference.h>
#include "bench/cli/commands.h"
#include "bench/cli/shared.h"

namespace sixdof::cli {
namespace {

constexpr const char* k_details =
    R"(BASELINE and CANDIDATE are each a program (sixdof-bench, or one around sixdof::bench_main), a command line in
quotes such as 'sixdof-bench --external mine=./mine', or a result file. Stages, in this order:
  answers       red if an answer is wrong, lost or changed, if a row is lost or fails; new rows are named
  work          counts of work (nodes tested, bytes): red above --work-above
  instructions  of a query, by valgrind, one row of each query and algorithm: red above --work-above
  time          two programs only, run alternately: red if a row is slower by the U test (after Holm) AND by more than
                --fail-above in the median of pairs AND in the fastest run, in a first AND in a second run
A stage that cannot be judged says why, and is not green. After a red stage the later ones still run, but not after red
answers.

Exit codes: 0 green, 3 red, 1 the comparison could not be made, 2 wrong command line, 130 interrupted.)";

/// The words of the command line for the script: options as they were given, names, and after "--" the programs'
/// options.
std::vector<std::string> words_for_script(const CLI::App& command) {
  std::vector<std::string> words, names, flags;
  for (const CLI::Option* const option : command.get_options()) {
    if (option->get_positional()) {
      // With --record the parser takes the first of the programs' options for the candidate.
      for (const std::string& word : option->results()) {
        const bool is_name = option->get_name() != "flags" && !word.starts_with('-');
        (is_name ? names : flags).push_back(word);
      }
    } else if (option->count() > 0) {
      const std::string name = "--" + option->get_lnames().front();
      const bool is_flag = option->get_items_expected_max() == 0;
      if (is_flag) words.push_back(name);
      for (const std::string& value : is_flag ? std::vector<std::string>() : option->results()) {
        words.push_back(fmt::format("{}={}", name, value));
      }
    }
  }
  words.insert(words.end(), names.begin(), names.end());
  words.emplace_back("--");
  words.insert(words.end(), flags.begin(), flags.end());
  return words;
}

/// Replaces this program by the script. @throws Error if the script cannot be run
[[noreturn]] void run_script(std::vector<std::string> words) {
  const std::string script = (data_folder() / "bench" / "gate").string();
  std::error_code ignored;
  const std::string program = std::filesystem::read_symlink("/proc/self/exe", ignored).string();
  words.insert(words.begin(), {script, fmt::format("--sixdof={}", program)});
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execv(script.c_str(), pointers.data());
  throw BadFile(script, fmt::format("cannot be run: {}", std::generic_category().message(errno)));
}

struct Arguments {
  std::string baseline, candidate, filter, stages, record, markdown, junit, report, folder;
  std::vector<std::string> flags;
  double tolerance = results::k_relative_rounding, work_above = 3.0, fail_above = 10.0, min_time = 0.02;
  std::size_t repetitions = 9, sample = 64;
  bool allow_better = false;
};

void add_judgement_options(CLI::App& command, Arguments& arguments) {
  command.add_option("--stages", arguments.stages, "Some of answers,work,instructions,time")
      ->type_name("LIST")
      ->default_str("all");
  command.add_option("--tolerance", arguments.tolerance, "Share of a number by which an answer's counter may differ")
      ->type_name("SHARE")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_flag("--allow-better", arguments.allow_better, "Answers that are better than before are not red");
  command.add_option("--work-above", arguments.work_above, "Most growth of work and instructions")
      ->type_name("PERCENT")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_option("--fail-above", arguments.fail_above, "Most growth of a time")
      ->type_name("PERCENT")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

void add_row_options(CLI::App& command, Arguments& arguments) {
  command.add_option("--filter", arguments.filter, "Names of rows")
      ->type_name("REGEX")
      ->default_str("the default suite");
  command.add_option("--sample", arguments.sample, "Configurations per bucket")
      ->type_name("N")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--repetitions", arguments.repetitions, "Runs of each program for the times, 9 at least")
      ->type_name("N")
      ->check(CLI::Range(9, 1000))
      ->capture_default_str();
  command.add_option("--min-time", arguments.min_time, "Of measuring per row and run")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("flags", arguments.flags, "After --: further options for both programs")->type_name("OPTION");
}

void add_output_options(CLI::App& command, Arguments& arguments) {
  command
      .add_option("--record", arguments.record,
                  "Judge nothing: write the answers, work and instructions of the one program that is named")
      ->type_name("FILE");
  command.add_option("--markdown", arguments.markdown, "The verdict as a comment of at most 40 lines")
      ->type_name("FILE");
  command.add_option("--junit", arguments.junit, "The verdict as JUnit XML")->type_name("FILE");
  command.add_option("--report", arguments.report, "Both results as a page (sixdof report)")->type_name("FILE");
  command.add_option("--folder", arguments.folder, "Where results and gate.json go")
      ->type_name("FOLDER")
      ->default_str("sixdof-gate");
}

}  // namespace

void add_gate_command(CLI::App& app) {
  auto* const command =
      app.add_subcommand("gate", "Judge a change: are answers, work and times of a program as before?");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("baseline", arguments->baseline, "As before")->required()->type_name("BASELINE");
  command->add_option("candidate", arguments->candidate, "In question; not with --record")->type_name("CANDIDATE");
  add_row_options(*command, *arguments);
  add_judgement_options(*command, *arguments);
  add_output_options(*command, *arguments);
  // The options write to `arguments`, which lives as long as this function.
  command->callback([command, arguments] { run_script(words_for_script(*command)); });
  add_examples(*command, "sixdof gate results.json results.json --markdown gate.md --junit gate.xml",
               "sixdof gate sixdof-bench sixdof-bench --filter '^distance/algorithm:exact/' --stages answers,work "
               "--sample 8 -- --a cone-1k --b torus-1k",
               k_details);
}

}  // namespace sixdof::cli
