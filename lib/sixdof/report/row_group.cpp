#include <sixdof/report/row_group.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <boost/math/distributions/students_t.hpp>

namespace sixdof::report {
namespace {

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace

std::string RowGroup::algorithm() const {
  std::string text = row().algorithm;
  if (row().order == "path") text += " (path order)";
  if (row().order == "motion") text += " (motion)";
  if (row().cache == "cold") text += " (cold)";
  return text;
}

bool RowGroup::is_special() const { return row().order == "path" || row().order == "motion" || row().cache == "cold"; }

std::vector<double> RowGroup::all(const std::string& name) const {
  std::vector<double> values;
  for (const Row* const row : repetitions) {
    if (const auto value = row->value(name); value && *value > 0.0) values.push_back(*value);
  }
  return values;
}

std::optional<double> RowGroup::median(const std::string& name) const {
  std::vector<double> values;
  for (const Row* const row : repetitions) {
    if (const auto value = row->value(name)) values.push_back(*value);
  }
  return values.empty() ? std::nullopt : std::optional(median_of(values));
}

std::vector<RowGroup> row_groups(const Results& results) {
  std::vector<RowGroup> groups;
  std::map<std::pair<std::size_t, std::string>, std::size_t> index;
  for (const Row& row : results.rows) {
    const auto [place, is_new] = index.try_emplace({row.file, row.name}, groups.size());
    if (is_new) groups.emplace_back();
    groups[place->second].repetitions.push_back(&row);
  }
  return groups;
}

std::optional<Estimate> processor_time(const RowGroup& group) {
  const std::string name = group.row().cache == "cold" ? k_wall_mean : k_processor_mean;
  const std::vector<double> times = group.all(name);
  if (times.empty()) return std::nullopt;
  const double middle = median_of(times);
  if (times.size() >= k_fewest_repetitions) {
    const auto n = static_cast<double>(times.size());
    double mean = 0.0, squares = 0.0;
    for (const double t : times) mean += std::log(t) / n;
    for (const double t : times) squares += (std::log(t) - mean) * (std::log(t) - mean);
    const double t = boost::math::quantile(boost::math::students_t(n - 1.0), 0.975);
    const double half = t * std::sqrt(squares / (n - 1.0) / n);
    return Estimate{std::exp(mean), std::exp(mean - half), std::exp(mean + half)};
  }
  const auto low = group.row().value(name + "_low"), high = group.row().value(name + "_high");
  if (low && high) return Estimate{middle, *low, *high};
  return Estimate{middle, middle * (1.0 - k_run_to_run), middle * (1.0 + k_run_to_run)};
}

bool is_ranked(const RowGroup& group) {
  return group.row().algorithm != "null" && group.row().body.empty() && faults_of(group.row()).empty();
}

}  // namespace sixdof::report
