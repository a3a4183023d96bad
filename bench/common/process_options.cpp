#include "bench/common/process_options.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <sixdof/base/error.h>
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
          .memory_bytes = static_cast<std::size_t>(k_gb * memory_gb)};
}

void add_process_options(CLI::App& command, ProcessOptions& options) {
  command
      .add_flag("--isolate{all}", options.isolate,
                fmt::format("Run algorithms in processes of their own, so that a crash costs one configuration: "
                            "--isolate or --isolate=all, =third-party (all but those of this project) or =none. "
                            "{} if left out",
                            options.isolate))
      ->check(CLI::IsMember({"none", "third-party", "all"}));
  command
      .add_option("--external", options.external,
                  "An algorithm in any language: NAME=\"PROGRAM ARGUMENTS\", a program that answers the protocol of "
                  "lib/sixdof/process/README.md; may be repeated")
      ->allow_extra_args(false);
  command.add_option("--query-timeout", options.query_timeout, "Longest time of a query of an isolated algorithm")
      ->capture_default_str();
  command.add_option("--prepare-timeout", options.prepare_timeout, "Longest time that one prepares a pair")
      ->capture_default_str();
  command.add_option("--memory-limit", options.memory_gb, "Memory of an isolated algorithm in GB; 0: no limit")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

std::pair<std::string, std::string> parse_external(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw BadArgument(fmt::format("--external {}: must read NAME=COMMAND", text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace sixdof
