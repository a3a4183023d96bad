#include <sixdof/base/own_command.h>

#include <cerrno>
#include <string_view>

namespace sixdof {
namespace {

constexpr std::string_view k_cli = "sixdof", k_bench = "sixdof-bench";
/// Ends of the names of a project's programs.
constexpr std::string_view k_ends[] = {"-sixdof", "-bench", "-conformance"};

/// What this program's name has before "sixdof", "bench" or "conformance"; empty for the programs of this project, and
/// for others.
std::string prefix() {
  const std::string_view name = program_invocation_short_name;
  if (name == k_bench) return {};
  for (const std::string_view end : k_ends) {
    if (name.ends_with(end)) return std::string(name.substr(0, name.size() - end.size() + 1));
  }
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
