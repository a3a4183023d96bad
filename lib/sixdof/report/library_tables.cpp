#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include <sixdof/report/tables.h>

namespace sixdof::report {
namespace {

constexpr const char* k_reference = "exact";

/// What one algorithm did with one kind of query: all rows on buckets at random poses with warm caches.
struct Line {
  std::string version;
  std::set<std::string> pairs;
  std::vector<double> mean_us, p99_us, over_exact;
  double empty_us = 0.0, asked = 0.0, wrong = 0.0, unanswered = 0.0;
  double angles = 0.0, rows_with_angle = 0.0, distance_error = 0.0;
};

/// The reference asked the same: by file, query, pair, bucket.
using Place = std::tuple<std::size_t, std::string, std::string, std::string>;

Place place_of_row(const RowGroup& group) {
  return {group.row().file, group.fields().query, group.fields().pair, place_of(group.fields())};
}

std::map<Place, double> reference_times(const std::vector<RowGroup>& groups) {
  std::map<Place, double> times;
  for (const RowGroup& group : groups) {
    if (!group.fields().bucket || group.is_special() || group.fields().algorithm != k_reference) continue;
    if (const auto time = group.mean_time()) times[place_of_row(group)] = time->value;
  }
  return times;
}

double counted(const RowGroup& group, const std::string& counter) {
  double sum = 0.0;
  for (const Fault& fault : group.faults) {
    if (fault.counter == counter) sum += static_cast<double>(fault.count);
  }
  return sum;
}

void add(const RowGroup& group, const std::map<Place, double>& reference, Line& line) {
  line.pairs.insert(group.fields().pair);
  if (const auto time = group.mean_time()) {
    line.mean_us.push_back(time->value / 1e3);
    const auto same = reference.find(place_of_row(group));
    if (same != reference.end()) line.over_exact.push_back(time->value / same->second);
  }
  if (const auto p99 = group.value("p99_ns")) line.p99_us.push_back(*p99 / 1e3);
  line.empty_us = std::max(line.empty_us, group.count("empty_call_ns") / 1e3);
  line.asked += group.count("configurations");
  line.wrong += counted(group, "mismatch") + counted(group, "misses");
  line.unanswered += counted(group, "failed");
  if (const auto angle = group.value("gamma_F_deg")) {
    line.angles += *angle;
    line.rows_with_angle += 1.0;
  }
  line.distance_error = std::max(line.distance_error, group.count("error_max"));
}

Cell mean_cell(const std::vector<double>& values) { return values.empty() ? Cell() : Cell(geometric_mean(values)); }

Cell positive_cell(double value) { return value > 0.0 ? Cell(value) : Cell(); }

}  // namespace

DataTable libraries_table(const Results& results, const std::vector<RowGroup>& groups) {
  const std::map<Place, double> reference = reference_times(groups);
  using Key = std::tuple<std::size_t, std::string, std::string, std::string>;  // file, class, query, algorithm
  std::map<Key, Line> lines;
  for (const RowGroup& group : groups) {
    const RowFields& fields = group.fields();
    if (!fields.bucket || fields.pair.empty() || group.is_special() || fields.algorithm == "null") continue;
    add(group, reference, lines[{group.row().file, class_of(fields), fields.query, fields.algorithm}]);
  }
  DataTable table{
      .name = "libraries",
      .title = "Each library and kind of query: time, right answers, errors",
      .columns = {"run", "class", "query", "algorithm", "version", "pairs", "rows", "mean_us", "p99_us", "over_exact",
                  "empty_call_us", "asked", "wrong", "unanswered", "force_angle_deg", "largest_distance_error"},
      .rows = {}};
  for (const auto& [key, line] : lines) {
    const auto& [file, apart, query, algorithm] = key;
    table.rows.push_back({run_name(results, file), apart.empty() ? std::string("native") : apart, query, algorithm,
                          results.files[file].at("algorithm:" + algorithm), static_cast<double>(line.pairs.size()),
                          static_cast<double>(line.mean_us.size()), mean_cell(line.mean_us), mean_cell(line.p99_us),
                          mean_cell(line.over_exact), positive_cell(line.empty_us), line.asked, line.wrong,
                          line.unanswered,
                          line.rows_with_angle > 0.0 ? Cell(line.angles / line.rows_with_angle) : Cell(),
                          positive_cell(line.distance_error)});
  }
  return table;
}

}  // namespace sixdof::report
