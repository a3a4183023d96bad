#include "bench/common/process_options.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/shell_text.h>
#include "bench/common/duration.h"

namespace sixdof {
namespace {

constexpr double k_gb = 1e9;

}  // namespace

double ProcessOptions::default_memory_gb() {
  return std::round(10.0 * static_cast<double>(default_memory_limit()) / k_gb) / 10.0;
}

ProcessLimits ProcessOptions::limits() const {
  return {.query_s = parse_duration("--query-timeout", query_timeout),
          .prepare_s = parse_duration("--prepare-timeout", prepare_timeout),
          .memory_bytes = static_cast<std::size_t>(k_gb * memory_gb),
          .reuse = reuse};
}

void add_process_options(CLI::App& command, ProcessOptions& options) {
  const std::string group = "Algorithms in processes of their own";
  command
      .add_flag("--isolate{all}", options.isolate,
                fmt::format(
                    "Algorithms to run in processes of their own, where a crash or a hang costs only one query. Plain "
                    "--isolate means all; without the option: {}",
                    options.isolate))
      ->check(CLI::IsMember({"none", "third-party", "all"}))
      ->type_name("WHICH")
      ->group(group);
  command
      .add_option("--external", options.external,
                  "Add an algorithm in any language: 'NAME=PROGRAM ARGUMENTS', a program that answers the protocol of "
                  "lib/sixdof/process/README.md; may be repeated")
      ->type_name("NAME=COMMAND")
      ->allow_extra_args(false)
      ->group(group);
  command.add_option("--query-timeout", options.query_timeout, "Longest time of one query: 10s, 50ms")
      ->type_name("TIME")
      ->capture_default_str()
      ->group(group);
  command.add_option("--prepare-timeout", options.prepare_timeout, "Longest time of preparing a pair of meshes")
      ->type_name("TIME")
      ->capture_default_str()
      ->group(group);
  command.add_option("--memory-limit", options.memory_gb, "Memory of each process, in GB; 0: no limit")
      ->type_name("GB")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->group(group);
}

std::string process_words(const ProcessOptions& options, const ProcessOptions& usual) {
  std::string words;
  if (options.isolate != usual.isolate) words += fmt::format(" --isolate={}", options.isolate);
  for (const std::string& external : options.external) words += fmt::format(" --external {}", shell_quoted(external));
  if (options.query_timeout != usual.query_timeout) {
    words += fmt::format(" --query-timeout {}", shell_quoted(options.query_timeout));
  }
  if (options.prepare_timeout != usual.prepare_timeout) {
    words += fmt::format(" --prepare-timeout {}", shell_quoted(options.prepare_timeout));
  }
  if (options.memory_gb != usual.memory_gb) words += fmt::format(" --memory-limit {}", options.memory_gb);
  return words;
}

std::pair<std::string, std::string> parse_external(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw BadArgument(fmt::format("--external {}: must read NAME=COMMAND", text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace sixdof
