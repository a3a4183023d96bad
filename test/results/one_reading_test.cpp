// One file, one answer: on generated result files the table, its JSON, the page and the choice of a study name the same
// winners, faults and frontiers. Each is read from what it shows, so that one that decides by itself is found.

#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/report/page.h>
#include <sixdof/report/tables.h>
#include <sixdof/results/choice.h>
#include <sixdof/results/frontier.h>
#include "bench/cli/table.h"

#include "../cli/scratch_folder.h"
#include "../report/result_text.h"

namespace sixdof::results {
namespace {

using report::DataTable;
using test::Json;

constexpr int k_files = 200;

/// Makes rows; the same seed makes the same ones.
class Generator {
 public:
  explicit Generator(unsigned seed) : random_(seed) {}

  bool one_in(int n) { return random_() % static_cast<unsigned>(n) == 0; }
  double above(double least) { return least * std::exp(0.1 * static_cast<double>(random_() % 30)); }

  std::vector<Json> rows() {
    std::vector<Json> all;
    for (const char* const query : {"collide", "distance", "respond"}) {
      for (const char* const algorithm : {"exact", "fast", "constant", "hulls", "other-hulls", "interpreted", "null"}) {
        const bool is_constant = algorithm == std::string("constant") && one_in(2);
        for (const auto& [kind, percent] : {std::pair("distance", 5.0), {"volume", 1.0}, {"volume", 5.0}}) {
          if (one_in(8)) continue;
          Json row = test::row(query, algorithm, "p", kind, percent, 0.0, faults());
          if (is_constant && percent == 1.0) row["mismatch"] = 64;
          if (std::string(algorithm).ends_with("hulls")) row["sixdof"]["body"] = "convex_hull";
          if (algorithm == std::string("interpreted")) row["sixdof"]["runtime"] = "python";
          if (algorithm == std::string("fast")) row["sixdof"]["approximates"] = true;
          if (one_in(3)) row.update({{"gamma_F_deg", above(1.0)}, {"error_rms", above(1e-3)}});
          add(row, all);
          if (one_in(4)) add(special(row, "order", "motion"), all);
          if (one_in(4)) add(special(row, "order", "path"), all);
          if (one_in(4)) add(special(row, "cache", "cold"), all);
        }
      }
    }
    return all;
  }

  /// Points of a study, with intervals.
  std::vector<Json> points() {
    std::vector<Json> all;
    for (int k = 0; k < 12; ++k) {
      const std::string algorithm = k % 4 == 0 ? "exact" : k % 4 == 1 ? "vps" : k % 4 == 2 ? "ist" : "interpreted";
      const double ns = above(1e3), error = algorithm == "exact" ? 1e-16 : above(0.5);
      Json row = test::row("precision", algorithm, "p", "volume", 1.0, ns, faults());
      row["name"] = fmt::format("precision/respond/algorithm:{}/pair:p/size:{}", algorithm, k);
      row["sixdof"].erase("bucket");
      row["sixdof"]["question"] = "respond";
      if (algorithm == "interpreted") row["sixdof"]["runtime"] = "python";
      row["sixdof"]["settings"] = {{"size", k}};
      row.update({{"cpu_time_low", 0.9 * ns}, {"cpu_time_high", 1.1 * ns}, {"gamma_F_deg", error}});
      row.update({{"max_ns", 30.0 * ns}, {"max_least_ns", 20.0 * ns}});
      if (!one_in(3)) row.update({{"gamma_F_deg_low", 0.8 * error}, {"gamma_F_deg_high", 1.2 * error}});
      if (!one_in(9)) row.update({{"p99_ns", 10.0 * ns}, {"p99_least_ns", 9.0 * ns}});
      if (one_in(12)) row.update({{"error_occurred", true}, {"error_message", "left out"}});
      all.push_back(row);
    }
    return all;
  }

 private:
  Json faults() {
    Json values = Json::object();
    for (const char* const counter : {"failed", "crashed", "timed_out", "out_of_memory", "mismatch", "misses"}) {
      if (one_in(20)) values[counter] = one_in(4) ? 64 : 1 + random_() % 63;
    }
    return values;
  }

