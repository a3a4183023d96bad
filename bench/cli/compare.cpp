#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/results/difference.h>

#include "bench/cli/commands.h"
#include "bench/cli/shared.h"
#include "bench/cli/table.h"
#include "bench/common/json_text.h"
#include "bench/common/run_guarded.h"

namespace sixdof::cli {
namespace {

using results::Difference;
using results::Differences;
using Json = nlohmann::ordered_json;

constexpr const char* k_details =
    R"(Prints versions and settings that differ, rows that only one file has, answers that differ (errors, failures,
angles), and counts of work that differ. It does not compare times; `sixdof report BEFORE AFTER` does. Two numbers are
equal if they differ by at most 1e-12, or by 1e-9 (--tolerance) of the larger one. For repetitions the ranges are compared. If a row
asked another number of configurations, only that number is printed.

Keys of --json: versions[] {key, before, after}; only_before[], only_after[]; answers[] and work[] {row, counter,
before, after, worse}, each side [least, largest], the message of an error, or null; worse null where a counter has no
better direction; common_rows.)";

struct Arguments {
  std::string before, after;
  bool json = false, markdown = false, fail_on_answers = false;
  double tolerance = results::k_relative_rounding;
};

void print_text(const Differences& found, const Arguments& arguments) {
  for (const auto& [key, before, after] : found.versions) {
    fmt::print("version  {}: {} -> {}\n", key, before.empty() ? "none" : before, after.empty() ? "none" : after);
  }
  const auto print_rows = [](const std::string& file, const std::vector<std::string>& rows) {
    for (const std::string& row : rows)
      fmt::print("only in {}: {}\n", std::filesystem::path(file).stem().string(), row);
  };
  print_rows(arguments.before, found.only_before);
  print_rows(arguments.after, found.only_after);
  for (const Difference& each : found.values) {
    fmt::print("{} {}: {} {}\n", each.kind == MetricKind::work ? "work    " : "ANSWER  ", each.row, each.counter,
               to_string(each));
  }
  fmt::print("answers: {} counters of {} rows changed\n", found.changed_answers(), found.common_rows);
}

/// What changed in the rows of one query and algorithm.
struct Group {
  std::string what, counter;
  std::size_t rows = 0;
  const Difference* largest = nullptr;

  /// Relative to the larger side; infinite where a side has no value.
  static double size(const Difference& each) {
    if (!each.before || !each.after) return std::numeric_limits<double>::infinity();
    const double before = each.before->largest, after = each.after->largest;
    return std::abs(after - before) / std::max(std::abs(before), std::abs(after));
  }
};

/// Changed answers by query, algorithm and counter, those in most rows first.
std::vector<Group> groups_of(const Differences& found) {
  std::vector<Group> groups;
  for (const Difference& each : found.values) {
    if (each.kind == MetricKind::work) continue;
    const std::string what = each.row.substr(0, each.row.find('/', each.row.find('/') + 1));
    auto group =
        std::ranges::find_if(groups, [&](const Group& g) { return g.what == what && g.counter == each.counter; });
    if (group == groups.end()) group = groups.insert(group, {what, each.counter, 0, nullptr});
    ++group->rows;
    if (group->largest == nullptr || Group::size(each) > Group::size(*group->largest)) group->largest = &each;
  }
  std::ranges::stable_sort(groups, std::ranges::greater(), &Group::rows);
  return groups;
}

/// At most 20 lines.
void print_markdown(const Differences& found) {
  constexpr std::size_t k_most_groups = 12;
  const std::vector<Group> groups = groups_of(found);
  Sheet sheet;
  sheet.title =
      fmt::format("{} answers changed in {} common rows; {} rows only before, {} only after; {} versions differ",
                  found.changed_answers(), found.common_rows, found.only_before.size(), found.only_after.size(),
                  found.versions.size());
  for (const char* const title : {"rows", "counter", "how many", "largest change", "in"}) {
    sheet.columns.push_back({.group = "", .title = title, .left = true});
  }
  for (const Group& group : std::span(groups).first(std::min(groups.size(), k_most_groups))) {
    sheet.lines.push_back(
        {group.what, group.counter, std::to_string(group.rows), to_string(*group.largest), group.largest->row});
  }
  if (groups.size() > k_most_groups) {
    sheet.notes.push_back(fmt::format("and {} more kinds of changes", groups.size() - k_most_groups));
  }
  fmt::print("{}", groups.empty() ? fmt::format("### {}\n", sheet.title) : as_markdown(sheet));
}

Json side(const std::optional<results::Range>& range, const std::string& error) {
  if (range) return {range->least, range->largest};
  return error.empty() ? Json(nullptr) : Json(error);
}

Json as_json(const Differences& found) {
  Json document = {{"versions", Json::array()},      {"only_before", found.only_before},
                   {"only_after", found.only_after}, {"answers", Json::array()},
                   {"work", Json::array()},          {"common_rows", found.common_rows}};
  for (const auto& [key, before, after] : found.versions) {
    document["versions"].push_back({{"key", key}, {"before", before}, {"after", after}});
  }
  for (const Difference& each : found.values) {
    const std::optional<bool> worse = results::is_worse(each);
    document[each.kind == MetricKind::work ? "work" : "answers"].push_back(
        {{"row", each.row},
         {"counter", each.counter},
         {"before", side(each.before, each.error_before)},
         {"after", side(each.after, each.error_after)},
         {"worse", worse ? Json(*worse) : Json(nullptr)}});
  }
  return document;
}

void run(const Arguments& arguments) {
  results::Results results;
  results::read_results(arguments.before, results);
  results::read_results(arguments.after, results);
  const Differences found = differences(results, row_groups(results), 0, 1, arguments.tolerance);
  if (arguments.json) {
    fmt::print("{}\n", json_text(as_json(found)));
  } else if (arguments.markdown) {
    print_markdown(found);
  } else {
    print_text(found, arguments);
  }
  const std::size_t one_sided = found.only_before.size() + found.only_after.size();
  if (arguments.fail_on_answers && found.changed_answers() + one_sided > 0) {
    throw DefectsFound(
        fmt::format("{} answers changed, {} rows are in one file only", found.changed_answers(), one_sided));
  }
}

}  // namespace

void add_compare_command(CLI::App& app) {
  auto* const command = app.add_subcommand("compare", "Compare two results: answers, versions and counts of work");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("before", arguments->before, "Result file (JSON)")->required()->type_name("BEFORE");
  command->add_option("after", arguments->after, "Result file of the same rows")->required()->type_name("AFTER");
  auto* const json = command->add_flag("--json", arguments->json, "As JSON");
  command->add_flag("--markdown", arguments->markdown, "A summary of at most 20 lines, as Markdown")->excludes(json);
  command->add_flag("--fail-on-answers", arguments->fail_on_answers,
                    "Exit code 3 if an answer changed or a row is in one file only");
  command->add_option("--tolerance", arguments->tolerance, "Share of a number by which it may differ")
      ->type_name("SHARE")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->callback([arguments] { run(*arguments); });
  add_examples(*command, "sixdof compare results.json results.json --fail-on-answers",
               "sixdof compare results.json results.json --json", k_details);
}

}  // namespace sixdof::cli
