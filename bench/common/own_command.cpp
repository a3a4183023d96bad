#include "bench/common/own_command.h"

#include <cerrno>
#include <string_view>

namespace sixdof {
namespace {

constexpr std::string_view k_cli = "sixdof", k_bench = "sixdof-bench", k_bench_suffix = "-bench";

/// What this program's name has before "sixdof" or "bench"; empty for the programs of this project, and for others.
std::string prefix() {
  const std::string_view name = program_invocation_short_name;
  if (name == k_bench) return {};
  if (name.ends_with("-sixdof")) return std::string(name.substr(0, name.size() - k_cli.size()));
  if (name.ends_with(k_bench_suffix)) return std::string(name.substr(0, name.size() - k_bench_suffix.size() + 1));
  return {};
}

}  // namespace

std::string own_bench_program() {
  const std::string own = prefix();
  return own.empty() ? std::string(k_bench) : own + "bench";
}

std::string own_command(const std::string& command) {
  const std::string own = prefix();
  if (own.empty() || !command.starts_with(k_cli)) return command;
  if (command.starts_with(k_bench)) return own_bench_program() + command.substr(k_bench.size());
  return own + command;
}

}  // namespace sixdof
