#include "bench/study/stress_text.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/process/remote_algorithm.h>
#include <sixdof/stability/ray_algorithm.h>

namespace sixdof::study {
namespace {

using stability::Verdict;

std::string_view word(Verdict verdict) {
  constexpr std::string_view k_words[] = {"exact", "within", "-", "WRONG", "NAN", "THREW", "MEMORY", "HUNG", "CRASH"};
  return k_words[static_cast<std::size_t>(verdict)];
}

/// Options of `sixdof query` with which a case ends a process, not the program; empty for a case that ended none.
std::string process_words(const StressCell& cell, const ProcessLimits& limits) {
  const bool ended = cell.worst.verdict >= Verdict::out_of_memory;
  if (!ended || dynamic_cast<const stability::RayAlgorithm*>(cell.algorithm) != nullptr) return {};
  constexpr double k_gb = 1e9;
  return fmt::format("{} --query-timeout {}s --prepare-timeout {}s --memory-limit {}",
                     is_isolated(*cell.algorithm) ? "" : " --isolate", limits.query_s, limits.prepare_s,
                     static_cast<double>(limits.memory_bytes) / k_gb);
}

}  // namespace

StressLine stress_line(const StressCell& cell, const std::filesystem::path& folder, const ProcessLimits& limits) {
  const auto& worst = cell.worst;
  const stability::Case member = make_case(*cell.family, cell.id), slow = make_case(*cell.family, cell.slow_id);
  const Settings settings = settings_of(*cell.algorithm, cell.which);
  return {
      .verdict = std::string(to_string(worst.verdict)),
      .metric = worst.metric,
      .worst = fmt::format("{:.3g} {}", worst.value, worst.unit),
      .member = member.name,
      .thread = member.thread,
      .reproduction = reproduction(member, worst.shot, *cell.algorithm, settings, folder) + process_words(cell, limits),
      .slow_reproduction = reproduction(slow, cell.slow_shot, *cell.algorithm, settings, folder),
      .words = worst.words,
      .parameter = member.parameter};
}

std::string stress_matrix(const std::vector<StressCell>& cells) {
  if (cells.empty()) return {};
  constexpr std::size_t k_first_column = 17;
  static constexpr std::size_t k_least_column = 6;
  std::string text = fmt::format("{:<{}}", "family", k_first_column);
  const auto width = [](const StressCell& cell) { return std::max(k_least_column, cell.name().size()); };
  for (const StressCell& cell : cells) {
    if (cell.family != cells.front().family) break;
    text += fmt::format(" {:>{}}", cell.name(), width(cell));
  }
  const stability::Family* family = nullptr;
  for (const StressCell& cell : cells) {
    if (cell.family != family)
      text += fmt::format("\n{:<{}}", fmt::format("{:2} {}", cell.family->number, cell.family->name), k_first_column);
    family = cell.family;
    text += fmt::format(" {:>{}}", word(cell.worst.verdict), width(cell));
  }
  return text + "\n";
}

nlohmann::ordered_json stress_json(const std::vector<StressCell>& cells, const std::vector<StressLine>& lines,
                                   std::uint64_t seed) {
  auto list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const StressCell& cell = cells[i];
    const StressLine& line = lines[i];
    list.push_back({{"family", cell.family->name},
                    {"algorithm", cell.name()},
                    {"verdict", line.verdict},
                    {"cases", cell.cases},
                    {"worst", cell.worst.value},
                    {"unit", cell.worst.unit},
                    {"reproduction", line.reproduction},
                    {"metric", line.metric},
                    {"case", line.member},
                    {"thread", line.thread},
                    {"parameter", line.parameter},
                    {"words", line.words},
                    {"times_of_rounding", cell.worst.excess},
                    {"unsupported", cell.unsupported},
                    {"slowest_s", cell.slowest_seconds},
                    {"slowest_reproduction", line.slow_reproduction},
                    {"version", cell.algorithm->traits().version},
                    {"settings", cell.settings},
                    {"seed", seed}});
  }
  return list;
}

}  // namespace sixdof::study
