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

/// How an algorithm answered one kind of query in all rows on buckets, whatever the order of poses and the caches.
struct Record {
  bool has_fault = false, approximates = false;
  bool is_about_meshes = true;  ///< Not about convex hulls.
  double wrong = 0.0, judged = 0.0;
  double largest_error = 0.0;              ///< Of distances, in diagonals of A.
  double sum_of_angles = 0.0, rows = 0.0;  ///< Mean angles to the exact force in degrees, over the rows that have one.

  double angle() const { return rows > 0.0 ? sum_of_angles / rows : 0.0; }
};
using Records = std::map<std::string, Record>;  // by algorithm

struct Question {
  const char* query;
  const char* words;
  const char* right;  ///< "the fastest ..."
};
constexpr std::array k_questions{
    Question{"collide", "Yes or no", "without a wrong answer"},
    Question{"distance", "Distance", "without a wrong answer"},
    Question{"respond", "Force and torque", "with forces within 1 degree of the exact ones"},
    Question{k_cast, "First contact", "without a wrong answer"}};

bool is_a_question(const std::string& query) {
  return std::ranges::any_of(k_questions, [&](const Question& each) { return query == each.query; });
}

/// By query; those of k_questions are there in any case.
std::map<std::string, Records> records_of(const std::vector<RowGroup>& groups) {
  std::map<std::string, Records> by_query;
  for (const Question& question : k_questions) by_query.try_emplace(question.query);
  for (const RowGroup& group : groups) {
    const RowFields& fields = group.fields();
    if (!fields.bucket || fields.algorithm == "null") continue;
    Record& record = by_query[fields.query][fields.algorithm];
    record.has_fault = record.has_fault || !group.faults.empty();
    record.approximates = record.approximates || fields.approximates;
    record.is_about_meshes = fields.body.empty();
    for (const Fault& fault : mistakes(group.faults)) {
      if (fault.counter == "mismatch") record.wrong += static_cast<double>(fault.count);
    }
    record.judged += group.count("judged");
    record.largest_error = std::max(record.largest_error, group.count("error_max"));
    if (const auto angle = group.value("gamma_F_deg")) {
      record.sum_of_angles += *angle;
      record.rows += 1.0;
    }
  }
  return by_query;
}

/// Whether all answers are right: without a fault and, of forces, near the exact ones on average.
bool is_right(const Record& record, const std::string& query) {
  if (record.has_fault) return false;
  return query == "respond" ? record.rows > 0.0 && record.angle() <= k_right_angle_deg : !record.approximates;
}

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// The rows that compete for a place, and of these the ones of algorithms that are right: the one rule of the
/// sentences, of the table of winners and of its figure.
struct Race {
  const Contest* all;
  Contest right;  ///< Its entries may be none.

  bool has_right() const { return !right.entries.empty(); }
  /// Whether the fastest of all is not right.
  bool is_beaten() const { return !has_right() || &right.winner() != &all->winner(); }
  /// Time of the fastest right algorithm over that of the fastest of all.
  double factor_of_fastest() const { return right.winner().mean_time()->value / all->winner().mean_time()->value; }
};

/// Of the contests between two or more. @param contests outlive the races
std::vector<Race> races_of(const std::vector<Contest>& contests, const std::map<std::string, Records>& by_query) {
  std::vector<Race> races;
  for (const Contest& contest : contests) {
    // Contacts and depths have scores, but no answer that all have to give.
    if (contest.entries.size() < 2 || !is_a_question(contest.query)) continue;
    Race race{&contest, contest};
    const Records& records = by_query.at(contest.query);
    std::erase_if(race.right.entries, [&](const RowGroup* entry) {
      return !is_right(records.at(entry->fields().algorithm), contest.query);
    });
    races.push_back(std::move(race));
  }
  return races;
}

