#include "bench/cli/table.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof::cli {
namespace {

using nlohmann::json;

/// "collide/algorithm:fcl-rss/pair:elephant/distance:05/order:path" taken apart.
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

/// Rows that one result file has under the same name are repetitions: the least mean and what goes with it are shown.
/// Queries run on one thread, so the mean is its processor time, which other work on the machine disturbs least.
struct Cell {
  double mean_us = 0.0;
  double p99_us = 0.0;
  double max_us = 0.0;
  /// Responses only: mean and largest angle of the force to the exact one, where there are forces to compare.
  std::optional<std::pair<double, double>> angles_degrees;
  bool response = false;
  bool error = false;
  bool failed = false;
  bool mismatch = false;

  std::string text() const {
    if (error) return "error";
    const std::string marks = fmt::format("{}{}", mismatch ? "!" : "", failed ? "?" : "");
    if (!response) return fmt::format("{} / {}{}", number(mean_us), number(p99_us), marks);
    return fmt::format("{} / {} / {}, {}{}", number(mean_us), number(p99_us), number(max_us), angles(), marks);
  }
  std::string angles() const {
    if (!angles_degrees) return "-";
    return fmt::format("{:.2f} / {:.1f}", angles_degrees->first, angles_degrees->second);
  }
  static std::string number(double us) {
    if (us < 0.01) return fmt::format("{:.4f}", us);
    return us < 10 ? fmt::format("{:.2f}", us) : us < 100 ? fmt::format("{:.1f}", us) : fmt::format("{:.0f}", us);
  }
};

using Line = std::map<std::string, Cell>;  ///< By bucket.

struct Block {
  std::vector<std::string> titles;  ///< In order of appearance.
  std::map<std::string, Line> lines;
};

double nanoseconds_per(const std::string& unit) {
  if (unit == "us") return 1e3;
  if (unit == "ms") return 1e6;
  return unit == "s" ? 1e9 : 1.0;
}

Cell cell_of(const json& row) {
  Cell cell;
  cell.error = row.value("error_occurred", false);
  if (cell.error) return cell;
  cell.mean_us = row.at("cpu_time").get<double>() * nanoseconds_per(row.value("time_unit", "ns")) / 1e3;
  cell.p99_us = row.value("p99_ns", 0.0) / 1e3;
  cell.max_us = row.value("max_ns", 0.0) / 1e3;
  if (row.contains("gamma_F_deg")) {
    cell.angles_degrees = {row.at("gamma_F_deg").get<double>(), row.at("gamma_max_F_deg").get<double>()};
  }
  cell.failed = row.value("failed", 0.0) > 0;
  cell.mismatch = row.value("mismatch", 0.0) > 0;
  return cell;
}

void print(std::string& out, const std::string& title, const Block& block) {
  std::vector<std::string> buckets;
  std::size_t first_width = 0, width = 0;
  for (const auto& [name, line] : block.lines) {
    first_width = std::max(first_width, name.size());
    for (const auto& [bucket, cell] : line) {
      if (std::find(buckets.begin(), buckets.end(), bucket) == buckets.end()) buckets.push_back(bucket);
      width = std::max(width, cell.text().size());
    }
  }
  std::sort(buckets.begin(), buckets.end());
  out += title + "\n";
  out += fmt::format("{:<{}}", "", first_width);
  for (const std::string& bucket : buckets) out += fmt::format("  {:>{}}", bucket + " %", width);
  out += "\n";
  for (const std::string& name : block.titles) {
    out += fmt::format("{:<{}}", name, first_width);
    for (const std::string& bucket : buckets) {
      const Line& line = block.lines.at(name);
      const auto found = line.find(bucket);
      out += fmt::format("  {:>{}}", found == line.end() ? "-" : found->second.text(), width);
    }
    out += "\n";
  }
  out += "\n";
}

}  // namespace

std::string results_table(const std::string& text, const std::string& file) {
  std::vector<std::string> order;
  std::map<std::string, Block> blocks;
  try {
    const json document = json::parse(text);
    for (const json& row : document.at("benchmarks")) {
      if (row.value("run_type", "iteration") != "iteration") continue;
      const RowName name = parse_row_name(row.at("name").get<std::string>());
      for (const char* kind : {"distance", "volume"}) {
        const auto bucket = name.parts.find(kind);
        if (bucket == name.parts.end() || !name.parts.contains("algorithm") || !name.parts.contains("pair")) continue;
        const bool response = name.question == "respond";
        const std::string title =
            fmt::format("{}: {}, at {}", name.parts.at("pair"),
                        response ? "mean / p99 / max in us, force's angle to the exact one mean / max in degrees"
                                 : "mean / p99 in us",
                        kind == std::string("distance") ? "distances in percent of A's box diagonal"
                                                        : "overlaps in percent of A's volume");
        if (!blocks.contains(title)) order.push_back(title);
        Block& block = blocks[title];
        std::string line = name.question + " " + name.parts.at("algorithm");
        if (name.parts.contains("order")) line += " (" + name.parts.at("order") + ")";
        if (!block.lines.contains(line)) block.titles.push_back(line);
        Cell cell = cell_of(row);
        cell.response = response;
        const auto [place, fresh] = block.lines[line].emplace(bucket->second, cell);
        if (!fresh && !cell.error && (place->second.error || cell.mean_us < place->second.mean_us)) {
          place->second = cell;
        }
      }
    }
  } catch (const json::exception& e) {
    throw BadFile(file, std::string("no result file of sixdof-bench: ") + e.what());
  }
  std::string out;
  for (const std::string& title : order) print(out, title, blocks.at(title));
  if (out.empty()) return "no query rows\n";
  return out + "! some answers were wrong   ? some queries gave no answer\n";
}

void add_table_command(CLI::App& app) {
  auto* const command = app.add_subcommand("table", "Results of sixdof-bench as tables");
  const auto file = std::make_shared<std::string>();
  command->add_option("file", *file, "Result file (JSON)")->required();
  command->callback([file] {
    std::ifstream in(*file);
    if (!in) throw BadFile(*file, "cannot be opened");
    std::ostringstream text;
    text << in.rdbuf();
    fmt::print("{}", results_table(text.str(), *file));
  });
}

}  // namespace sixdof::cli
