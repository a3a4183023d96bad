#include <sixdof/report/summary.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/report/tables.h>
#include <sixdof/results/contest.h>

namespace sixdof::report {
namespace {

std::string_view words_of(const std::string& query) {
  if (query == "collide") return "Yes/no";
  return query == "distance" ? "Distance" : "Force and torque";
}

/// "Distance: exact is the fastest in 12 of 14 buckets, clearly in 10, 4.1 times faster than the next on average, 1.2
/// to 9".
std::string speed_sentence(const std::string& query, const std::vector<const Contest*>& contests) {
  std::map<std::string, std::vector<const Contest*>> by_winner;
  for (const Contest* const contest : contests) {
    by_winner[contest->winner().algorithm()].push_back(contest);
  }
  std::vector<std::pair<std::string, std::vector<const Contest*>>> winners(by_winner.begin(), by_winner.end());
  std::ranges::stable_sort(winners, std::greater{}, [](const auto& winner) { return winner.second.size(); });
  std::vector<std::string> parts;
  for (const auto& [algorithm, won] : winners) {
    std::vector<double> factors;
    for (const Contest* const contest : won) factors.push_back(contest->factor());
    const auto clear = std::ranges::count_if(won, &Contest::is_clear);
    const auto [least, most] = std::ranges::minmax(factors);
    const std::string range = won.size() > 1 ? fmt::format(" on average, {:.3g} to {:.3g}", least, most) : "";
    parts.push_back(fmt::format("{}{} in {} of {} buckets, clearly in {}, {:.3g} times faster than the next{}",
                                algorithm, parts.empty() ? " is the fastest" : "", won.size(), contests.size(), clear,
                                std::exp(log_moments(factors).mean), range));
  }
  return fmt::format("{}: {}.", words_of(query), fmt::join(parts, "; "));
}

/// Which response is the nearest to the exact one, of the algorithms that have any force.
std::string accuracy_sentence(const std::vector<RowGroup>& groups) {
  std::map<std::string, std::pair<double, double>> sums;  // algorithm: degrees, rows
  for (const RowGroup& group : groups) {
    if (group.is_special()) continue;
    const auto angle = group.fields().query == "respond" ? group.value("gamma_F_deg") : std::nullopt;
    if (!angle || group.fields().algorithm == "exact" || group.fields().algorithm == "brute-force") continue;
    auto& [degrees, rows] = sums[group.algorithm()];
    degrees += *angle;
    rows += 1.0;
  }
  std::vector<std::pair<double, std::string>> means;
  for (const auto& [algorithm, sum] : sums) means.emplace_back(sum.first / sum.second, algorithm);
  if (means.size() < 2) return {};
  std::ranges::sort(means);
  return fmt::format(
      "Forces nearest to the exact ones: {} ({:.3g} degrees on average), then {} ({:.3g} degrees); farthest: {} "
      "({:.3g} "
      "degrees).",
      means[0].second, means[0].first, means[1].second, means[1].first, means.back().second, means.back().first);
}

std::string fault_sentence(const std::vector<RowGroup>& groups) {
  std::map<std::string, std::size_t> by_algorithm;
  std::size_t faulty = 0;
  for (const RowGroup& group : groups) {
    if (group.fields().algorithm == "null" || group.faults.empty()) continue;
    ++faulty;
    ++by_algorithm[group.fields().algorithm];
  }
  if (groups.empty()) return {};
  if (faulty == 0) return fmt::format("All {} rows ran, with no failed and no wrong answer.", groups.size());
  std::vector<std::string> parts;
  for (const auto& [algorithm, rows] : by_algorithm) parts.push_back(fmt::format("{} {}", algorithm, rows));
  return fmt::format("{} of {} rows have failures or wrong answers and are not ranked ({}); they stand under Failures.",
                     faulty, groups.size(), fmt::join(parts, ", "));
}

std::string stability_sentence(const Results& results) {
  if (results.hard_cases.empty()) return {};
  std::map<std::string, std::size_t> red;
  std::set<std::string> algorithms;
  for (const HardCase& cell : results.hard_cases) {
    algorithms.insert(cell.algorithm);
    if (is_red(cell)) ++red[cell.algorithm];
  }
  std::vector<std::string> good, bad;
  for (const std::string& algorithm : algorithms) {
    if (!red.contains(algorithm)) good.push_back(algorithm);
  }
  for (const auto& [algorithm, count] : red) bad.push_back(fmt::format("{} in {}", algorithm, count));
  return fmt::format("Hard cases: {} of {} algorithms pass every family ({}){}{}.", good.size(), algorithms.size(),
                     good.empty() ? "none" : fmt::format("{}", fmt::join(good, ", ")),
                     bad.empty() ? "" : "; families with a wrong or missing answer: ", fmt::join(bad, ", "));
}

}  // namespace

Summary summarise(const Results& results, const std::vector<RowGroup>& groups) {
  std::vector<Contest> all = contests(groups);
  std::erase_if(all, [](const Contest& contest) { return contest.entries.size() < 2; });
  Summary summary;
  summary.winners = {.name = "winners",
                     .title = "Fastest without a fault",
                     .columns = {"run", "query", "poses", "pair", "bucket", "fastest", "time_us", "next",
                                 "times_faster", "verdict", "worst_pose"},
                     .rows = {}};
  for (const Contest& contest : all) {
    const RowGroup& first = contest.winner();
    summary.winners.rows.push_back(
        {run_name(results, contest.file), contest.query, contest.order, contest.bodies, place_of(first.fields()),
         first.algorithm(), first.mean_time()->value / 1e3, contest.entries[1]->algorithm(), contest.factor(),
         std::string(contest.is_clear() ? "clear" : "tie"), first.row().outliers.command_of("max_least_ns")});
  }
  for (const char* const query : {"collide", "distance", "respond"}) {
    std::vector<const Contest*> of_query;
    for (const Contest& contest : all) {
      const bool is_usual = contest.order == "random" && contest.winner().fields().body.empty();
      if (contest.query == query && is_usual) of_query.push_back(&contest);
    }
    if (!of_query.empty()) summary.sentences.push_back(speed_sentence(query, of_query));
  }
  for (std::string sentence : {accuracy_sentence(groups), stability_sentence(results), fault_sentence(groups)}) {
    if (!sentence.empty()) summary.sentences.push_back(std::move(sentence));
  }
  for (std::size_t file = 0; file < results.files.size(); ++file) {
    if (results.files[file].at("interrupted") == "true") {
      summary.sentences.push_back(run_name(results, file) + " was interrupted: rows are missing.");
    }
  }
  if (summary.sentences.empty()) summary.sentences.emplace_back("There are no rows to compare.");
  return summary;
}

}  // namespace sixdof::report