/// Where algorithms win, by which factors, and how often against which next one.
struct Wins {
  std::size_t places = 0;
  std::vector<double> factors;
  std::map<std::string, std::size_t> next;
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

/// ", 4.1 times faster on average than the next, most often fcl-rss"; empty where there is no next one.
std::string lead_words(const Wins& wins) {
  if (wins.factors.empty()) return {};
  const auto most = std::ranges::max_element(wins.next, {}, [](const auto& each) { return each.second; });
  return fmt::format(", {:.3g} times faster{} than the next, {}{}", geometric_mean(wins.factors),
                     wins.factors.size() > 1 ? " on average" : "", wins.next.size() > 1 ? "most often " : "",
                     most->first);
}

/// "Distance: the fastest without a wrong answer is exact, in 12 of 14 places, 4.1 times faster on average than the
/// next, fcl-rss; fcl-rss is in 2." Empty where no two algorithms answered.
std::string speed_sentence(const Question& question, const std::vector<Race>& races) {
  std::map<std::string, Wins> by_winner, faster;
  std::size_t places = 0;
  for (const Race& race : races) {
    const RowGroup& first = race.all->winner();
    if (race.all->query != question.query || !class_of(first.fields()).empty()) continue;
    if (race.all->order != "random" && question.query != std::string(k_cast)) continue;
    ++places;
    if (race.is_beaten()) {
      Wins& wins = faster[first.algorithm()];
      ++wins.places;
      if (race.has_right()) wins.factors.push_back(race.factor_of_fastest());
    }
    if (!race.has_right()) continue;
    Wins& wins = by_winner[race.right.winner().algorithm()];
    ++wins.places;
    if (race.right.entries.size() < 2) continue;
    wins.factors.push_back(race.right.factor());
    ++wins.next[race.right.entries[1]->algorithm()];
  }
  if (places == 0) return {};
  if (by_winner.empty()) return fmt::format("{}: no algorithm answered {}.", question.words, question.right);
  const WinsByName winners = sorted(by_winner);
  const auto& [name, wins] = winners.front();
  std::string text = fmt::format("{}: the fastest {} is {}, in {} of {}", question.words, question.right, name,
                                 wins.places, counted(places, "place"));
  text += lead_words(wins);
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

const char* words_of_wrong(const Question& question) {
  const std::string query = question.query;
  return query == "collide" ? "yes or no" : query == k_cast ? "first contact" : question.query;
}

/// "How far the others are off: wrong answers, ode 3 of 640 (yes or no); distances, vps by up to 0.4 % of A's
/// diagonal."
std::string error_sentence(const std::map<std::string, Records>& by_query) {
  std::vector<std::string> parts;
  std::vector<std::string> wrong;
  for (const Question& question : k_questions) {
    for (const auto& [name, record] : by_query.at(question.query)) {
      if (record.wrong == 0.0 || !record.is_about_meshes) continue;
      wrong.push_back(
          fmt::format("{} {:.0f} of {:.0f} ({})", name, record.wrong, record.judged, words_of_wrong(question)));
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
    if (record.approximates && record.is_about_meshes && record.largest_error > 0.0) {
      distances.emplace_back(100.0 * record.largest_error, name);
    }
  }
  for (const auto& [name, record] : by_query.at("respond")) {
    if (record.angle() > k_right_angle_deg && record.is_about_meshes) angles.emplace_back(record.angle(), name);
  }
  if (!distances.empty()) parts.push_back("distances, " + largest_of(distances, "% of A's diagonal", "by up to"));
  if (!angles.empty()) parts.push_back("directions of forces on average, " + largest_of(angles, "degrees", "by"));
  return parts.empty() ? "" : fmt::format("How far the others are off: {}.", fmt::join(parts, "; "));
}

std::string fault_sentence(const std::vector<RowGroup>& groups) {
  std::map<std::string, std::size_t> by_algorithm;
  std::size_t faulty = 0;
  for (const RowGroup& group : groups) {
    if (group.fields().algorithm == "null" || mistakes(group.faults).empty()) continue;
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

/// What a row is about, and what interprets its algorithm: "meshes", "convex hulls", "meshes (python)". The page has
/// the same words (page/figure_text.js).
std::string body_words(const RowFields& fields) {
  const std::string words = fields.body.empty() ? "meshes" : "convex hulls", interpreter = interpreter_of(fields);
  return interpreter.empty() ? words : fmt::format("{} ({})", words, interpreter);
}

DataTable winners_table(const Results& results, const std::vector<Race>& races) {
  DataTable table{.name = "winners",
                  .title = "The fastest right algorithm of each place",
                  .columns = {"run", "body", "query", "poses", "pair", "bucket", "fastest", "time_us", "next",
                              "times_faster", "verdict", "not_right_but_faster", "by_factor", "worst_pose"},
                  .rows = {}};
  for (const Race& race : races) {
    const RowGroup& first = race.all->winner();
    const RowGroup* const best = race.has_right() ? &race.right.winner() : nullptr;
    const bool has_next = race.right.entries.size() > 1;
    const std::string verdict = best == nullptr         ? "none is right"
                                : !has_next             ? "no other is right"
                                : race.right.is_clear() ? "clear"
                                                        : "tie";
    table.rows.push_back(
        {run_name(results, race.all->file), body_words(first.fields()), race.all->query, race.all->order,
         race.all->bodies, place_of(first.fields()), best == nullptr ? std::string() : best->algorithm(),
         best == nullptr ? Cell() : Cell(best->mean_time()->value / 1e3),
         has_next ? race.right.entries[1]->algorithm() : std::string(), has_next ? Cell(race.right.factor()) : Cell(),
         verdict, race.is_beaten() ? first.algorithm() : std::string(),
         race.is_beaten() && best != nullptr ? Cell(race.factor_of_fastest()) : Cell(),
         best == nullptr ? std::string() : best->row().outliers.command_of("max_least_ns")});
  }
  return table;
}

}  // namespace

Summary summarise(const Results& results, const std::vector<RowGroup>& groups) {
  const std::vector<Contest> all = contests(groups);
  const std::map<std::string, Records> records = records_of(groups);
  const std::vector<Race> races = races_of(all, records);
  Summary summary{.sentences = {}, .winners = winners_table(results, races)};
  for (const Question& question : k_questions) {
    std::string sentence = speed_sentence(question, races);
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
