#include <sixdof/results/difference.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

namespace sixdof::results {
namespace {

using Ranges = std::map<std::string, Range>;

/// Everything but times, over the repetitions.
Ranges ranges_of(const RowGroup& group) {
  Ranges ranges;
  for (const Row* const row : group.repetitions) {
    for (const auto& [name, value] : row->values) {
      const bool is_mean = name.starts_with(k_processor_mean) || name.starts_with(k_wall_mean);
      if (is_mean || kind_of(name) == MetricKind::time) continue;
      Range& range = ranges.try_emplace(name, value, value).first->second;
      range = {std::min(range.least, value), std::max(range.largest, value)};
    }
  }
  return ranges;
}

std::string error_of(const RowGroup& group) {
  for (const Row* const row : group.repetitions) {
    if (!row->error.empty()) return row->error;
  }
  return {};
}

std::optional<Range> range_of(const Ranges& ranges, const std::string& name) {
  const auto found = ranges.find(name);
  return found == ranges.end() ? std::nullopt : std::optional(found->second);
}

void compare(const std::string& row, const RowGroup& before, const RowGroup& after, double relative,
             std::vector<Difference>& found) {
  const std::string error_before = error_of(before), error_after = error_of(after);
  if (!error_before.empty() || !error_after.empty()) {
    if (error_before != error_after) {
      found.push_back({row, "error", MetricKind::answer, {}, {}, error_before, error_after});
    }
    return;
  }
  const Ranges left = ranges_of(before), right = ranges_of(after);
  const auto compare_value = [&](const std::string& name) {
    const auto a = range_of(left, name), b = range_of(right, name);
    const bool is_other = a && b ? differ(*a, *b, relative) : a.has_value() != b.has_value();
    if (is_other) found.push_back({row, name, kind_of(name), a, b});
    return is_other;
  };
  for (const char* const asked : {"configurations", "steps"}) {
    if (compare_value(asked)) return;
  }
  std::set<std::string> names;
  for (const Ranges* const side : {&left, &right}) {
    for (const auto& [name, range] : *side) names.insert(name);
  }
  for (const std::string& name : names) compare_value(name);
}

/// A key of the context that says what answers and times depend on.
bool is_version(const std::string& key) {
  constexpr std::array k_keys{"sixdof_version", "commit",     "commit_dirty", "compiler",
                              "flags",          "build_type", "cpu_model",    "host_name"};
  constexpr std::array k_prefixes{"version:", "algorithm:", "settings:", "mesh:", "set:"};
  return std::ranges::find(k_keys, key) != k_keys.end() || key.ends_with("_build") ||
         std::ranges::any_of(k_prefixes, [&](const char* prefix) { return key.starts_with(prefix); });
}

std::vector<Changed> changed_versions(const Source& before, const Source& after) {
  std::vector<Changed> changed;
  for (const Source* const side : {&before, &after}) {
    for (const auto& [key, value] : side->context) {
      const bool is_known = std::ranges::find(changed, key, &Changed::key) != changed.end();
      if (is_version(key) && !is_known && before.at(key) != after.at(key)) {
        changed.push_back({key, before.at(key), after.at(key)});
      }
    }
  }
  return changed;
}

std::string text_of(const std::optional<Range>& range, const std::string& error, int digits) {
  if (!range) return error.empty() ? "none" : error;
  return range->least == range->largest
             ? fmt::format("{:.{}g}", range->least, digits)
             : fmt::format("{:.{}g} to {:.{}g}", range->least, digits, range->largest, digits);
}

}  // namespace

bool differ(const Range& before, const Range& after, double relative) {
  const double gap = std::max(after.least - before.largest, before.least - after.largest);
  const double size =
      std::max({std::abs(before.least), std::abs(before.largest), std::abs(after.least), std::abs(after.largest)});
  return gap > k_rounding + relative * size || !std::isfinite(size);
}

std::string to_string(const Difference& difference) {
  constexpr int k_usual_digits = 6, k_all_digits = 17;
  std::string before, after;
  for (int digits = k_usual_digits; digits <= k_all_digits && before == after; ++digits) {
    before = text_of(difference.before, difference.error_before, digits);
    after = text_of(difference.after, difference.error_after, digits);
  }
  return before + " -> " + after;
}

std::optional<bool> is_worse(const Difference& difference) {
  if (difference.counter == "error") return !difference.error_after.empty();
  const Metric* const metric = find_metric(difference.counter);
  if (metric == nullptr) return std::nullopt;
  const double before = difference.before ? difference.before->largest : 0.0;
  const double after = difference.after ? difference.after->largest : 0.0;
  if (is_better(metric->better, before, after)) return true;
  return is_better(metric->better, after, before) ? std::optional(false) : std::nullopt;
}

std::size_t Differences::changed_answers() const {
  return static_cast<std::size_t>(std::ranges::count(values, MetricKind::answer, &Difference::kind));
}

Differences differences(const Results& results, std::span<const RowGroup> groups, std::size_t before, std::size_t after,
                        double relative) {
  Differences found{.versions = changed_versions(results.files[before], results.files[after]),
                    .only_before = {},
                    .only_after = {},
                    .values = {}};
  std::map<std::string, std::array<const RowGroup*, 2>> rows;
  for (const RowGroup& group : groups) {
    if (group.row().file == before) rows[group.row().name][0] = &group;
    if (group.row().file == after) rows[group.row().name][1] = &group;
  }
  for (const auto& [name, sides] : rows) {
    if (sides[0] == nullptr) {
      found.only_after.push_back(name);
    } else if (sides[1] == nullptr) {
      found.only_before.push_back(name);
    } else {
      compare(name, *sides[0], *sides[1], relative, found.values);
      ++found.common_rows;
    }
  }
  return found;
}

}  // namespace sixdof::results
