#include "bench/harness/query_command.h"

#include <cstddef>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include <sixdof/process/remote_algorithm.h>
#include "bench/common/own_command.h"
#include "bench/common/shell_text.h"

namespace sixdof::bench {
namespace {

std::vector<std::string> assignments(const Settings& settings) {
  std::vector<std::string> list;
  std::istringstream text(settings.to_string());
  for (std::string item; std::getline(text, item, ',');) list.push_back(item);
  return list;
}

}  // namespace

std::string query_command(const std::string& a, const std::string& b, const Algorithm& algorithm,
                          const Settings& settings) {
  std::string command = fmt::format("sixdof query --a {} --b {} --algorithm {}", shell_quoted(a), shell_quoted(b),
                                    algorithm.traits().name);
  const std::vector<std::string> chosen = assignments(settings), defaults = assignments(algorithm.settings());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] != defaults[i]) command += " -p " + shell_quoted(chosen[i]);
  }
  const bool is_of_this_program = &in_this_process(algorithm) != &algorithm;
  return own_command(command + external_option(algorithm) + (is_of_this_program ? " --isolate" : ""));
}

std::string external_option(const Algorithm& algorithm) {
  const auto* const remote = dynamic_cast<const RemoteAlgorithm*>(&algorithm);
  if (remote == nullptr || remote->command_line().empty() || algorithm.traits().is_rival()) return {};
  return " --external " + shell_quoted(algorithm.traits().name + "=" + remote->command_line());
}

}  // namespace sixdof::bench
