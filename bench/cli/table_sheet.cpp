#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/measure/latency.h>
#include "bench/cli/table.h"
#include "bench/cli/table_numbers.h"

namespace sixdof::cli {
namespace {

using results::Fault;

/// Of an algorithm whose faults differ from bucket to bucket, more buckets than this are added up.
constexpr std::size_t k_most_buckets = 4;

/// A column that shows one value of a row.
struct ValueColumn {
  const char* group;
  const char* title;
  const char* value;
  std::string (*format)(double);  ///< Null: a text of the row, its law.
};

constexpr const char* k_processor = "cpu, us";
constexpr const char* k_wall = "wall clock, us";
constexpr const char* k_own_force = "force to its own law";
constexpr const char* k_force = "force to the exact one";
constexpr const char* k_torque = "torque";
constexpr const char* k_distance = "error, diagonals of A";

constexpr ValueColumn k_count{"", "n", "configurations", as_count};
constexpr ValueColumn k_mean{k_processor, "mean", results::k_processor_mean, as_microseconds};
constexpr ValueColumn k_p99{k_wall, "p99", "p99_ns", as_microseconds};
constexpr ValueColumn k_late{"", ">1 ms, %", "over_1ms", as_percent};
constexpr const char* k_own_value = "gamma_own_F_deg";
constexpr ValueColumn k_law{k_own_force, "law", "law", nullptr};
constexpr ValueColumn k_own_angle{k_own_force, "angle", k_own_value, as_degrees};
constexpr ValueColumn k_own_magnitude{k_own_force, "magn., %", "magnitude_error_own_F", as_percent};
constexpr ValueColumn k_angle{k_force, "angle", "gamma_F_deg", as_degrees};
constexpr ValueColumn k_magnitude{k_force, "magn., %", "magnitude_error_F", as_percent};
constexpr const char* k_phantom = "force though apart";
constexpr ValueColumn k_phantoms{k_phantom, "n", "phantoms", as_count};
constexpr ValueColumn k_phantom_max{k_phantom, "max, %", "phantom_force_max", as_percent};
constexpr ValueColumn k_distance_rms{k_distance, "rms", "error_rms", as_small};

/// Whether a row of the table is compared with its algorithm's own law. Older results are not.
bool has_own(const ResultTable& table) {
  return std::ranges::any_of(table.lines, [](const TableLine& line) {
    return std::ranges::any_of(line.files, [](const RankedRow& ranked) {
      return ranked.group != nullptr && ranked.group->value(k_own_value).has_value();
    });
  });
}

/// How wrong the answers to a query are.
std::vector<ValueColumn> error_columns(const std::string& query, BucketKind kind, std::size_t files) {
  if (query == "distance") {
    return files > 1 ? std::vector{k_distance_rms}
                     : std::vector{k_distance_rms, ValueColumn{k_distance, "max", "error_max", as_small}};
  }
  if (query != "respond") return {};
  if (kind == BucketKind::distance) return {k_phantoms, k_phantom_max};
  if (files > 1) return {k_angle, k_magnitude};
  return {k_angle,
          {k_force, "max", "gamma_max_F_deg", as_degrees},
          k_magnitude,
          {k_torque, "angle", "gamma_T_deg", as_degrees},
          {k_torque, "magn., %", "magnitude_error_T", as_percent},
          {"volume", "error, %", "volume_error_mean", as_percent}};
}

/// The more files share the width, the fewer columns has each.
std::vector<ValueColumn> time_columns(std::size_t files) {
  if (files > 2) return {k_mean, k_p99};
  if (files > 1) return {k_count, k_mean, k_p99, k_late};
  return {
      k_count, k_mean, {k_wall, "p50", "p50_ns", as_microseconds}, k_p99, {k_wall, "max", "max_ns", as_microseconds},
      k_late};
}

std::vector<ValueColumn> value_columns(const ResultTable& table, std::size_t files) {
  std::vector<ValueColumn> columns = time_columns(files);
  if (has_own(table)) {
    columns.push_back(files > 1 ? k_own_angle : k_law);
    if (files == 1) columns.insert(columns.end(), {k_own_angle, k_own_magnitude});
  }
  std::ranges::copy(error_columns(table.query, table.kind, files), std::back_inserter(columns));
  return columns;
}

std::string cell_of(const RankedRow& ranked, const ValueColumn& column) {
  if (ranked.group == nullptr) return "-";
  if (ranked.is_error()) return column.value == k_mean.value ? "error" : "-";
  if (column.format == nullptr) {
    const std::string& law = ranked.group->fields().law;
    return law.empty() ? "-" : law;
  }
  const std::optional<double> value = ranked.group->value(column.value);
  return value ? column.format(*value) : "-";
}

/// "[1] " where there are several files.
std::string prefix_of(std::size_t file, std::size_t files) {
  return files > 1 ? fmt::format("[{}] ", file + 1) : std::string();
}

/// Where there are several files, the file stands above a column, and its clock or unit in the title.
std::string brief_title(const ValueColumn& column) {
  if (column.group == std::string(k_processor)) return k_processor;
  if (column.value == k_own_angle.value) return "own angle";
  return column.group == std::string(k_wall) ? fmt::format("{}, us", column.title) : column.title;
}

/// The faults of one algorithm in one file that read the same but for their counts.
struct FaultNote {
  std::string what;
  std::vector<std::pair<BucketKey, Fault>> places;