  static Json special(Json row, const char* key, const char* value) {
    row["sixdof"][key] = value;
    row["name"] = fmt::format("{}/{}:{}", row["name"].get<std::string>(), key, value);
    return row;
  }

  /// One to five repetitions, some of which have no result or lack counters.
  void add(const Json& row, std::vector<Json>& all) {
    for (int repetitions = one_in(3) ? 1 + static_cast<int>(random_() % 5) : 1; repetitions > 0; --repetitions) {
      Json each = row;
      each["cpu_time"] = each["real_time"] = above(100.0);
      for (const char* const counter : {"p50_ns", "judged", "configurations", "mismatch"}) {
        if (one_in(15)) each.erase(counter);
      }
      if (one_in(25)) each.update({{"error_occurred", true}, {"error_message", "no memory"}});
      all.push_back(each);
    }
  }

  std::mt19937 random_;
};

using Names = std::multiset<std::string>;

/// A row, as text: run, query, bodies, place, poses and caches.
std::string contest_of(const std::string& run, const std::string& query, const std::string& pair,
                       const std::string& place, const std::string& poses) {
  return fmt::format("{} | {} | {} | {} | {}", run, query, pair, place, poses);
}

std::string label_of(const Json& line) {
  const std::string order = line.at("order"), algorithm = line.at("algorithm");
  const std::string poses = order == "path" ? " (path order)" : order == "motion" ? " (motion)" : "";
  return algorithm + poses + (line.at("cache") == "cold" ? " (cold)" : "");
}

/// What a reading names. Winners stand with their contest; those without a rival only where the page has them.
struct Reading {
  Names winners, faults;
};

/// Of `sixdof table --json`. Checks each winner by the values beside it.
Reading of_json(const Json& document, const Results& results) {
  Reading reading;
  for (const Json& table : document.at("tables")) {
    std::map<std::string, std::map<std::string, double>> times;  // by contest and algorithm
    std::map<std::string, std::string> fastest;
    for (const Json& line : table.at("rows")) {
      const std::string place =
          fmt::format("{} {:g} %", table.at("kind").get<std::string>(), line.at("percent").get<double>());
      for (std::size_t file = 0; file < line.at("files").size(); ++file) {
        const Json& row = line.at("files")[file];
        if (row.is_null()) continue;
        const std::string contest =
            contest_of(report::run_name(results, file), table.at("query"), table.at("pair"), place, line.at("order"));
        for (const Json& fault : row.at("faults")) {
          if (line.at("algorithm") == "null" || fault["what"] == k_approximate) continue;  // neither is a mistake
          const std::string counts =
              fault.contains("of") ? fmt::format("{} of {} ", fault["count"].dump(), fault["of"].dump()) : "";
          reading.faults.insert(
              fmt::format("{} | {} | {}",
                          contest_of(report::run_name(results, file), table.at("query"), table.at("pair"), place, ""),
                          label_of(line), counts + fault["what"].get<std::string>()));
        }
        if (row.at("fastest") == true) fastest[contest] = label_of(line);
        if (row.at("faults").empty() && row.at("values").contains(k_processor_mean)) {
          times[contest][label_of(line)] = row.at("values").at(k_processor_mean);
        }
      }
    }
    EXPECT_EQ(fastest.size(), times.size());
    for (const auto& [contest, entries] : times) {
      for (const auto& [algorithm, ns] : entries) EXPECT_LE(entries.at(fastest[contest]), ns) << contest;
      if (entries.size() > 1) reading.winners.insert(contest + " | " + fastest[contest]);
    }
  }
  return reading;
}

Reading of_page(const report::Report& page) {
  Reading reading;
  for (const DataTable& table : page.tables) {
    for (const auto& line : table.rows) {
      const auto text = [&](const char* column) { return report::test::text_in(table, line, column); };
      if (table.name == "winners") {
        // The page ranks algorithms that are right; beside them stands the fastest of all where it is another one.
        const std::string other = text("not_right_but_faster");
        reading.winners.insert(contest_of(text("run"), text("query"), text("pair"), text("bucket"), text("poses")) +
                               " | " + (other.empty() ? text("fastest") : other));
      } else if (table.name == "failures" && text("query") != "precision") {
        reading.faults.insert(fmt::format("{} | {} | {}",
                                          contest_of(text("run"), text("query"), text("pair"), text("bucket"), ""),
                                          text("algorithm"), text("fault")));
      }
    }
  }
  return reading;
}

/// The marks of a table's text: how many rows are the fastest, how many have faults.
std::pair<std::size_t, std::size_t> marks_of(const std::vector<cli::ResultTable>& tables,
                                             const cli::TableInput& input) {
  std::pair<std::size_t, std::size_t> marks;
  for (const cli::ResultTable& table : tables) {
    for (const auto& line : cli::sheet_of(table, input).lines) {
      for (const std::string& cell : line) {
        marks.first += cell == "*" ? 1 : 0;
        marks.second += cell == "!" || cell == "~" ? 1 : 0;
      }
    }
  }
  return marks;
}

std::pair<std::size_t, std::size_t> marks_of(const Json& document) {
  std::pair<std::size_t, std::size_t> marks;
  for (const Json& table : document.at("tables")) {
    for (const Json& line : table.at("rows")) {
      for (const Json& row : line.at("files")) {
        if (row.is_null()) continue;
        marks.first += row.at("fastest") == true ? 1 : 0;
        marks.second += row.at("faults").empty() ? 0 : 1;
      }
    }
  }
  return marks;
}

class OneReading : public sixdof::test::ScratchFolder {};

TEST_F(OneReading, OfWinnersAndFaults) {
  std::size_t winners = 0, faults = 0;
  for (unsigned seed = 1; seed <= k_files; ++seed) {
    Generator generator(seed);
    std::vector<std::string> files;
    for (unsigned k = 0; k <= seed % 3; ++k) {
      files.push_back(path(fmt::format("run{}.json", k)));
      std::ofstream(files.back()) << test::file_of(generator.rows());
    }
    const cli::TableInput input(files);
    const std::vector<cli::ResultTable> tables = cli::tables_of(input);
    const Json document = cli::as_json(tables, input);
    const Reading table = of_json(document, input.content), page = of_page(report::make_report(input.content, {}));
    ASSERT_EQ(table.winners, page.winners) << "seed " << seed;
    ASSERT_EQ(table.faults, page.faults) << "seed " << seed;
    ASSERT_EQ(marks_of(tables, input), marks_of(document)) << "seed " << seed;
    winners += table.winners.size();
    faults += table.faults.size();
  }
  EXPECT_GT(winners, 10u * k_files) << "the files have something to name";
  EXPECT_GT(faults, 5u * k_files);
}

TEST_F(OneReading, OfFrontiersAndChoices) {
  std::size_t chosen = 0, faulty = 0;
  for (unsigned seed = 1; seed <= k_files; ++seed) {
    Generator generator(seed);
    Results results = test::results_of(generator.points());
    const std::vector<OnFrontier> on = frontiers(results.rows, "cpu_time", "gamma_F_deg");  // as a study writes it
    const report::Report page = report::make_report(results, {});
    const auto table = std::ranges::find(page.tables, "frontier", &DataTable::name);
    const auto metrics = std::ranges::find(page.tables, "metrics", &DataTable::name);
    std::set<std::string> without_fault;  // settings
    for (const auto& line : metrics->rows) {
      if (report::test::text_in(*metrics, line, "faults").empty())
        without_fault.insert(report::test::text_in(*metrics, line, "settings"));
    }
    for (std::size_t i = 0; i < results.rows.size(); ++i) {
      const Row& row = results.rows[i];
      const auto lines = report::test::lines_with(*table, {{"settings", row.fields.settings},
                                                           {"cost", "mean processor time of a query, µs"},
                                                           {"measure", "force direction, mean (degrees)"}});
      ASSERT_EQ(lines.size(), row.error.empty() ? 1u : 0u) << "seed " << seed;
      if (lines.empty()) continue;
      ASSERT_EQ(report::test::text_in(*table, lines[0], "frontier"), on[i].overall ? "yes" : "no")
          << "seed " << seed << ", " << row.name;
      ASSERT_TRUE(!on[i].overall || without_fault.contains(row.fields.settings)) << "seed " << seed;
      faulty += without_fault.contains(row.fields.settings) ? 0 : 1;
    }
    for (Row& row : results.rows) {
      if (!row.error.empty()) continue;
      row.values.insert({{"judged_overlapping", 64.0}, {"timed", 64.0}, {"late", generator.one_in(4) ? 1.0 : 0.0}});
    }
    const Choice choice = choose(results.rows, "respond", "gamma_F_deg");
    for (const Candidate& candidate : choice.candidates) {
      const Row& row = results.rows[candidate.place];
      const bool faulty_there = candidate.standing == Standing::faulty || candidate.standing == Standing::left_out;
      ASSERT_EQ(faulty_there, !without_fault.contains(row.fields.settings)) << "seed " << seed << ' ' << row.name;
    }
    if (choice.taken() == nullptr) continue;
    ++chosen;
    ASSERT_EQ(interpreter_of(results.rows[choice.taken()->place].fields), "") << "seed " << seed;
    const Row& best = results.rows[choice.taken()->place];
    ASSERT_EQ(best.count("late"), 0.0) << "seed " << seed;
  }
  EXPECT_GT(chosen, k_files / 2);
  EXPECT_GT(faulty, k_files);
}

/// A row of single queries, of which some were late, as some waits beside it.
Row timed_row(const std::string& algorithm, double late, double idle_late, double error) {
  Row row;
  row.fields.query = "precision";
  row.fields.algorithm = algorithm;
  row.fields.approximates = error > 0.0;
  row.values = {{"timed", 2100.0},    {"judged_apart", 64.0},          {"late", late}, {"idle_late", idle_late},
                {"error_max", error}, {std::string(k_wall_mean), 1e4}, {"p50_ns", 1e4}};
  return row;
}

TEST(Choice, HoldsOnlyWhatIsClearlyMoreThanNoiseAgainstAnAlgorithm) {
  const auto standing = [](double late, double idle) {
    const Row row = timed_row("one", late, idle, 0.0);
    return choose({&row, 1}, "distance", "error_max").candidates.at(0).standing;
  };
  EXPECT_EQ(standing(2, 0), Standing::taken) << "not more than 0.1 %";
  EXPECT_EQ(standing(2, 30), Standing::taken) << "as they came";
  EXPECT_EQ(standing(3, 0), Standing::late);
  EXPECT_EQ(standing(4, 3), Standing::undecided);
  EXPECT_EQ(standing(40, 3), Standing::late);
}

TEST(Choice, TakesNothingInPlaceOfWhatNoiseMadeLate) {
  // The least noise was beside the first row, the most beside the third.
  std::vector<Row> rows{timed_row("right", 13, 3, 0.0), timed_row("rough", 1, 0, 0.01),
                        timed_row("other", 300, 8, 0.0)};
  const Choice noisy = choose(rows, "distance", "error_max");
  EXPECT_EQ(noisy.taken(), nullptr);
  EXPECT_EQ(noisy.missing,
            "the machine is too noisy for the deadline (right: 13 of 2100 queries late, the loop that asks nothing up "
            "to 8)");
  EXPECT_EQ(noisy.candidates.back().standing, Standing::late);
  rows[2].values["p50_ns"] = 3e4;  // longer waits meet more noise
  const Choice longer = choose(rows, "distance", "error_max");
  ASSERT_NE(longer.taken(), nullptr);
  EXPECT_EQ(longer.taken()->place, 1u) << "13 are clearly more than 3";
  rows[2].values["p50_ns"] = 1e4;
  rows[0].fields.approximates = true;
  rows[0].values["error_max"] = 0.02;
  const Choice chosen = choose(rows, "distance", "error_max");
  ASSERT_NE(chosen.taken(), nullptr);
  EXPECT_EQ(chosen.taken()->place, 1u) << "what is undecided would not be better";
}

TEST(Choice, SaysInPlainWordsWhatCouldNotBeMeasured) {
  Row row;
  row.fields.query = "precision";
  row.values = {{"timed", 64.0}, {"judged_apart", 64.0}};
  const auto reason = [&] { return choose({&row, 1}, "distance", "error_max").candidates.at(0).reason; };
  EXPECT_EQ(reason(), "its error could not be measured");
  row.values["error_max"] = 0.5;
  row.values["timed"] = 0.0;
  EXPECT_EQ(reason(), "no time could be measured");
}

}  // namespace
}  // namespace sixdof::results
