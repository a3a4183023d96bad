#include <algorithm>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include <sixdof/measure/metrics.h>
#include "bench/cli/table.h"

namespace sixdof::cli {
namespace {

/// Answers with constants, some of which are right, so that counts alone do not tell.
constexpr const char* k_null_algorithm = "null";

/// Faults that a row's own counts show.
std::vector<Fault> own_faults(const ResultRow& row) {
  if (!row.error.empty()) return {{.what = "not run: " + row.error}};
  const std::uint64_t asked = row.count("configurations"), failed = row.count("failed");
  std::vector<Fault> faults;
  for (const Fault& fault :
       {Fault{"failed", failed, asked}, Fault{"crashed", row.count("crashed"), asked},
        Fault{"timed out", row.count("timed_out"), asked}, Fault{"out of memory", row.count("out_of_memory"), asked},
        Fault{"wrong", row.count("mismatch"), row.count("judged")},
        Fault{"without a force though the bodies overlap", row.count("misses"), asked - std::min(asked, failed)}}) {
    if (fault.count > 0) faults.push_back(fault);
  }
  return faults;
}

bool is_total(const Fault& fault) { return fault.of > 0 && fault.count == fault.of; }

/// Pair, query and algorithm.
using Subject = std::tuple<std::string, std::string, std::string>;

Subject subject_of(const ResultRow& row) { return {row.fields.pair, row.fields.query, row.fields.algorithm}; }

/// Where every answer is at fault: the first such bucket.
std::map<Subject, BucketKey> find_constant_answers(const ResultFile& file) {
  std::map<Subject, BucketKey> found;
  for (const ResultRow& row : file.rows) {
    if (std::ranges::any_of(own_faults(row), is_total)) found.try_emplace(subject_of(row), *row.fields.bucket);
  }
  return found;
}

std::vector<Fault> faults_of(const ResultRow& row, const std::map<Subject, BucketKey>& constant_answers) {
  std::vector<Fault> faults = own_faults(row);
  if (row.fields.algorithm == k_null_algorithm) faults.push_back({.what = "measures the harness, answers constants"});
  const auto constant = constant_answers.find(subject_of(row));
  if (faults.empty() && constant != constant_answers.end()) {
    const BucketKey bucket = constant->second;
    faults.push_back(
        {.what = fmt::format("no right answer at {} {} %", to_string(bucket.kind), bucket.percent_text())});
  }
  return faults;
}

template <class List, class Matches, class Make>
auto& find_or_add(List& list, Matches matches, Make make) {
  const auto found = std::ranges::find_if(list, matches);
  return found != list.end() ? *found : list.emplace_back(make());
}

/// The tables with all lines, in the order in which the files name them; nothing is ranked.
std::vector<ResultTable> align(const std::vector<ResultFile>& files) {
  std::vector<ResultTable> tables;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::map<Subject, BucketKey> constant_answers = find_constant_answers(files[i]);
    for (const ResultRow& row : files[i].rows) {
      const RowFields& fields = row.fields;
      // Answers about other bodies stand in tables of their own.
      const std::string pair = fields.body.empty() ? fields.pair : fmt::format("{} ({})", fields.pair, fields.body);
      ResultTable& table = find_or_add(
          tables,
          [&](const ResultTable& t) {
            return t.pair == pair && t.query == fields.query && t.kind == fields.bucket->kind;
          },
          [&] {
            return ResultTable{pair, fields.query, fields.bucket->kind, {}};
          });
      TableLine& line = find_or_add(
          table.lines,
          [&](const TableLine& l) {
            return l.bucket == *fields.bucket && l.algorithm == fields.algorithm && l.order == fields.order &&
                   l.cache == fields.cache;
          },
          [&] {
            return TableLine{*fields.bucket, fields.algorithm, fields.order, fields.cache,
                             std::vector<RankedRow>(files.size())};
          });
      line.files[i].row = &row;
      line.files[i].faults = faults_of(row, constant_answers);
    }
  }
  return tables;
}

/// By bucket; within a bucket, orders of configurations and states of the caches apart, algorithms as they first occur.
void sort_lines(ResultTable& table) {
  std::vector<std::string> algorithms;
  for (const TableLine& line : table.lines) {
    if (std::ranges::find(algorithms, line.algorithm) == algorithms.end()) algorithms.push_back(line.algorithm);
  }
  const auto place = [&](const TableLine& line) {
    const bool random = line.order == "random" || line.order.empty();
    return std::tuple(line.bucket, !random, line.cache != "warm",
                      std::ranges::find(algorithms, line.algorithm) - algorithms.begin());
  };
  std::ranges::sort(table.lines, {}, place);
}

/// Both rows have a processor time.
bool is_faster(const ResultRow& row, const ResultRow& other) {
  return is_better(find_metric("cpu_time")->better, *row.value(k_processor_mean), *other.value(k_processor_mean));
}

/// Marks the fastest row of every bucket and order in one file, among those with a processor time: not on cold caches.
void mark_fastest(ResultTable& table, std::size_t file) {
  std::map<std::pair<BucketKey, std::string>, RankedRow*> fastest;
  for (TableLine& line : table.lines) {
    RankedRow& ranked = line.files[file];
    if (ranked.row == nullptr || !ranked.faults.empty() || !ranked.row->value(k_processor_mean)) continue;
    RankedRow*& best = fastest[{line.bucket, line.order}];
    if (best == nullptr || is_faster(*ranked.row, *best->row)) best = &ranked;
  }
  for (const auto& [bucket, ranked] : fastest) ranked->fastest = true;
}

void compare_with_first(TableLine& line) {
  if (line.files.front().row == nullptr) return;
  const std::optional<double> first = line.files.front().row->value(k_processor_mean);
  for (RankedRow& ranked : line.files) {
    if (ranked.row == nullptr) continue;
    const std::optional<double> time = ranked.row->value(k_processor_mean);
    if (first && time && *first > 0.0) ranked.ratio = *time / *first;
  }
}

}  // namespace

std::string to_string(const Fault& fault) {
  return fault.of == 0 ? fault.what : fmt::format("{} of {} {}", fault.count, fault.of, fault.what);
}

std::vector<ResultTable> rank(const std::vector<ResultFile>& files) {
  std::vector<ResultTable> tables = align(files);
  for (ResultTable& table : tables) {
    sort_lines(table);
    for (std::size_t file = 0; file < files.size(); ++file) mark_fastest(table, file);
    for (TableLine& line : table.lines) compare_with_first(line);
  }
  return tables;
}

}  // namespace sixdof::cli
