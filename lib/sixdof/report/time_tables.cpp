#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include <sixdof/query/variant.h>
#include <sixdof/report/tables.h>
#include <sixdof/results/resolution.h>

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
  std::string label;  ///< The algorithm with its resolution in parentheses.
  std::optional<double> low, high, repetitions;
  std::string faults, command, worst_pose;
};

/// Resolutions by file, pair and algorithm.
using Resolutions = std::map<std::tuple<std::size_t, std::string, std::string>, std::string>;

Resolutions resolutions_of(const std::vector<RowGroup>& groups) {
  Resolutions found;
  std::map<std::tuple<std::size_t, std::string, std::string>, std::size_t> uses;
  const auto label = [](const RowFields& fields, const std::string& resolution) {
    return base_name(fields.algorithm) + " " + resolution;
  };
  for (const RowGroup& group : groups) {
    const RowFields& fields = group.fields();
    if (fields.query != "prepare" || !group.row().error.empty()) continue;
    const std::string resolution = resolution_text(group);
    found[{group.row().file, fields.pair, fields.algorithm}] = resolution;
    ++uses[{group.row().file, fields.pair, label(fields, resolution)}];
  }
  for (const RowGroup& group : groups) {
    // Variants that differ in something else keep their settings.
    const RowFields& fields = group.fields();
    const auto mine = found.find({group.row().file, fields.pair, fields.algorithm});
    if (mine == found.end() || fields.query != "prepare") continue;
    if (uses[{group.row().file, fields.pair, label(fields, mine->second)}] > 1) mine->second.clear();
  }
  return found;
}

std::vector<TimeLine> lines_of(const Results& results, const RowGroup& group, const Resolutions& resolutions) {
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
  line.label = line.algorithm;
  const auto resolution = resolutions.find({row.file, row.fields.pair, row.fields.algorithm});
  if (resolution != resolutions.end() && !resolution->second.empty()) {
    line.label = fmt::format("{} ({}){}", base_name(row.fields.algorithm), resolution->second,
                             line.algorithm.substr(row.fields.algorithm.size()));
  }
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
                       .label = algorithm,
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

/// Where a bucket stands on one axis from bodies far apart to deep overlaps: -30 to 0 for distances of 30 to 0 %, 0 to
/// 30 for volumes of 0 to 10 %, which are drawn three times as wide.
double place_of_bucket(const TimeLine& line) {
  constexpr double k_volume_scale = 3.0;
  return line.kind == to_string(BucketKind::distance) ? -line.percent : k_volume_scale * line.percent;
}

Cell optional_cell(std::optional<double> value) { return value ? Cell(*value) : Cell(); }

}  // namespace

DataTable times_table(const Results& results, const std::vector<RowGroup>& groups) {
  const Resolutions resolutions = resolutions_of(groups);
  std::vector<TimeLine> lines;
  for (const RowGroup& group : groups) {
    if (!group.fields().bucket || group.fields().pair.empty() || group.fields().query == k_cast) continue;
    for (TimeLine& line : lines_of(results, group, resolutions)) lines.push_back(std::move(line));
  }
  std::vector<TimeLine> means = means_over_pairs(lines);
  lines.insert(lines.begin(), means.begin(), means.end());
  DataTable table{.name = "times",
                  .title = "Times of queries on buckets",
                  .columns = {"run", "query", "bucket", "pair", "statistic", "algorithm", "percent", "time_us",
                              "low_us", "high_us", "repetitions", "faults", "command", "worst_pose", "label", "place"},
                  .rows = {}};
  for (const TimeLine& line : lines) {
    table.rows.push_back({line.run, line.query, line.kind, line.pair, line.statistic, line.algorithm, line.percent,
                          line.us, optional_cell(line.low), optional_cell(line.high), optional_cell(line.repetitions),
                          line.faults, line.command, line.worst_pose, line.label, place_of_bucket(line)});
  }
  return table;
}

}  // namespace sixdof::report
