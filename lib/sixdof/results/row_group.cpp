#include <sixdof/results/row_group.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace sixdof::results {
namespace {

/// Answers with constants, some of which are right, so that counts alone do not tell.
constexpr const char* k_null_algorithm = "null";

/// The faults of all repetitions; of equal ones that with the largest count.
std::vector<Fault> faults_of_repetitions(const RowGroup& group) {
  std::vector<Fault> faults;
  for (const Row* const row : group.repetitions) {
    for (const Fault& fault : own_faults(*row)) {
      const auto same = std::ranges::find(faults, fault.what, &Fault::what);
      if (same == faults.end()) {
        faults.push_back(fault);
      } else if (fault.count > same->count) {
        *same = fault;
      }
    }
  }
  return faults;
}

/// File, bodies, query and algorithm.
using Subject = std::tuple<std::size_t, std::string, std::string, std::string>;

Subject subject_of(const Row& row) { return {row.file, bodies_of(row.fields), row.fields.query, row.fields.algorithm}; }

/// With the bucket's digits.
std::string words_of_place(const RowFields& fields) {
  if (fields.query == k_cast) return place_of(fields);
  return fmt::format("{} {} %", to_string(fields.bucket->kind), fields.bucket->percent_text());
}

void judge(std::vector<RowGroup>& groups) {
  std::map<Subject, std::string> without_right_answer;  // and where
  for (RowGroup& group : groups) {
    group.faults = faults_of_repetitions(group);
    const auto tells = [&](const Fault& fault) {
      // Forces of approximated bodies that are apart say nothing of those that overlap.
      return fault.is_total() && !(fault.is_approximation() && group.fields().query == "respond");
    };
    if (group.fields().bucket && std::ranges::any_of(group.faults, tells)) {
      without_right_answer.try_emplace(subject_of(group.row()), words_of_place(group.fields()));
    }
  }
  for (RowGroup& group : groups) {
    if (group.fields().algorithm == k_null_algorithm) {
      group.faults.push_back({"returns constants: measures the overhead of the harness", "", 0, 0});
    }
    const auto found = without_right_answer.find(subject_of(group.row()));
    if (!group.faults.empty() || !group.fields().bucket || found == without_right_answer.end()) continue;
    const bool approximate = group.fields().approximates && group.fields().query == "distance";
    group.faults.push_back(
        {approximate ? k_approximate : fmt::format("no right answer at {}", found->second), "", 0, 0});
  }
}

std::map<std::string, double> values_of(const RowGroup& group) {
  std::map<std::string, std::vector<double>> all;
  for (const Row* const row : group.repetitions) {
    for (const auto& [name, value] : row->values) all[name].push_back(value);
  }
  std::map<std::string, double> values;
  for (auto& [name, list] : all) values[name] = list.size() == 1 ? list.front() : median(std::move(list));
  for (const char* const name : {k_processor_mean, k_wall_mean}) {
    const std::vector<double> times = group.all(name);
    if (times.size() > 1) values[name] = mean_of_repetitions(times).value;
  }
  return values;
}

}  // namespace

const Row& RowGroup::row() const {
  const auto ran = std::ranges::find_if(repetitions, [](const Row* row) { return row->error.empty(); });
  return ran == repetitions.end() ? *repetitions.front() : **ran;
}

std::optional<double> RowGroup::value(const std::string& name) const {
  const auto found = values.find(name);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

std::optional<Estimate> RowGroup::estimate(const std::string& name) const {
  return Row{.name = {}, .values = values}.estimate(name);
}

std::optional<Estimate> RowGroup::mean_time() const {
  const std::string name = fields().cache == "cold" ? k_wall_mean : k_processor_mean;
  const std::vector<double> times = all(name);
  if (times.empty()) return std::nullopt;
  const bool has_interval = times.size() == 1 && values.contains(name + "_low") && values.contains(name + "_high");
  return has_interval ? estimate(name) : mean_of_repetitions(times);
}

std::vector<double> RowGroup::all(const std::string& name) const {
  std::vector<double> list;
  for (const Row* const row : repetitions) {
    if (const auto value = row->value(name); value && *value > 0.0) list.push_back(*value);
  }
  return list;
}

std::string RowGroup::algorithm() const {
  std::string text = fields().algorithm;
  if (fields().order == "path") text += " (path order)";
  if (fields().order == "motion") text += " (motion)";
  if (fields().cache == "cold") text += " (cold)";
  return text;
}

bool RowGroup::is_special() const {
  return fields().order == "path" || fields().order == "motion" || fields().cache == "cold";
}

std::vector<RowGroup> row_groups(const Results& results) {
  std::vector<RowGroup> groups;
  std::map<std::pair<std::size_t, std::string>, std::size_t> index;
  for (const Row& row : results.rows) {
    const auto [place, is_new] = index.try_emplace({row.file, row.name}, groups.size());
    if (is_new) groups.emplace_back();
    groups[place->second].repetitions.push_back(&row);
  }
  for (RowGroup& group : groups) group.values = values_of(group);
  judge(groups);
  return groups;
}

}  // namespace sixdof::results
