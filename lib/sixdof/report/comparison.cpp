#include <sixdof/report/comparison.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <sixdof/report/tables.h>
#include <sixdof/results/difference.h>

namespace sixdof::report {
namespace {

struct Pair {
  const RowGroup *before, *after;
  double log_ratio = 0.0;
};

/// Standard deviation of the logarithms, by the median of the deviations from their median: a few rows that did change
/// hardly widen it.
double spread_of(const std::vector<Pair>& pairs) {
  std::vector<double> ratios, deviations;
  for (const Pair& pair : pairs) ratios.push_back(pair.log_ratio);
  // Boost 1.74's median_absolute_deviation() does not subtract the centre.
  const double middle = median(ratios);
  for (const double r : ratios) deviations.push_back(std::abs(r - middle));
  constexpr double k_normal = 1.4826;  // of a normal distribution, standard deviation over median deviation
  return k_normal * median(std::move(deviations));
}

/// Difference of the means of a row's repetitions.
struct Repeated {
  double difference = 0.0;
  double half = 0.0;      ///< Of Welch's interval.
  double variance = 0.0;  ///< Of the difference, by the repetitions alone.
};

std::optional<Repeated> by_repetitions(const Pair& pair, double tail) {
  const std::vector<double> before = pair.before->all(k_processor_mean), after = pair.after->all(k_processor_mean);
  if (before.size() < k_fewest_repetitions || after.size() < k_fewest_repetitions) return std::nullopt;
  const LogMoments b = log_moments(before), a = log_moments(after);
  const double vb = b.variance / b.count, va = a.variance / a.count;
  if (vb + va == 0.0) return Repeated{a.mean - b.mean, 0.0, 0.0};
  const double freedom = (vb + va) * (vb + va) / (vb * vb / (b.count - 1.0) + va * va / (a.count - 1.0));
  const double t = boost::math::quantile(boost::math::complement(boost::math::students_t(freedom), tail));
  return Repeated{a.mean - b.mean, t * std::sqrt(vb + va), vb + va};
}

/// By how much more the ratios of rows differ than their repetitions say: what a run has in common with itself and not
/// with another one, as a standard deviation of logarithms.
double spread_between_runs(const std::vector<std::optional<Repeated>>& repeated, double spread) {
  std::vector<double> variances;
  for (const auto& each : repeated) {
    if (each) variances.push_back(each->variance);
  }
  return variances.empty() ? 0.0 : std::sqrt(std::max(0.0, spread * spread - median(variances)));
}

/// A row of "answers". Its words have as many digits as tell the sides apart.
void add_answer(const Difference& difference, DataTable& table) {
  const auto& [row, counter, kind, before, after, error_before, error_after] = difference;
  if (counter == "error") {
    const auto words = [](const std::string& error) { return error.empty() ? "ran" : error; };
    table.rows.push_back({row, std::string("not run"), Cell(), Cell(),
                          fmt::format("{} -> {}", words(error_before), words(error_after))});
  } else {
    const auto cell = [](const std::optional<Range>& range) { return range ? Cell(range->least) : Cell(); };
    table.rows.push_back({row, counter, cell(before), cell(after), to_string(difference)});
  }
}

std::vector<Pair> common_rows(const std::vector<RowGroup>& groups, std::size_t before, std::size_t after) {
  std::map<std::string, const RowGroup*> by_name;
  for (const RowGroup& group : groups) {
    if (group.row().file == before) by_name[group.row().name] = &group;
  }
  std::vector<Pair> pairs;
  for (const RowGroup& group : groups) {
    const auto found = by_name.find(group.row().name);
    if (group.row().file == after && found != by_name.end()) pairs.push_back({found->second, &group});
  }
  return pairs;
}

/// Keys of the context that differ, except times and names of files.
std::string context_sentence(const Source& before, const Source& after) {
  std::string text;
  for (const auto& [key, value] : before.context) {
    const bool says_nothing = key == "date" || key == "load_avg" || key == "executable" || key == "clock_overhead_ns";
    if (says_nothing || after.at(key) == value) continue;
    text += fmt::format("{}{}: {} -> {}", text.empty() ? "" : "; ", key, value,
                        after.at(key).empty() ? "none" : after.at(key));
  }
  return text.empty() ? "Machine, build, versions and settings are the same." : "Other differences: " + text + ".";
}

}  // namespace

Comparison compare(const Results& results, const std::vector<RowGroup>& groups, std::size_t before, std::size_t after) {
  Comparison comparison{.before = run_name(results, before),
                        .after = run_name(results, after),
                        .answers = {},
                        .changes = {},
                        .sentences = {}};
  comparison.answers = {.name = "answers",
                        .title = "Answers that changed",
                        .columns = {"row", "value", "before", "after", "words"},
                        .rows = {}};
  comparison.changes = {.name = "changes",
                        .title = "Times that changed",
                        .columns = {"comparison", "query", "pair", "algorithm", "row", "before_us", "after_us", "ratio",
                                    "low", "high", "verdict", "worst_pose"},
                        .rows = {}};
  std::vector<Pair> pairs = common_rows(groups, before, after);
  std::size_t others = 0;
  const Differences found = differences(results, groups, before, after);
  for (const Difference& difference : found.values) {
    if (difference.counter == "configurations" || difference.counter == "steps") {
      ++others;
    } else if (difference.kind == MetricKind::answer) {
      add_answer(difference, comparison.answers);
    }
  }
  std::erase_if(pairs, [](Pair& pair) {
    const auto b = pair.before->mean_time(), a = pair.after->mean_time();
    if (b && a) pair.log_ratio = std::log(a->value / b->value);
    return !b || !a;
  });
  if (found.common_rows == 0) return comparison;
  auto& sentences = comparison.sentences;
  sentences.push_back(
      comparison.answers.rows.empty()
          ? fmt::format("Answers: none of the {} common rows changed.", found.common_rows)
          : fmt::format("Answers: values that changed: {}. They are listed first.", comparison.answers.rows.size()));
  if (others > 0) {
    sentences.push_back(
        fmt::format("Rows that asked another number of configurations, whose answers are not compared: {}.", others));
  }
  if (pairs.empty()) return comparison;

  const double tail = 0.5 * (1.0 - std::pow(1.0 - k_false_alarm, 1.0 / static_cast<double>(pairs.size())));
  const double z = boost::math::quantile(boost::math::complement(boost::math::normal(), tail));
  std::vector<std::optional<Repeated>> repeated;
  for (Pair& pair : pairs) {
    repeated.push_back(by_repetitions(pair, tail));
    if (repeated.back()) pair.log_ratio = repeated.back()->difference;
  }
  const double spread = spread_of(pairs), between = spread_between_runs(repeated, spread);
  const double half_of_single = z * k_uneven * std::max(k_least_spread, spread);
  std::size_t slower = 0, faster = 0;
  std::vector<double> ratios;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Pair& pair = pairs[k];
    const double middle = pair.log_ratio;
    const double half = repeated[k] ? std::hypot(repeated[k]->half, z * between) : half_of_single;
    ratios.push_back(middle);
    const bool is_slower = middle - half > 0.0, is_faster = middle + half < 0.0;
    slower += is_slower ? 1 : 0;
    faster += is_faster ? 1 : 0;
    const Row& row = pair.before->row();
    comparison.changes.rows.push_back({comparison.before + " -> " + comparison.after, row.fields.query,
                                       row.fields.pair.empty() ? row.fields.scenario : row.fields.pair,
                                       pair.before->algorithm(), row.name, pair.before->mean_time()->value / 1e3,
                                       pair.after->mean_time()->value / 1e3, std::exp(middle), std::exp(middle - half),
                                       std::exp(middle + half),
                                       std::string(is_slower   ? "slower"
                                                   : is_faster ? "faster"
                                                               : "no change shown"),
                                       pair.after->row().outliers.command_of("max_least_ns")});
  }
  sentences.push_back(
      fmt::format("Times, by row: {} slower, {} faster, {} without a change that can be shown; the median row "
                  "takes {:.3g} times as long.",
                  slower, faster, pairs.size() - slower - faster, std::exp(median(ratios))));
  sentences.push_back(
      std::ranges::all_of(repeated, [](const auto& each) { return each.has_value(); })
          ? fmt::format(
                "Intervals come from the repetitions of each row, and from how much more the rows differ between the "
                "runs, a factor of {:.3g} to either side.",
                std::exp(z * between))
          : fmt::format(
                "Rows without {} repetitions get an interval from the spread of all rows, a factor of {:.3g} to either "
                "side; repetitions (--benchmark_repetitions=10) make it narrower.",
                k_fewest_repetitions, std::exp(half_of_single)));
  sentences.push_back(context_sentence(results.files[before], results.files[after]));
  return comparison;
}

std::vector<Comparison> comparisons(const Results& results, const std::vector<RowGroup>& groups) {
  std::vector<Comparison> all;
  for (std::size_t after = 1; after < results.files.size(); ++after) {
    Comparison comparison = compare(results, groups, 0, after);
    if (!comparison.changes.rows.empty() || !comparison.answers.rows.empty()) all.push_back(std::move(comparison));
  }
  return all;
}

}  // namespace sixdof::report
