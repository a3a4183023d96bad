#include "bench/cli/table.h"

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

#include "bench/cli/commands.h"
#include "bench/cli/shared.h"
#include "bench/cli/table_collection.h"
#include "bench/common/json_text.h"

namespace sixdof::cli {
namespace {

constexpr const char* k_details =
    R"(Prints a table for each pair, query and kind of bucket, with a line for each bucket and algorithm. cpu is the
mean processor time of a query in a loop over all configurations; the other times are wall clock times of single
queries. * marks the least cpu of a bucket among rows without faults. ! marks a row with faults, which are counted
below its table: failed configurations, wrong answers, overlaps without a force; ~ one of distances that an algorithm
approximates. If rows are repeated, each value is
the median; from three repetitions on, cpu is the geometric mean. Several files stand side by side, with the ratio of
cpu to that of the first.

--wide prints one table for each query of one file, with a line for each pair and algorithm and a column for each
bucket. Angles and magnitudes are means over the buckets, errors the largest, faults sums. --against prints the time
of the fastest of the named algorithms over that of --of: the median over the files, e.g. of several seeds, with the
least and the greatest. It also takes `generate` rows and scenes (sixdof scene play --json). --slower 1 lists the rows
in which --of loses.

--over-objects: of a result of bench/scripts/collection, mean times over the objects, ratios to `exact` on the same
object, and which kinds of objects take longer than their number of triangles alone says. --growth: of a result of
bench/scripts/growth, the exponents of the number of triangles. Rows with a fault count for no time. Both print
Markdown, or with --json the members "collection" and "growth" of result files.

Keys of --json: files[] {file, date, commit, interrupted, settings {ALGORITHM: {PARAMETER: value}}, not_shown {FAMILY:
rows}}; tables[] {pair, query, kind, rows[] {percent, algorithm, order, cache, files[]}}, with null or {fastest,
faults[] {what, count, of}, ratio_to_first, values} for each file. values are the row's counters
(lib/sixdof/measure/metrics.cpp), processor_mean_ns and wall_mean_ns; none of a row that could not be run.)";

struct Arguments {
  std::vector<std::string> files;
  Against against;
  bool p99 = false;
  bool markdown = false, json = false, wide = false, overview = false, over_objects = false, growth = false,
       paper = false;
};

void print(const std::vector<ResultTable>& tables, const TableInput& input, const Arguments& arguments) {
  const bool markdown = arguments.markdown;
  const auto format_lines = markdown ? lines_as_markdown : lines_as_text;
  const auto format_sheet = markdown ? as_markdown : as_text;
  fmt::print("{}\n", format_lines(lines_above(input)));
  std::vector<Sheet> sheets;
  if (arguments.overview) {
    sheets = overview_sheets_of(tables);
  } else if (arguments.wide) {
    sheets = wide_sheets_of(tables);
  } else {
    for (const ResultTable& table : tables) sheets.push_back(sheet_of(table, input));
  }
  for (const Sheet& sheet : sheets) fmt::print("{}\n", format_sheet(sheet));
  if (tables.empty()) fmt::print("no rows of queries on buckets\n\n");
  fmt::print("{}", format_lines(arguments.overview ? lines_below_overview() : lines_below(input)));
}

void run(const Arguments& arguments) {
  if (!arguments.against.others.empty()) {
    Against asked = arguments.against;
    if (arguments.p99) asked.time = results::RivalTime::p99;
    const Sheet sheet = sheet_against(TableInput(arguments.files, false), asked);
    fmt::print("{}", arguments.markdown ? as_markdown(sheet) : as_text(sheet));
    return;
  }
  if ((arguments.wide || arguments.overview || arguments.over_objects || arguments.growth || arguments.paper) &&
      arguments.files.size() > 1) {
    throw BadArgument("--wide, --overview, --over-objects, --growth and --paper show one file");
  }
  const TableInput input(arguments.files);
  if (arguments.over_objects || arguments.growth) {
    const auto as_json = arguments.growth ? growth_json : over_objects_json;
    const auto as_text = arguments.growth ? growth_text : over_objects_text;
    fmt::print("{}", arguments.json ? json_text(as_json(input.groups)) + "\n" : as_text(input.groups));
    return;
  }
  if (arguments.paper) {
    const Sheet sheet = paper_sheet_of(input);
    fmt::print("{}", arguments.markdown ? as_markdown(sheet) : as_text(sheet));
    return;
  }
  const std::vector<ResultTable> tables = tables_of(input);
  if (arguments.json) {
    fmt::print("{}\n", json_text(as_json(tables, input)));
  } else {
    print(tables, input, arguments);
  }
}

}  // namespace

void add_table_command(CLI::App& app) {
  auto* const command = app.add_subcommand("table", "Print results of sixdof-bench as tables");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("file", arguments->files, "Result files of sixdof-bench (JSON)")->required()->type_name("FILE");
  auto* const markdown = command->add_flag("--markdown", arguments->markdown, "As Markdown");
  auto* const json = command->add_flag("--json", arguments->json, "As JSON")->excludes(markdown);
  auto* const wide =
      command->add_flag("--wide", arguments->wide, "One line per pair and algorithm, one column per bucket")
          ->excludes(json);
  command->add_flag("--overview", arguments->overview, "One line per algorithm: its times and what is wrong with it")
      ->excludes(json)
      ->excludes(wide);
  auto* const over_objects =
      command->add_flag("--over-objects", arguments->over_objects, "Means over the objects of bench/scripts/collection")
          ->excludes(wide);
  auto* const growth =
      command->add_flag("--growth", arguments->growth, "Growth with the number of triangles (bench/scripts/growth)")
          ->excludes(wide)
          ->excludes(over_objects);
  command->add_flag("--paper", arguments->paper, "Scenarios beside the paper's values (sixdof-bench --suite paper)")
      ->excludes(json)
      ->excludes(wide)
      ->excludes(over_objects)
      ->excludes(growth);
  auto* const against =
      command
          ->add_option("--against", arguments->against.others, "Only ratios to the fastest of these, e.g. 'fcl-*,ode'")
          ->type_name("ALGORITHM,...")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->excludes(json)
          ->excludes(over_objects)
          ->excludes(growth);
  command->add_option("--of", arguments->against.algorithm, "Algorithm whose time is compared by --against")
      ->type_name("ALGORITHM")
      ->needs(against)
      ->capture_default_str();
  command->add_flag("--p99", arguments->p99, "By --against compare what 99 % of the queries stay below, not means")
      ->needs(against);
  command
      ->add_option("--slower", arguments->against.slower,
                   "Of --against only where --of takes more than FACTOR times as long, the worst first")
      ->type_name("FACTOR")
      ->check(CLI::PositiveNumber)
      ->needs(against);
  command->callback([arguments] { run(*arguments); });
  add_examples(*command,
               "sixdof-bench --benchmark_filter=/algorithm:exact/pair:torus-knot-10k/distance:05 --sample 32 "
               "--out results.json",
               "sixdof table results.json", k_details);
}

}  // namespace sixdof::cli