  std::string text() const {
    // Equal words stand once with all their buckets.
    std::vector<std::pair<std::string, std::vector<std::string>>> groups;
    for (const auto& [bucket, fault] : places) {
      const std::string words = to_string(fault);
      if (groups.empty() || groups.back().first != words) groups.push_back({words, {}});
      groups.back().second.push_back(bucket_text(bucket));
    }
    if (groups.size() > k_most_buckets) return sum();
    std::vector<std::string> texts;
    for (const auto& [words, buckets] : groups) {
      const std::string range =
          buckets.size() <= k_most_buckets
              ? fmt::format("{}", fmt::join(buckets, ", "))
              : fmt::format("{} buckets from {} to {}", buckets.size(), buckets.front(), buckets.back());
      texts.push_back(fmt::format("{} ({})", words, range));
    }
    return fmt::format("{}", fmt::join(texts, ", "));
  }

 private:
  std::string sum() const {
    Fault all{.what = what};
    for (const auto& [bucket, fault] : places) {
      all.count += fault.count;
      all.of += fault.of;
    }
    return fmt::format("{} (sum over {} buckets from {} to {})", to_string(all), places.size(),
                       bucket_text(places.front().first), bucket_text(places.back().first));
  }
};

/// "! vps: 3 of 640 failed (05 %)", one line for each algorithm of each file.
std::vector<std::string> fault_notes(const ResultTable& table, std::size_t files) {
  std::vector<std::string> notes;
  for (std::size_t file = 0; file < files; ++file) {
    std::vector<std::pair<std::string, std::vector<FaultNote>>> by_label;
    for (const TableLine& line : table.lines) {
      if (!line.files[file].has_fault()) continue;
      for (const Fault& fault : line.files[file].group->faults) {
        auto of_label = std::ranges::find(by_label, line.label(), [](const auto& entry) { return entry.first; });
        if (of_label == by_label.end()) of_label = by_label.insert(by_label.end(), {line.label(), {}});
        auto& list = of_label->second;
        auto note = std::ranges::find(list, fault.what, &FaultNote::what);
        if (note == list.end()) note = list.insert(list.end(), {fault.what, {}});
        note->places.emplace_back(line.bucket, fault);
      }
    }
    for (const auto& [label, list] : by_label) {
      std::vector<std::string> texts;
      for (const FaultNote& note : list) texts.push_back(note.text());
      const bool approximate =
          std::ranges::all_of(list, [](const FaultNote& note) { return note.what == results::k_approximate; });
      notes.push_back(
          fmt::format("{} {}{}: {}", approximate ? '~' : '!', prefix_of(file, files), label, fmt::join(texts, "; ")));
    }
  }
  return notes;
}

Sheet sheet_of_one(const ResultTable& table) {
  const std::vector<ValueColumn> values = value_columns(table, 1);
  Sheet sheet;
  sheet.columns = {{"", to_string(table.kind), true}, {"", "", true}, {"", "algorithm", true}};
  for (const ValueColumn& column : values)
    sheet.columns.push_back({column.group, column.title, column.format == nullptr});
  for (const TableLine& line : table.lines) {
    const RankedRow& ranked = line.files.front();
    sheet.lines.push_back({bucket_text(line.bucket), std::string(ranked.mark()), line.label()});
    for (const ValueColumn& column : values) sheet.lines.back().push_back(cell_of(ranked, column));
  }
  return sheet;
}

Sheet sheet_of_several(const ResultTable& table, std::size_t files) {
  const std::vector<ValueColumn> values = value_columns(table, files);
  Sheet sheet;
  sheet.columns = {{"", to_string(table.kind), true}, {"", "algorithm", true}};
  for (std::size_t file = 0; file < files; ++file) {
    const std::string group = fmt::format("[{}]", file + 1);
    sheet.columns.push_back({group, "", true});
    for (const ValueColumn& column : values) {
      sheet.columns.push_back({group, brief_title(column)});
      if (column.value == k_mean.value && file > 0) sheet.columns.push_back({group, "/ [1]"});
    }
  }
  for (const TableLine& line : table.lines) {
    auto& cells = sheet.lines.emplace_back(std::vector{bucket_text(line.bucket), line.label()});
    for (std::size_t file = 0; file < files; ++file) {
      const RankedRow& ranked = line.files[file];
      cells.push_back(std::string(ranked.mark()));
      for (const ValueColumn& column : values) {
        cells.push_back(cell_of(ranked, column));
        if (column.value == k_mean.value && file > 0) {
          cells.push_back(ranked.ratio ? fmt::format("{:.2f}", *ranked.ratio) : "-");
        }
      }
    }
  }
  return sheet;
}

}  // namespace

Sheet sheet_of(const ResultTable& table, const TableInput& input) {
  Sheet sheet = input.files() == 1 ? sheet_of_one(table) : sheet_of_several(table, input.files());
  const char* const percent = table.kind == BucketKind::distance ? "distances in percent of A's box diagonal"
                                                                 : "overlaps in percent of A's volume";
  sheet.title = fmt::format("{}: {}, {}", table.pair, table.query, percent);
  sheet.notes = fault_notes(table, input.files());
  return sheet;
}

std::vector<std::string> lines_above(const TableInput& input) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < input.files(); ++i) {
    const results::Source& file = input.content.files[i];
    std::vector<std::string> facts;
    if (!file.at("date").empty()) facts.push_back(file.at("date"));
    if (!file.at("commit").empty()) facts.push_back("commit " + file.at("commit").substr(0, 12));
    if (file.at("interrupted") == "true") facts.emplace_back("INTERRUPTED: rows are missing");
    lines.push_back(fmt::format("{}{}{}{}", prefix_of(i, input.files()), file.path, facts.empty() ? "" : ": ",
                                fmt::join(facts, ", ")));
  }
  return lines;
}

