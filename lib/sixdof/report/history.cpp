#include <sixdof/report/history.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include <fmt/format.h>

#include <boost/math/statistics/univariate_statistics.hpp>

namespace sixdof::report {
namespace {

/// Least standard deviation of the logarithm of a mean between two runs of the same program.
constexpr double k_least_noise = 0.03;

double mean_of(std::span<const double> values) { return boost::math::statistics::mean(values.begin(), values.end()); }

/// Standard deviation of one value, from the median of the neighbouring differences.
double noise_of(const std::vector<double>& values) {
  std::vector<double> differences;
  for (std::size_t k = 1; k < values.size(); ++k) differences.push_back(std::abs(values[k] - values[k - 1]));
  if (differences.empty()) return k_least_noise;
  constexpr double k_normal =
      1.4826 / 1.4142135623730951;  // of a normal distribution; a difference has two values' noise
  return std::max(k_least_noise, k_normal * median(std::move(differences)));
}

void search(std::span<const double> values, std::size_t offset, double noise, std::vector<std::size_t>& found) {
  std::size_t best = 0;
  double most = k_change_standard_errors;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double difference = std::abs(mean_of(values.subspan(k)) - mean_of(values.first(k)));
    if (difference <= std::log(k_least_factor)) continue;
    const auto before = static_cast<double>(k), after = static_cast<double>(values.size() - k);
    const double errors = difference / (noise * std::sqrt(1.0 / before + 1.0 / after));
    if (errors > most) {
      most = errors;
      best = k;
    }
  }
  if (best == 0) return;
  search(values.first(best), offset, noise, found);
  found.push_back(offset + best);
  search(values.subspan(best), offset + best, noise, found);
}

/// What must be the same for times to be compared.
std::string machine_of(const Source& file) {
  std::string text;
  for (const char* const key : {"host_name", "cpu_model", "num_cpus", "mhz_per_cpu", "sixdof_build"}) {
    text += file.at(key) + "\n";
  }
  return text;
}

/// One row over the files.
struct Track {
  const Row* row;
  std::string algorithm;
  std::vector<std::pair<std::size_t, double>> values;  ///< File and time in us.
};

std::vector<Track> tracks_of(const std::vector<RowGroup>& groups) {
  std::vector<Track> tracks;
  std::map<std::string, std::size_t> index;
  for (const RowGroup& group : groups) {
    const auto time = group.mean_time();
    if (!time || group.fields().algorithm == "null") continue;
    const auto [place, is_new] = index.try_emplace(group.row().name, tracks.size());
    if (is_new) tracks.push_back({&group.row(), group.algorithm(), {}});
    tracks[place->second].values.emplace_back(group.row().file, time->value / 1e3);
  }
  return tracks;
}

/// Factor to the level before, by index in the track's values; the stretches are searched one by one.
std::map<std::size_t, double> changes_of(const Track& track, const std::vector<std::size_t>& stretch_of_file) {
  std::map<std::size_t, double> changes;
  for (std::size_t first = 0; first < track.values.size();) {
    std::size_t last = first;
    std::vector<double> logarithms;
    while (last < track.values.size() &&
           stretch_of_file[track.values[last].first] == stretch_of_file[track.values[first].first]) {
      logarithms.push_back(std::log(track.values[last++].second));
    }
    std::vector<std::size_t> points = change_points(logarithms);
    points.push_back(logarithms.size());
    for (std::size_t k = 0, begin = 0; k + 1 < points.size(); begin = points[k++]) {
      const std::span all(logarithms);
      const double before = mean_of(all.subspan(begin, points[k] - begin));
      const double after = mean_of(all.subspan(points[k], points[k + 1] - points[k]));
      changes[first + points[k]] = std::exp(after - before);
    }
    first = last;
  }
  return changes;
}

}  // namespace

std::vector<std::size_t> change_points(const std::vector<double>& logarithms) {
  std::vector<std::size_t> found;
  if (logarithms.size() > 1) search(logarithms, 0, noise_of(logarithms), found);
  return found;
}

DataTable history_table(const Results& results, const std::vector<RowGroup>& groups) {
  DataTable table{.name = "history",
                  .title = "Mean processor time over the runs",
                  .columns = {"query", "pair", "bucket", "algorithm", "number", "date", "commit", "machine", "time_us",
                              "change", "row"},
                  .rows = {}};
  std::vector<std::size_t> stretch_of_file(results.files.size(), 0);
  for (std::size_t file = 1; file < results.files.size(); ++file) {
    const bool is_same = machine_of(results.files[file]) == machine_of(results.files[file - 1]);
    stretch_of_file[file] = stretch_of_file[file - 1] + (is_same ? 0 : 1);
  }
  for (const Track& track : tracks_of(groups)) {
    const std::map<std::size_t, double> changes = changes_of(track, stretch_of_file);
    const Row& row = *track.row;
    for (std::size_t k = 0; k < track.values.size(); ++k) {
      const auto& [file, us] = track.values[k];
      const auto change = changes.find(k);
      table.rows.push_back({row.fields.query, row.fields.pair, place_of(row.fields), track.algorithm,
                            static_cast<double>(file + 1), results.files[file].at("date").substr(0, 16),
                            results.files[file].at("commit").substr(0, 12),
                            fmt::format("machine {}", stretch_of_file[file] + 1), us,
                            change == changes.end() ? Cell() : Cell(change->second), row.name});
    }
  }
  return table;
}

}  // namespace sixdof::report
