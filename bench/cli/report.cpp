#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/data_folder.h>
#include <sixdof/base/error.h>
#include <sixdof/report/figure_files.h>
#include <sixdof/report/page.h>

#include "bench/cli/commands.h"
#include "bench/cli/shared.h"

namespace sixdof::cli {
namespace {

constexpr const char* k_details =
    R"(FILE is a result of sixdof-bench, of a study (sixdof precision, equivalent, ... -o), or of sixdof stress -o.
All go into one page, which opens from disk without a network. Files with the same rows are compared with the first
one: answers, then times, each change with its interval. Files of --series (sixdof quality -o) are drawn as signals
and time-frequency diagrams. A section without data says which command makes them. --choose selects what the figures
show at first, by a column of the tables and one of its values: --choose pair=bunny --choose statistic=longest.
Figures for a paper: --pdf figures --width 84mm --font "Times New Roman" --no-title. Texts keep their size at any width,
and a PDF has its fonts. --tikz writes a document for LaTeX and PGFPlots for each figure of lines or points.)";

struct Arguments {
  std::vector<std::string> files, series, choices;
  std::string output, csv, markdown, svg, pdf, tikz;
  report::FigureStyle style;
  bool has_no_title = false;
};

/// @throws BadFile
void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw BadFile(folder.string(), "cannot be made: " + error.message());
}

void write_tables(const report::Report& report, const std::filesystem::path& folder, const std::string& extension,
                  std::string (*as_text)(const report::DataTable&)) {
  make_folder(folder);
  for (const report::DataTable& table : report.tables) {
    if (!table.rows.empty()) write_file_atomically(folder / (table.name + extension), as_text(table));
  }
}

void run(const Arguments& arguments) {
  if (arguments.files.empty() && arguments.series.empty()) throw BadArgument("a result file or --series is needed");
  const std::array outputs{&arguments.output, &arguments.csv, &arguments.markdown,
                           &arguments.svg,    &arguments.pdf, &arguments.tikz};
  if (std::ranges::all_of(outputs, &std::string::empty, [](const std::string* output) { return *output; })) {
    throw BadArgument("-o, --csv, --markdown, --svg, --pdf or --tikz is needed");
  }
  const std::array<std::pair<const std::string*, report::FigureFormat>, 3> figures{
      {{&arguments.svg, report::FigureFormat::svg},
       {&arguments.pdf, report::FigureFormat::pdf},
       {&arguments.tikz, report::FigureFormat::tikz}}};
  const bool has_figures = std::ranges::any_of(figures, [](const auto& figure) { return !figure.first->empty(); });
  report::FigureStyle style = arguments.style;
  style.has_title = !arguments.has_no_title;
  if (!has_figures && (!style.width.empty() || !style.font.empty() || !style.has_title)) {
    throw BadArgument("--width, --font and --no-title are about --svg, --pdf and --tikz");
  }
  results::Results results;
  for (const std::string& file : arguments.files) results::read_results(file, results);
  std::vector<report::Series> series;
  for (const std::string& file : arguments.series) series.push_back(report::read_series(file));
  report::Report report = report::make_report(results, series);
  for (const std::string& choice : arguments.choices) {
    const std::size_t equals = choice.find('=');
    if (equals == 0 || equals == std::string::npos) {
      throw BadArgument(fmt::format("--choose {}: not COLUMN=VALUE, e.g. pair=bunny", choice));
    }
    report.choices[choice.substr(0, equals)] = choice.substr(equals + 1);
  }
  if (!arguments.csv.empty()) write_tables(report, arguments.csv, ".csv", report::as_csv);
  if (!arguments.markdown.empty()) write_tables(report, arguments.markdown, ".md", report::as_markdown);
  if (arguments.output.empty() && !has_figures) return;
  const report::PageFiles files = report::read_page_files(data_folder() / "report");
  if (!arguments.output.empty()) write_file_atomically(arguments.output, report::page_html(report, files));
  for (const auto& [folder, format] : figures) {
    if (!folder->empty()) write_figures(report, files, *folder, format, style);
  }
}

}  // namespace

void add_report_command(CLI::App& app) {
  auto* const command = app.add_subcommand("report", "Show results as one page of figures and tables");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("file", arguments->files, "Result files (JSON)")->type_name("FILE");
  command->add_option("--series", arguments->series, "Series of sixdof quality -o (HDF5); may be repeated")
      ->type_name("FILE");
  command->add_option("-o,--output", arguments->output, "Write the page to this file (HTML)")->type_name("FILE");
  command->add_option("--csv", arguments->csv, "Write every table to this folder, as CSV")->type_name("FOLDER");
  command->add_option("--markdown", arguments->markdown, "Write every table to this folder, as Markdown")
      ->type_name("FOLDER");
  command->add_option("--svg", arguments->svg, "Write every figure to this folder, as SVG (needs Node.js)")
      ->type_name("FOLDER");
  command
      ->add_option("--pdf", arguments->pdf,
                   "Write every figure to this folder, as PDF (needs Node.js and rsvg-convert)")
      ->type_name("FOLDER");
  command
      ->add_option("--tikz", arguments->tikz,
                   "Write every figure of lines or points to this folder, for LaTeX with PGFPlots (needs Node.js)")
      ->type_name("FOLDER");
  command->add_option("--width", arguments->style.width, "Width of figures in files: 84mm, 3.3in or 320px")
      ->type_name("WIDTH");
  command->add_option("--font", arguments->style.font, "Font family of figures in files")->type_name("FAMILY");
  command->add_flag("--no-title", arguments->has_no_title, "Figures in files have no title");
  command->add_option("--choose", arguments->choices, "What figures show at first (below); may be repeated")
      ->type_name("COLUMN=VALUE")
      ->allow_extra_args(false);
  command->callback([arguments] { run(*arguments); });
  add_examples(*command, "sixdof report results.json -o report.html",
               "sixdof report results.json --csv tables --markdown tables", k_details);
}

}  // namespace sixdof::cli
