#include <algorithm>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/results/contest.h>
#include "bench/cli/table.h"
#include "bench/cli/table_numbers.h"

namespace sixdof::cli {
namespace {

/// First places of the words in a list.
std::size_t place_in(const std::vector<std::string>& list, const std::string& word) {
  return static_cast<std::size_t>(std::ranges::find(list, word) - list.begin());
}

template <class List, class Matches, class Make>
auto& find_or_add(List& list, Matches matches, Make make) {
  const auto found = std::ranges::find_if(list, matches);
  return found != list.end() ? *found : list.emplace_back(make());
}

/// By bucket; within a bucket, orders of configurations and states of the caches apart, algorithms as they first occur.
/// Casts by motion, as they first occur.
void sort_lines(ResultTable& table) {
  std::vector<std::string> algorithms, motions;
  for (const TableLine& line : table.lines) {
    if (std::ranges::find(algorithms, line.algorithm) == algorithms.end()) algorithms.push_back(line.algorithm);
    if (line.is_cast && std::ranges::find(motions, line.order) == motions.end()) motions.push_back(line.order);
  }
  const auto place = [&](const TableLine& line) {
    const bool random = line.order == "random" || line.order.empty();
    return std::tuple(line.bucket, !random, place_in(motions, line.order), line.cache != "warm",
                      place_in(algorithms, line.algorithm));
  };
  std::ranges::sort(table.lines, {}, place);
}

void compare_with_first(TableLine& line) {
  if (line.files.front().group == nullptr) return;
  const std::optional<double> first = line.files.front().group->value(results::k_processor_mean);
  for (RankedRow& ranked : line.files) {
    if (ranked.group == nullptr) continue;
    const std::optional<double> time = ranked.group->value(results::k_processor_mean);
    if (first && time && *first > 0.0) ranked.ratio = *time / *first;
  }
}

}  // namespace

std::string TableLine::place() const {
  if (is_cast) return results::place_of({.query = results::k_cast, .algorithm = algorithm, .order = order});
  return bucket_text(bucket);
}

TableInput::TableInput(const std::vector<std::string>& files, bool rows_only) {
  for (const std::string& file : files) {
    results::read_results(file, content);
    if (rows_only && content.files.back().kind != "rows") {
      throw BadFile(file, "not a result file of sixdof-bench: it has no array \"benchmarks\"");
    }
  }
  groups = results::row_groups(content);
}

std::map<std::string, std::size_t> other_rows(const TableInput& input, std::size_t file) {
  std::map<std::string, std::size_t> counts;
  for (const results::Row& row : input.content.rows) {
    if (row.file == file && !row.fields.bucket) ++counts[row.fields.query];
  }
  return counts;
}

std::map<std::string, std::string> settings_of(const TableInput& input, std::size_t file) {
  std::map<std::string, std::string> settings;
  for (const results::Row& row : input.content.rows) {
    if (row.file == file && row.fields.bucket) settings[row.fields.algorithm] = row.fields.settings;
  }
  return settings;
}

std::vector<ResultTable> tables_of(const TableInput& input) {
  std::set<const results::RowGroup*> winners;
  for (const results::Contest& contest : results::contests(input.groups)) winners.insert(&contest.winner());
  std::vector<ResultTable> tables;
  for (const results::RowGroup& group : input.groups) {
    const results::RowFields& fields = group.fields();
    if (!fields.bucket) continue;
    // Answers about other bodies, and those of interpreted algorithms, stand in tables of their own.
    const std::string pair = bodies_of(fields);
    ResultTable& table = find_or_add(
        tables,
        [&](const ResultTable& t) {
          return t.pair == pair && t.query == fields.query && t.kind == fields.bucket->kind;
        },
        [&] {
          return ResultTable{pair, fields.query, fields.bucket->kind, class_of(fields), {}};
        });
    TableLine& line = find_or_add(
        table.lines,
        [&](const TableLine& l) {
          return l.bucket == *fields.bucket && l.algorithm == fields.algorithm && l.order == fields.order &&
                 l.cache == fields.cache;
        },
        [&] {
          return TableLine{*fields.bucket,
                           fields.algorithm,
                           fields.order,
                           fields.cache,
                           fields.query == results::k_cast,
                           std::vector<RankedRow>(input.files())};
        });
    line.files[group.row().file] = {.group = &group, .fastest = winners.contains(&group), .ratio = {}};
  }
  for (ResultTable& table : tables) {
    sort_lines(table);
    for (TableLine& line : table.lines) compare_with_first(line);
  }
  return tables;
}

}  // namespace sixdof::cli
