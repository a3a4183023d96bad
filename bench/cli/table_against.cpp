#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/results/rivals.h>
#include "bench/cli/table.h"

namespace sixdof::cli {
namespace {

std::string us(double ns) { return ns < 1e6 ? fmt::format("{:.3g}", ns / 1e3) : fmt::format("{:.0f}", ns / 1e3); }

/// Enough digits for two of the least.
std::string number(double value, double least) {
  return fmt::format("{:.{}f}", value, least >= 99.5 ? 0 : least >= 0.95 ? 1 : 2);
}

}  // namespace

Sheet sheet_against(const TableInput& input, const Against& asked) {
  const auto& [algorithm, against, time, slower] = asked;
  Sheet sheet;
  sheet.title = fmt::format("{} against the fastest of {}", algorithm, fmt::join(against, ", "));
  if (time == results::RivalTime::p99) sheet.title += ", p99";
  if (slower) sheet.title += fmt::format(": where it takes more than {:g} times as long", *slower);
  sheet.columns = {{"", "pair", true},        {"", "query", true}, {"", "place", true}, {"", algorithm + ", us"},
                   {"", "fastest other, us"}, {"", "which", true}, {"", "ratio"},       {"", "least..greatest"}};
  std::vector<results::Rivalry> rivalries = results::rivalries(input.groups, algorithm, against, time);
  if (rivalries.empty()) {
    throw BadArgument(
        fmt::format("no rows without a fault of both {} and {}{}", algorithm, fmt::join(against, ", "),
                    time == results::RivalTime::p99 ? " that have a p99 (of 200 configurations or more)" : ""));
  }
  const auto ratio = [](const results::Rivalry& each) { return results::median(each.ratios()); };
  if (slower) {
    std::erase_if(rivalries, [&](const results::Rivalry& each) { return ratio(each) * *slower >= 1.0; });
    std::ranges::stable_sort(rivalries, {}, ratio);
  }
  for (const results::Rivalry& each : rivalries) {
    const std::vector<double> ratios = each.ratios();
    const auto [least, greatest] = std::ranges::minmax(ratios);
    const std::set<std::string> names(each.rivals.begin(), each.rivals.end());
    sheet.lines.push_back({each.bodies, each.query, each.place, us(results::median(each.own_ns)),
                           us(results::median(each.rival_ns)), fmt::format("{}", fmt::join(names, ", ")),
                           number(results::median(ratios), least),
                           fmt::format("{}..{}", number(least, least), number(greatest, least))});
  }
  for (const results::RowGroup& group : input.groups) {
    const std::string& name = group.fields().algorithm;
    if (group.faults.empty() || (name != algorithm && !results::fits(name, against))) continue;
    sheet.notes.push_back(fmt::format("! {}: {}", group.row().name, results::to_string(group.faults)));
  }
  return sheet;
}

}  // namespace sixdof::cli
