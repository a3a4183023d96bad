#include "bench/cli/commands.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/measure/metrics.h>
#include "bench/cli/shared.h"
#include "bench/common/row_name.h"

namespace sixdof::cli {
namespace {

using nlohmann::json;

/// Metrics of one unit that a cell shows side by side, with names for the title.
struct Group {
  std::string names;
  std::vector<const char*> metrics;
};

/// The first metric is the mean of the processor time: a query runs on one thread, and other work on the machine hardly
/// changes this time.
const std::vector<Group>& groups_of(const std::string& question) {
  static const std::vector<Group> times{{"mean / p99", {"cpu_time", "p99_ns"}}};
  static const std::vector<Group> responses{
      {"mean / p99 / max", {"cpu_time", "p99_ns", "max_ns"}},
      {"force's angle to the exact one mean / max", {"gamma_F_deg", "gamma_max_F_deg"}}};
  return question == "respond" ? responses : times;
}

bool is_time(const Metric& metric) { return metric.unit == "ns" || metric.unit == "time_unit"; }

std::string title_of(const std::vector<Group>& groups) {
  std::vector<std::string> titles;
  for (const Group& group : groups) {
    const Metric& metric = *find_metric(group.metrics.front());
    titles.push_back(is_time(metric) ? group.names + " in us" : fmt::format("{} in {}s", group.names, metric.unit));
  }
  return fmt::format("{}", fmt::join(titles, ", "));
}

/// In microseconds for times, in the metric's own unit otherwise; empty where the row has no such value.
std::optional<double> value_of(const json& row, const Metric& metric) {
  const auto found = row.find(metric.name);
  if (found == row.end()) return std::nullopt;
  static const std::map<std::string, double> nanoseconds{{"us", 1e3}, {"ms", 1e6}, {"s", 1e9}};
  const auto unit = nanoseconds.find(metric.unit == "time_unit" ? row.value("time_unit", "ns") : "ns");
  const double factor = unit == nanoseconds.end() ? 1.0 : unit->second;
  return is_time(metric) ? found->get<double>() * factor / 1e3 : found->get<double>();
}

std::string text_of(const Group& group, const json& row) {
  std::vector<std::string> texts;
  for (const char* name : group.metrics) {
    const Metric& metric = *find_metric(name);
    const std::optional<double> value = value_of(row, metric);
    if (!value) return "-";
    // Three significant digits of a time; the largest angle with fewer decimals than the mean one.
    const int decimals = !is_time(metric) ? (texts.empty() ? 2 : 1)
                         : *value < 0.01  ? 4
                         : *value < 10.0  ? 2
                         : *value < 100.0 ? 1
                                          : 0;
    texts.push_back(fmt::format("{:.{}f}", *value, decimals));
  }
  return fmt::format("{}", fmt::join(texts, " / "));
}

struct Cell {
  std::string text = "error";
  std::optional<double> mean;  ///< Empty for a row that could not be run.
};

Cell cell_of(const json& row, const std::vector<Group>& groups) {
  if (row.value("error_occurred", false)) return {};
  std::vector<std::string> texts;
  for (const Group& group : groups) texts.push_back(text_of(group, row));
  const char* const wrong = row.value("mismatch", 0.0) > 0 ? "!" : "";
  const char* const failed = row.value("failed", 0.0) > 0 ? "?" : "";
  return {fmt::format("{}{}{}", fmt::join(texts, ", "), wrong, failed),
          value_of(row, *find_metric(groups.front().metrics.front()))};
}

using Line = std::map<std::string, Cell>;  ///< By bucket.

using Block = nlohmann::ordered_map<std::string, Line>;  ///< By name of the line, in order of appearance.

void print(std::string& out, const std::string& title, const Block& block) {
  std::set<std::string> buckets;
  std::size_t first_width = 0, width = 0;
  for (const auto& [name, line] : block) {
    first_width = std::max(first_width, name.size());
    for (const auto& [bucket, cell] : line) {
      buckets.insert(bucket);
      width = std::max(width, cell.text.size());
    }
  }
  out += title + "\n" + fmt::format("{:<{}}", "", first_width);
  for (const std::string& bucket : buckets) out += fmt::format("  {:>{}}", bucket + " %", width);
  out += "\n";
  for (const auto& [name, line] : block) {
    out += fmt::format("{:<{}}", name, first_width);
    for (const std::string& bucket : buckets) {
      const auto found = line.find(bucket);
      out += fmt::format("  {:>{}}", found == line.end() ? "-" : found->second.text, width);
    }
    out += "\n";
  }
  out += "\n";
}

}  // namespace

std::string results_table(const std::string& text, const std::string& file) {
  const std::pair<const char*, const char*> kinds[] = {{"distance", "distances in percent of A's box diagonal"},
                                                       {"volume", "overlaps in percent of A's volume"}};
  const Better better = find_metric("cpu_time")->better;
  nlohmann::ordered_map<std::string, Block> blocks;  // by title
  try {
    const json document = json::parse(text);
    for (const json& row : document.at("benchmarks")) {
      if (row.value("run_type", "iteration") != "iteration") continue;
      const auto name = row_name_parts(row.at("name").get<std::string>());
      if (!name.contains("algorithm") || !name.contains("pair")) continue;
      for (const auto& [kind, buckets] : kinds) {
        if (!name.contains(kind)) continue;
        const std::vector<Group>& groups = groups_of(name.at("query"));
        const std::string title = fmt::format("{}: {}, at {}", name.at("pair"), title_of(groups), buckets);
        std::string line = name.at("query") + " " + name.at("algorithm");
        if (name.contains("order")) line += " (" + name.at("order") + ")";
        // Rows of the same name are repetitions, of which the one with the best mean is shown.
        const Cell cell = cell_of(row, groups);
        Cell& shown = blocks[title][line].try_emplace(name.at(kind), cell).first->second;
        if (cell.mean && (!shown.mean || is_better(better, *cell.mean, *shown.mean))) shown = cell;
      }
    }
  } catch (const json::exception& e) {
    throw BadFile(file, std::string("not a result file of sixdof-bench: ") + e.what());
  }
  std::string out;
  for (const auto& [title, block] : blocks) print(out, title, block);
  if (out.empty()) return "no query rows\n";
  return out + "! some answers were wrong   ? some queries gave no answer\n";
}

void add_table_command(CLI::App& app) {
  auto* const command = app.add_subcommand("table", "Print results of sixdof-bench as tables");
  const auto file = std::make_shared<std::string>();
  command->add_option("file", *file, "Result file (JSON)")->required();
  command->callback([file] {
    std::ifstream in(*file);
    if (!in) throw BadFile(*file, "cannot be opened");
    std::ostringstream text;
    text << in.rdbuf();
    fmt::print("{}", results_table(text.str(), *file));
  });
  add_examples(*command,
               "sixdof-bench --benchmark_filter=/algorithm:exact/pair:torus-knot-10k/distance:05 --sample 32 "
               "--out results.json",
               "sixdof table results.json");
}

}  // namespace sixdof::cli
