#include "bench/cli/table.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/measure/metrics.h>

#include "bench/common/examples.h"

namespace sixdof::cli {
namespace {

using nlohmann::json;

/// "collide/algorithm:fcl-rss/pair:elephant/distance:05/order:path" in parts.
struct RowName {
  std::string question;
  std::map<std::string, std::string> parts;
};

RowName parse_row_name(const std::string& name) {
  RowName result;
  std::istringstream words(name);
  std::getline(words, result.question, '/');
  for (std::string word; std::getline(words, word, '/');) {
    const auto colon = word.find(':');
    if (colon != std::string::npos) result.parts[word.substr(0, colon)] = word.substr(colon + 1);
  }
  return result;
}

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

double nanoseconds_per(const std::string& unit) {
  if (unit == "us") return 1e3;
  if (unit == "ms") return 1e6;
  return unit == "s" ? 1e9 : 1.0;
}

/// In microseconds for times, in the metric's own unit otherwise; empty where the row has no such value.
std::optional<double> value_of(const json& row, const Metric& metric) {
  const auto found = row.find(metric.name);
  if (found == row.end()) return std::nullopt;
  const double factor = metric.unit == "time_unit" ? nanoseconds_per(row.value("time_unit", "ns")) : 1.0;
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

struct Block {
  std::vector<std::string> names;  ///< Of the lines, in order of appearance.
  std::map<std::string, Line> lines;

  /// Rows of the same name are repetitions, of which the one with the best mean is shown.
  void add(const std::string& name, const std::string& bucket, const Cell& cell) {
    if (!lines.contains(name)) names.push_back(name);
    Cell& shown = lines[name].try_emplace(bucket, cell).first->second;
    const Better better = find_metric("cpu_time")->better;
    if (cell.mean && (!shown.mean || is_better(better, *cell.mean, *shown.mean))) shown = cell;
  }
};

void print(std::string& out, const std::string& title, const Block& block) {
  std::vector<std::string> buckets;
  std::size_t first_width = 0, width = 0;
  for (const auto& [name, line] : block.lines) {
    first_width = std::max(first_width, name.size());
    for (const auto& [bucket, cell] : line) {
      if (std::find(buckets.begin(), buckets.end(), bucket) == buckets.end()) buckets.push_back(bucket);
      width = std::max(width, cell.text.size());
    }
  }
  std::sort(buckets.begin(), buckets.end());
  out += title + "\n" + fmt::format("{:<{}}", "", first_width);
  for (const std::string& bucket : buckets) out += fmt::format("  {:>{}}", bucket + " %", width);
  out += "\n";
  for (const std::string& name : block.names) {
    out += fmt::format("{:<{}}", name, first_width);
    const Line& line = block.lines.at(name);
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
  std::vector<std::string> order;
  std::map<std::string, Block> blocks;
  try {
    const json document = json::parse(text);
    for (const json& row : document.at("benchmarks")) {
      if (row.value("run_type", "iteration") != "iteration") continue;
      const RowName name = parse_row_name(row.at("name").get<std::string>());
      if (!name.parts.contains("algorithm") || !name.parts.contains("pair")) continue;
      for (const auto& [kind, buckets] : kinds) {
        if (!name.parts.contains(kind)) continue;
        const std::vector<Group>& groups = groups_of(name.question);
        const std::string title = fmt::format("{}: {}, at {}", name.parts.at("pair"), title_of(groups), buckets);
        if (!blocks.contains(title)) order.push_back(title);
        std::string line = name.question + " " + name.parts.at("algorithm");
        if (name.parts.contains("order")) line += " (" + name.parts.at("order") + ")";
        blocks[title].add(line, name.parts.at(kind), cell_of(row, groups));
      }
    }
  } catch (const json::exception& e) {
    throw BadFile(file, std::string("not a result file of sixdof-bench: ") + e.what());
  }
  std::string out;
  for (const std::string& title : order) print(out, title, blocks.at(title));
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
