#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include <sixdof/report/tables.h>

namespace sixdof::report {
namespace {

constexpr const char* k_mean = "mean";

/// Statistics of single queries, by wall clock; the mean is of processor time.
struct Statistic {
  const char* name;
  const char* value;
  const char* outlier;  ///< The value whose outlier stands for it.
};
constexpr const char* k_slowest = "max_least_ns";
constexpr std::array k_statistics{Statistic{"10th percentile", "p10_ns", k_slowest},
                                  Statistic{"25th percentile", "p25_ns", k_slowest},
                                  Statistic{"median", "p50_ns", k_slowest},
                                  Statistic{"75th percentile", "p75_ns", k_slowest},
                                  Statistic{"90th percentile", "p90_ns", k_slowest},
                                  Statistic{"99th percentile", "p99_ns", k_slowest},
                                  Statistic{"99.9th percentile", "p999_ns", k_slowest},
                                  Statistic{"longest", "max_ns", "max_ns"}};

struct TimeLine {
  std::string run, query, kind, pair, statistic, algorithm;
  std::string apart;  ///< class_of() the row.
  double percent = 0.0, us = 0.0;
  std::optional<double> low, high, repetitions;
  std::string faults, command, worst_pose;
};

std::vector<TimeLine> lines_of(const Results& results, const RowGroup& group) {
  const Row& row = group.row();
  TimeLine line{.run = run_name(results, row.file),
                .query = row.fields.query,
                .kind = to_string(row.fields.bucket->kind),
                .pair = bodies_of(row.fields),
                .statistic = k_mean,
                .algorithm = group.algorithm(),
                .apart = class_of(row.fields),
                .percent = row.fields.bucket->percent,
                .low = {},
                .high = {},
                .repetitions = static_cast<double>(group.repetitions.size()),
                .faults = to_string(mistakes(group.faults)),
                .command = reproduction(row, results.files[row.file]),
                .worst_pose = row.outliers.command_of(k_slowest)};
  std::vector<TimeLine> lines;
  if (const auto time = group.mean_time()) {
    line.us = time->value / 1e3;
    line.low = time->low / 1e3;
    line.high = time->high / 1e3;
    lines.push_back(line);
  }
  line.low = line.high = {};
  for (const Statistic& statistic : k_statistics) {
    const auto ns = group.value(statistic.value);
    if (!ns) continue;
    line.statistic = statistic.name;
    line.us = *ns / 1e3;
    line.worst_pose = row.outliers.command_of(statistic.outlier);
    lines.push_back(line);
  }
  return lines;
}

/// Means over the pairs: comparable between algorithms of one class only, over pairs that all of them have. The worst
/// pose is that of the slowest pair.
std::vector<TimeLine> means_over_pairs(const std::vector<TimeLine>& lines) {
  using Place = std::tuple<std::string, std::string, std::string, std::string, double, std::string>;
  std::map<Place, std::map<std::string, std::map<std::string, const TimeLine*>>> by_place;  // algorithm, pair
  for (const TimeLine& line : lines) {
    if (line.us > 0.0 && line.algorithm != "null") {
      by_place[{line.run, line.query, line.kind, line.statistic, line.percent, line.apart}][line.algorithm][line.pair] =
          &line;
    }
  }
  std::vector<TimeLine> means;
  for (const auto& [place, algorithms] : by_place) {
    std::size_t most = 0;
    for (const auto& [algorithm, pairs] : algorithms) most = std::max(most, pairs.size());
    if (most < 2) continue;
    for (const auto& [algorithm, pairs] : algorithms) {
      if (pairs.size() < most) continue;
      std::vector<double> times;
      const TimeLine* slowest = pairs.begin()->second;
      for (const auto& [pair, line] : pairs) {
        times.push_back(line->us);
        if (line->us > slowest->us) slowest = line;
      }
      const auto [mean, variance, count] = log_moments(times);
      const double spread = std::sqrt(variance);
      const auto& [run, query, kind, statistic, percent, apart] = place;
      means.push_back({.run = run,
                       .query = query,
                       .kind = kind,
                       .pair = apart.empty() ? k_all_objects : fmt::format("{} ({})", k_all_objects, apart),
                       .statistic = statistic,
                       .algorithm = algorithm,
                       .apart = apart,
                       .percent = percent,
                       .us = std::exp(mean),
                       .low = std::exp(mean - spread),
                       .high = std::exp(mean + spread),
                       .repetitions = {},
                       .faults = {},
                       .command = {},
                       .worst_pose = slowest->worst_pose});
    }
  }
  return means;
}

Cell optional_cell(std::optional<double> value) { return value ? Cell(*value) : Cell(); }

}  // namespace

DataTable times_table(const Results& results, const std::vector<RowGroup>& groups) {
  std::vector<TimeLine> lines;
  for (const RowGroup& group : groups) {
    if (!group.fields().bucket || group.fields().pair.empty()) continue;
    for (TimeLine& line : lines_of(results, group)) lines.push_back(std::move(line));
  }
  std::vector<TimeLine> means = means_over_pairs(lines);
  lines.insert(lines.begin(), means.begin(), means.end());
  DataTable table{.name = "times",
                  .title = "Times of queries on buckets",
                  .columns = {"run", "query", "bucket", "pair", "statistic", "algorithm", "percent", "time_us",
                              "low_us", "high_us", "repetitions", "faults", "command", "worst_pose"},
                  .rows = {}};
  for (const TimeLine& line : lines) {
    table.rows.push_back({line.run, line.query, line.kind, line.pair, line.statistic, line.algorithm, line.percent,
                          line.us, optional_cell(line.low), optional_cell(line.high), optional_cell(line.repetitions),
                          line.faults, line.command, line.worst_pose});
  }
  return table;
}

}  // namespace sixdof::report
