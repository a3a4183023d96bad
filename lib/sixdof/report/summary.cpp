#include <sixdof/report/summary.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/report/tables.h>
#include <sixdof/results/contest.h>

namespace sixdof::report {
namespace {

/// Mean angle to the exact force up to which a force counts as right; a person feels several degrees at best.
constexpr double k_right_angle_deg = 1.0;

/// Most algorithms that a sentence lists.
constexpr std::size_t k_most_listed = 4;

/// How an algorithm answered one kind of query in all rows of the usual order and on warm caches.
struct Record {
  bool has_fault = false, approximates = false;
  double wrong = 0.0, judged = 0.0;
  double largest_error = 0.0;              ///< Of distances, in diagonals of A.
  double sum_of_angles = 0.0, rows = 0.0;  ///< Mean angles to the exact force in degrees, over the rows that have one.

  double angle() const { return rows > 0.0 ? sum_of_angles / rows : 0.0; }
};
using Records = std::map<std::string, Record>;

bool is_usual(const RowGroup& group) {
  return !group.is_special() && group.fields().body.empty() && group.fields().algorithm != "null";
}

/// Whether its time counts in a sentence on who is the fastest.
bool is_ranked(const RowGroup& group) { return is_usual(group) && interpreter_of(group.fields()).empty(); }

Records records_of(const std::vector<RowGroup>& groups, const std::string& query) {
  Records records;
  for (const RowGroup& group : groups) {
    if (group.fields().query != query || !group.fields().bucket || !is_usual(group)) continue;
    Record& record = records[group.algorithm()];
    record.has_fault = record.has_fault || !group.faults.empty();
    record.approximates = record.approximates || group.fields().approximates;
    record.wrong += group.count("mismatch");
    record.judged += group.count("judged");
    record.largest_error = std::max(record.largest_error, group.count("error_max"));
    if (const auto angle = group.value("gamma_F_deg")) {
      record.sum_of_angles += *angle;
      record.rows += 1.0;
    }
  }
  return records;
}

/// Whether all answers are right: without a fault and, of forces, near the exact ones on average.
bool is_right(const Record& record, const std::string& query) {
  if (record.has_fault) return false;
  return query == "respond" ? record.rows > 0.0 && record.angle() <= k_right_angle_deg : !record.approximates;
}

struct Question {
  const char* query;
  const char* words;
  const char* right;  ///< "the fastest ..."
};
constexpr std::array k_questions{
    Question{"collide", "Yes or no", "without a wrong answer"},
    Question{"distance", "Distance", "without a wrong answer"},
    Question{"respond", "Force and torque", "with forces within 1 degree of the exact ones"}};

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// Where algorithms win, and by which factors.
struct Wins {
  std::size_t places = 0;
  std::vector<double> factors;
};
using WinsByName = std::vector<std::pair<std::string, Wins>>;

/// The most places first.
WinsByName sorted(const std::map<std::string, Wins>& wins) {
  WinsByName list(wins.begin(), wins.end());
  std::ranges::stable_sort(list, std::greater{}, [](const auto& each) { return each.second.places; });
  return list;
}

/// "; faster, but approximate or elsewhere wrong: ist in 7 (1.9 times), vps in 1 (2.3 times)"
std::string faster_words(const WinsByName& faster) {
  std::vector<std::string> parts;
  for (const auto& [name, wins] : faster) {
    if (parts.size() == k_most_listed) break;
    parts.push_back(fmt::format("{} in {}", name, wins.places));
    if (!wins.factors.empty()) parts.back() += fmt::format(" ({:.3g} times)", geometric_mean(wins.factors));
  }
  return parts.empty() ? "" : fmt::format("; faster, but approximate or elsewhere wrong: {}", fmt::join(parts, ", "));
}

/// "Distance: the fastest without a wrong answer is exact, in 12 of 14 places, 4.1 times faster than the next on
/// average; fcl-rss is in 2." Empty where no two algorithms answered.
std::string speed_sentence(const Question& question, const std::vector<Contest>& contests, const Records& records) {
  std::map<std::string, Wins> by_winner, faster;
  std::size_t places = 0;
  for (const Contest& contest : contests) {
    if (contest.query != question.query || contest.order != "random" || !is_ranked(contest.winner())) continue;
    Contest right = contest;
    std::erase_if(right.entries, [&](const RowGroup* entry) {
      const auto found = records.find(entry->algorithm());
      return found == records.end() || !is_right(found->second, question.query);
    });
    ++places;
    if (right.entries.empty() || &right.winner() != &contest.winner()) {
      Wins& wins = faster[contest.winner().algorithm()];
      ++wins.places;
      if (!right.entries.empty()) {
        wins.factors.push_back(right.winner().mean_time()->value / contest.winner().mean_time()->value);
      }
    }
    if (right.entries.empty()) continue;
    Wins& wins = by_winner[right.winner().algorithm()];
    ++wins.places;
    if (right.entries.size() > 1) wins.factors.push_back(right.factor());
  }
  if (places == 0) return {};
  if (by_winner.empty()) return fmt::format("{}: no algorithm answered {}.", question.words, question.right);
  const WinsByName winners = sorted(by_winner);
  const auto& [name, wins] = winners.front();
  std::string text = fmt::format("{}: the fastest {} is {}, in {} of {}", question.words, question.right, name,
                                 wins.places, counted(places, "place"));
  if (!wins.factors.empty()) {
    text += fmt::format(", {:.3g} times faster than the next{}", geometric_mean(wins.factors),
                        wins.factors.size() > 1 ? " on average" : "");
  }
  for (std::size_t i = 1; i < winners.size() && i <= k_most_listed; ++i) {
    text += fmt::format("{} {}{}", i == 1 ? ";" : ",", winners[i].first, i == 1 ? " is in " : " in ");
    text += std::to_string(winners[i].second.places);
  }
  return text + faster_words(sorted(faster)) + ".";
}

/// The largest of a measure, by algorithm: "vps by up to 0.4 %, ist by up to 1 %, 3 others by less".
std::string largest_of(std::vector<std::pair<double, std::string>> values, const std::string& unit,
                       const std::string& by) {
  std::ranges::stable_sort(values, std::greater{}, &std::pair<double, std::string>::first);
  std::vector<std::string> parts;
  for (const auto& [value, name] : values) {
    if (parts.size() == k_most_listed) break;
    parts.push_back(fmt::format("{} {} {:.2g} {}", name, by, value, unit));
  }
  if (values.size() > parts.size()) parts.push_back(counted(values.size() - parts.size(), "other") + " by less");
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// "How far the others are off: wrong answers, ode 3 of 640 (yes or no); distances, vps by up to 0.4 % of A's
/// diagonal."
std::string error_sentence(const std::map<std::string, Records>& by_query) {
  std::vector<std::string> parts;
  std::vector<std::string> wrong;
  for (const Question& question : k_questions) {
    for (const auto& [name, record] : by_query.at(question.query)) {
      if (record.wrong == 0.0) continue;
      wrong.push_back(fmt::format("{} {:.0f} of {:.0f} ({})", name, record.wrong, record.judged,
                                  question.query == std::string("collide") ? "yes or no" : question.query));
    }
  }
  if (wrong.size() > k_most_listed) {
    const std::size_t more = wrong.size() - k_most_listed;
    wrong.resize(k_most_listed);
    wrong.push_back(fmt::format("{} more", more));
  }
  if (!wrong.empty()) parts.push_back(fmt::format("wrong answers, {}", fmt::join(wrong, ", ")));
  std::vector<std::pair<double, std::string>> distances, angles;
  for (const auto& [name, record] : by_query.at("distance")) {
    if (record.approximates && record.largest_error > 0.0) distances.emplace_back(100.0 * record.largest_error, name);
  }
  for (const auto& [name, record] : by_query.at("respond")) {
    if (record.angle() > k_right_angle_deg) angles.emplace_back(record.angle(), name);
  }
  if (!distances.empty()) parts.push_back("distances, " + largest_of(distances, "% of A's diagonal", "by up to"));
  if (!angles.empty()) parts.push_back("directions of forces on average, " + largest_of(angles, "degrees", "by"));
  return parts.empty() ? "" : fmt::format("How far the others are off: {}.", fmt::join(parts, "; "));
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
  std::map<std::string, Records> records;
  for (const Question& question : k_questions) {
    records[question.query] = records_of(groups, question.query);
    std::string sentence = speed_sentence(question, all, records[question.query]);
    if (!sentence.empty()) summary.sentences.push_back(std::move(sentence));
  }
  for (std::string sentence : {error_sentence(records), stability_sentence(results), fault_sentence(groups)}) {
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
