#include <memory>
#include <string>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/data_folder.h>
#include <sixdof/report/history.h>
#include <sixdof/report/page.h>

#include "bench/cli/commands.h"
#include "bench/cli/shared.h"

namespace sixdof::cli {
namespace {

constexpr const char* k_details =
    R"(Reads every result of sixdof-bench in FOLDER (*.json, as bench/run leaves them in results/), in the order of their
dates. The page draws a line for each row and marks where its time changes lastingly. A line is interrupted where the
machine or the kind of build changes. The page also compares the last run with the one before.)";

struct Arguments {
  std::string folder, output;
};

void run(const Arguments& arguments) {
  const results::Results results = results::read_folder(arguments.folder);
  const report::PageFiles files = report::read_page_files(data_folder() / "report");
  write_file_atomically(arguments.output, report::page_html(report::make_history(results), files));
}

}  // namespace

void add_history_command(CLI::App& app) {
  auto* const command = app.add_subcommand("history", "Show how times changed over many results, as one page");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("folder", arguments->folder, "Folder of result files (JSON)")->required()->type_name("FOLDER");
  command->add_option("-o,--output", arguments->output, "The page to write (HTML)")->required()->type_name("FILE");
  command->callback([arguments] { run(*arguments); });
  add_examples(*command, "sixdof history . -o history.html",
               "cp results.json later.json; sixdof history . -o history.html", k_details);
}

}  // namespace sixdof::cli
