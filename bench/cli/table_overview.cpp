#include <algorithm>
#include <iterator>
#include <map>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/cli/table.h"
#include "bench/cli/table_numbers.h"

namespace sixdof::cli {
namespace {

using results::Fault;

struct Query {
  const char* name;
  const char* words;
};
constexpr Query k_queries[]{{"collide", "yes/no"}, {"distance", "distance"}, {"respond", "response"}};
constexpr Query k_casts{results::k_cast, "first contact"};

/// Those that have a column: that of casts only where there are some.
std::vector<Query> columns_of(bool with_casts) {
  std::vector<Query> queries(std::begin(k_queries), std::end(k_queries));
  if (with_casts) queries.push_back(k_casts);
  return queries;
}

/// The rows of one algorithm on one pair: random poses on warm caches.
struct OverviewLine {
  std::string algorithm;
  bool approximates = false;
  std::map<std::string, std::vector<const results::RowGroup*>> by_query;

  std::vector<double> values(const std::string& query, const std::string& name) const {
    std::vector<double> found;
    const auto rows = by_query.find(query);
    if (rows == by_query.end()) return found;
    for (const results::RowGroup* group : rows->second) {
      if (const auto value = group->value(name)) found.push_back(*value);
    }
    return found;
  }
};

constexpr const char* k_own_value = "gamma_own_F_deg";

std::string law_cell(const OverviewLine& line) {
  const auto rows = line.by_query.find("respond");
  const std::string law = rows == line.by_query.end() ? std::string() : rows->second.front()->fields().law;
  return law.empty() ? "-" : law;
}

std::string mean_cell(const std::vector<double>& values, std::string (*format)(double)) {
  if (values.empty()) return "-";
  double sum = 0.0;
  for (const double value : values) sum += value;
  return format(sum / static_cast<double>(values.size()));
}

/// " (2 missed, 1 late)", of all motions together; empty for none.
std::string kinds_of_wrong_casts(const OverviewLine& line) {
  constexpr std::pair<const char*, const char*> k_kinds[]{{"missed_hits", "missed"},
                                                          {"late_hits", "late"},
                                                          {"phantom_hits", "phantom"},
                                                          {"false_starts", "contact at the start"}};
  std::vector<std::string> texts;
  for (const auto& [counter, words] : k_kinds) {
    double sum = 0.0;
    for (const double value : line.values(results::k_cast, counter)) sum += value;
    if (sum > 0.0) texts.push_back(fmt::format("{:.0f} {}", sum, words));
  }
  return texts.empty() ? "" : fmt::format(" ({})", fmt::join(texts, ", "));
}

/// "yes/no: 3 of 640 wrong", of all buckets together.
std::vector<std::string> fault_texts(const OverviewLine& line) {
  std::vector<std::string> texts;
  for (const auto& [query, words] : columns_of(true)) {
    const auto rows = line.by_query.find(query);
    if (rows == line.by_query.end()) continue;
    std::vector<Fault> sums;
    for (const results::RowGroup* group : rows->second) {
      for (const Fault& fault : group->faults) {
        // How far distances of approximations are off says more than how many.
        if (!fault.is_approximation()) add_fault(sums, fault);
      }
    }
    if (sums.empty()) continue;
    const std::string kinds = query == results::k_cast ? kinds_of_wrong_casts(line) : std::string();
    texts.push_back(fmt::format("{}: {}{}", words, results::to_string(sums), kinds));
  }
  return texts;
}

std::string answers_cell(const OverviewLine& line) {
  std::vector<std::string> texts = fault_texts(line);
  const std::vector<double> errors = line.values("distance", "error_max");
  if (line.approximates && !errors.empty()) {
    texts.push_back(fmt::format("largest distance error {:.2g} % of A's diagonal", 100.0 * std::ranges::max(errors)));
  }
  const bool judged = line.by_query.contains("collide") || line.by_query.contains("distance") ||
                      line.by_query.contains(results::k_cast);
  const char* const verdict = line.approximates ? "approximate" : !texts.empty() ? "wrong" : judged ? "right" : "-";
  return texts.empty() ? verdict : fmt::format("{}; {}", verdict, fmt::join(texts, "; "));
}

}  // namespace

std::vector<Sheet> overview_sheets_of(const std::vector<ResultTable>& tables) {
  std::vector<std::pair<std::string, std::vector<OverviewLine>>> pairs;
  for (const ResultTable& table : tables) {
    auto pair = std::ranges::find(pairs, table.pair, [](const auto& each) { return each.first; });
    if (pair == pairs.end()) pair = pairs.insert(pairs.end(), {table.pair, {}});
    // Of responses the means are of bodies that overlap.
    if (table.query == "respond" && table.kind == BucketKind::distance) continue;
    for (const TableLine& line : table.lines) {
      const results::RowGroup* const group = line.files.front().group;
      if (group == nullptr || line.label() != line.algorithm || line.algorithm == "null") continue;
      auto found = std::ranges::find(pair->second, line.algorithm, &OverviewLine::algorithm);
      if (found == pair->second.end()) found = pair->second.insert(found, {line.algorithm, false, {}});
      found->approximates = found->approximates || group->fields().approximates;
      found->by_query[table.query].push_back(group);
    }
  }
  std::vector<Sheet> sheets;
  for (const auto& [pair, lines] : pairs) {
    Sheet& sheet = sheets.emplace_back();
    sheet.title = pair + ": mean processor time of a query over all distances and overlaps";
    sheet.columns = {{"", "algorithm", true}};
    const bool casts =
        std::ranges::any_of(lines, [](const OverviewLine& line) { return line.by_query.contains(results::k_cast); });
    const std::vector<Query> queries = columns_of(casts);
    for (const auto& [query, words] : queries) sheet.columns.push_back({"", fmt::format("{}, us", words)});
    // Older results are not compared with the laws of their algorithms.
    const bool own =
        std::ranges::any_of(lines, [](const auto& line) { return !line.values("respond", k_own_value).empty(); });
    if (own) {
      sheet.columns.push_back({"", "law", true});
      sheet.columns.push_back({"", "force angle to its law, degrees"});
    }
    sheet.columns.push_back({"", own ? "to -dV/dx" : "force angle, degrees"});
    sheet.columns.push_back({"", "answers", true});
    for (const OverviewLine& line : lines) {
      auto& cells = sheet.lines.emplace_back(std::vector{line.algorithm});
      for (const auto& [query, words] : queries) {
        cells.push_back(mean_cell(line.values(query, results::k_processor_mean), as_microseconds));
      }
      if (own) {
        cells.push_back(law_cell(line));
        cells.push_back(mean_cell(line.values("respond", k_own_value), as_degrees));
      }
      cells.push_back(mean_cell(line.values("respond", "gamma_F_deg"), as_degrees));
      cells.push_back(answers_cell(line));
    }
  }
  return sheets;
}

std::vector<std::string> lines_below_overview() {
  return {"force angle: mean angle to the exact force -dV/dx; contact forces of libraries follow laws of their own",
          "law: what the response tends to: volume: -dV/dx; depth, way_out: integrals of the depth over B's surface "
          "inside A; contacts: of pairs of triangles, judged by depth",
          "first contact: mean over all kinds of motion and steps",
          "answers: right: no yes/no, no distance and no first contact differs from the truth; approximate: spheres, "
          "voxels or points "
          "take the "
          "place of the bodies, and errors follow; wrong: an algorithm that promises right answers gave wrong ones"};
}

}  // namespace sixdof::cli
