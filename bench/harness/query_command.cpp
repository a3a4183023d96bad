#include "bench/harness/query_command.h"

#include <cstddef>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/own_command.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/process/remote_algorithm.h>
#include "bench/common/process_options.h"

namespace sixdof::bench {
namespace {

std::vector<std::string> assignments(const Settings& settings) {
  std::vector<std::string> list;
  std::istringstream text(settings.to_string());
  for (std::string item; std::getline(text, item, ',');) list.push_back(item);
  return list;
}

}  // namespace

std::string query_command(const std::string& a, const std::string& b, const Algorithm& asked,
                          const Settings& settings) {
  const Algorithm& algorithm = base_algorithm(asked);
  std::string command = fmt::format("sixdof query --a {} --b {} --algorithm {}", shell_quoted(a), shell_quoted(b),
                                    algorithm.traits().name);
  const std::vector<std::string> chosen = assignments(settings), defaults = assignments(algorithm.settings());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] != defaults[i]) command += " -p " + shell_quoted(chosen[i]);
  }
  return own_command(command + process_option(algorithm));
}

std::string process_option(const Algorithm& algorithm) {
  const auto* const remote = dynamic_cast<const RemoteAlgorithm*>(&base_algorithm(algorithm));
  if (remote == nullptr) return {};
  std::string words;
  if (remote->local() != nullptr) {
    words = " --isolate";
  } else if (!algorithm.traits().is_rival()) {
    words = fmt::format(" --external {}", shell_quoted(algorithm.traits().name + "=" + remote->command_line()));
  }
  constexpr double k_gb = 1e9;
  const ProcessLimits &limits = remote->limits(), usual = ProcessOptions().limits();
  if (limits.query_s != usual.query_s) words += fmt::format(" --query-timeout {}s", limits.query_s);
  if (limits.prepare_s != usual.prepare_s) words += fmt::format(" --prepare-timeout {}s", limits.prepare_s);
  if (limits.memory_bytes != usual.memory_bytes) {
    words += fmt::format(" --memory-limit {}", static_cast<double>(limits.memory_bytes) / k_gb);
  }
  return words;
}

}  // namespace sixdof::bench
