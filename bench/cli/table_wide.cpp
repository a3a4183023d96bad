#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/cli/table.h"
#include "bench/cli/table_numbers.h"

namespace sixdof::cli {
namespace {

using results::Fault;

/// The rows of one algorithm on one pair, of all buckets.
struct WideLine {
  std::string pair, label;
  std::map<BucketKey, const RankedRow*> rows;

  /// Of all rows that have the value: f(so far, value).
  template <class F>
  std::optional<double> fold(const std::string& name, F f) const {
    std::optional<double> result;
    for (const auto& [bucket, ranked] : rows) {
      if (const auto value = ranked->group->value(name)) result = result ? f(*result, *value) : *value;
    }
    return result;
  }

  std::optional<double> largest(const std::string& name) const {
    return fold(name, [](double a, double b) { return std::max(a, b); });
  }
  std::optional<double> mean(const std::string& name) const {
    const auto sum = fold(name, [](double a, double b) { return a + b; });
    const auto count =
        std::ranges::count_if(rows, [&](const auto& entry) { return entry.second->group->value(name).has_value(); });
    return sum ? std::optional(*sum / static_cast<double>(count)) : std::nullopt;
  }
};

/// Casts have one bucket, and a line for each motion.
std::string label_of(const TableLine& line) {
  return line.is_cast ? fmt::format("{} ({})", line.label(), line.place()) : line.label();
}

/// Lines of a query in the order of the tables: by pair, then algorithm.
std::vector<WideLine> lines_of(const std::vector<const ResultTable*>& tables) {
  std::vector<WideLine> lines;
  for (const ResultTable* table : tables) {
    for (const TableLine& line : table->lines) {
      const RankedRow& ranked = line.files.front();
      if (ranked.group == nullptr) continue;
      const auto is_same = [&](const WideLine& other) {
        return other.pair == table->pair && other.label == label_of(line);
      };
      auto found = std::ranges::find_if(lines, is_same);
      if (found == lines.end()) found = lines.insert(lines.end(), {table->pair, label_of(line), {}});
      found->rows[line.bucket] = &ranked;
    }
  }
  // Tables of distances and of volumes name the algorithms of a pair in turn.
  std::vector<std::string> pairs;
  for (const WideLine& line : lines) {
    if (std::ranges::find(pairs, line.pair) == pairs.end()) pairs.push_back(line.pair);
  }
  std::ranges::stable_sort(lines, {}, [&](const WideLine& line) { return std::ranges::find(pairs, line.pair); });
  return lines;
}

std::string time_cell(const RankedRow& ranked) {
  if (ranked.is_error()) return "error";
  const auto mean = ranked.group->value(results::k_processor_mean), p99 = ranked.group->value("p99_ns");
  return fmt::format("{}{} / {}", ranked.mark(), mean ? as_microseconds(*mean) : "-",
                     p99 ? as_microseconds(*p99) : "-");
}

std::string cell(std::optional<double> value, std::string (*format)(double)) { return value ? format(*value) : "-"; }

constexpr const char* k_own_value = "gamma_own_F_deg";

/// How wrong the answers are, over all buckets.
struct ErrorColumn {
  const char* title;
  std::string (*text)(const WideLine&);
};

std::string law_cell(const WideLine& line) {
  const std::string& law = line.rows.begin()->second->group->fields().law;
  return law.empty() ? "-" : law;
}

/// @param own whether rows are compared with the laws of their algorithms
std::vector<ErrorColumn> error_columns(const std::string& query, bool own) {
  if (query == "distance") {
    return {{"error max, diagonals", [](const WideLine& line) { return cell(line.largest("error_max"), as_small); }}};
  }
  if (query == results::k_cast) {
    return {{"missed", [](const WideLine& line) { return cell(line.largest("missed_hits"), as_count); }},
            {"late", [](const WideLine& line) { return cell(line.largest("late_hits"), as_count); }},
            {"early", [](const WideLine& line) { return cell(line.largest("early"), as_count); }}};
  }
  if (query != "respond") return {};
  std::vector<ErrorColumn> columns;
  if (own) {
    columns = {{"law", law_cell},
               {"own angle", [](const WideLine& line) { return cell(line.mean(k_own_value), as_degrees); }}};
  }
  const std::vector<ErrorColumn> to_exact{
      {"angle", [](const WideLine& line) { return cell(line.mean("gamma_F_deg"), as_degrees); }},
      {"angle max", [](const WideLine& line) { return cell(line.largest("gamma_max_F_deg"), as_degrees); }},
      {"magn., %", [](const WideLine& line) { return cell(line.mean("magnitude_error_F"), as_percent); }},
      {"torque angle", [](const WideLine& line) { return cell(line.mean("gamma_T_deg"), as_degrees); }}};
  columns.insert(columns.end(), to_exact.begin(), to_exact.end());
  return columns;
}

/// "3 of 640 failed, 2 of 637 wrong": sums over the buckets, those with equal words together.
std::string faults_cell(const WideLine& line) {
  std::vector<Fault> sums;
  for (const auto& [bucket, ranked] : line.rows) {
    for (const Fault& fault : ranked->group->faults) add_fault(sums, fault);
  }
  return results::to_string(sums);
}

std::string configurations_cell(const WideLine& line) {
  const auto least = line.fold("configurations", [](double a, double b) { return std::min(a, b); });
  const auto largest = line.largest("configurations");
  if (!least) return "-";
  return *least == *largest ? as_count(*least) : fmt::format("{:.0f}..{:.0f}", *least, *largest);
}

}  // namespace

std::vector<Sheet> wide_sheets_of(const std::vector<ResultTable>& tables) {
  std::vector<std::pair<std::string, std::string>> kinds;  // class and query
  for (const ResultTable& table : tables) {
    const std::pair kind(table.apart, table.query);
    if (std::ranges::find(kinds, kind) == kinds.end()) kinds.push_back(kind);
  }
  std::ranges::stable_sort(kinds, {}, [](const auto& kind) { return !kind.first.empty(); });
  std::vector<Sheet> sheets;
  for (const auto& [apart, query] : kinds) {
    std::vector<const ResultTable*> of_query;
    std::set<BucketKey> buckets;
    for (const ResultTable& table : tables) {
      if (table.query != query || table.apart != apart) continue;
      of_query.push_back(&table);
      for (const TableLine& line : table.lines) buckets.insert(line.bucket);
    }
    const std::vector<WideLine> lines = lines_of(of_query);
    const bool own =
        std::ranges::any_of(lines, [](const WideLine& line) { return line.mean(k_own_value).has_value(); });
    const std::vector<ErrorColumn> errors = error_columns(query, own);
    Sheet& sheet = sheets.emplace_back();
    sheet.title = apart.empty() ? query : fmt::format("{}, {}", query, apart);
    sheet.title += ": cpu mean / wall clock p99, us";
    sheet.columns = {{"", "pair", true}, {"", "algorithm", true}, {"", "n"}};
    for (const BucketKey bucket : buckets) sheet.columns.push_back({to_string(bucket.kind), bucket_text(bucket)});
    for (const ErrorColumn& column : errors) {
      sheet.columns.push_back({"", column.title, column.text == law_cell});
    }
    sheet.columns.push_back({"", "faults", true});
    for (const WideLine& line : lines) {
      auto& cells = sheet.lines.emplace_back(std::vector{line.pair, line.label, configurations_cell(line)});
      for (const BucketKey bucket : buckets) {
        const auto found = line.rows.find(bucket);
        cells.push_back(found == line.rows.end() ? "-" : time_cell(*found->second));
      }
      for (const ErrorColumn& column : errors) cells.push_back(column.text(line));
      cells.push_back(faults_cell(line));
    }
  }
  return sheets;
}

}  // namespace sixdof::cli