std::vector<std::string> lines_below(const TableInput& input) {
  std::vector<std::string> lines{
      "n: configurations; cpu: mean processor time of a query in a loop over all of them",
      fmt::format("p50, p99, max: wall clock of single queries, in one pass; p99 from {} configurations on, else -",
                  k_fewest_for_p99),
      ">1 ms: share of these queries over the haptic deadline",
      "own law: what the algorithm's response tends to, judged at 32 configurations at most; depth and way_out: "
      "integrals over B's surface inside A; contacts: of pairs of triangles, judged by depth; volume: the exact "
      "response",
      "angle: mean angle to the exact response, -dV/dx, or to the own law, in degrees; max: the largest",
      "magn.: RMS of |F| - gain |exact F| over the RMS of |F|, with one gain per row; of torques likewise",
      "force though apart: answers with a force, and the largest in percent of the mean force at the least overlap",
      "volume: mean error of the overlap volume; (path): configurations in the grid's own order",
      "(motion): times of successive poses in steps of 0.01 % of A's diagonal, starting at configurations",
      "(cold): data is removed from the caches before each query; wall clock only, not ranked",
      "*: least cpu of its bucket among rows without faults; !: has faults, which stand below its table; ~: "
      "approximate, "
      "not ranked"};
  for (std::size_t i = 0; i < input.files(); ++i) {
    for (const auto& [algorithm, text] : settings_of(input, i)) {
      lines.push_back(
          fmt::format("settings {}{}: {}", prefix_of(i, input.files()), algorithm, text.empty() ? "none" : text));
    }
    std::vector<std::string> others;
    for (const auto& [query, count] : other_rows(input, i)) others.push_back(fmt::format("{} {}", count, query));
    if (!others.empty()) {
      lines.push_back(
          fmt::format("{}rows of other families, not shown: {}", prefix_of(i, input.files()), fmt::join(others, ", ")));
    }
  }
  return lines;
}

}  // namespace sixdof::cli
