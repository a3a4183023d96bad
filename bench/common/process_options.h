#pragma once

#include <string>
#include <utility>
#include <vector>

#include <sixdof/process/remote_query.h>

namespace CLI {
class App;
}

namespace sixdof {

/// Options of a command: which algorithms run in processes of their own, and what these may use.
struct ProcessOptions {
  std::string isolate = "none";       ///< "none", "third-party" (all but the core's own) or "all".
  std::vector<std::string> external;  ///< "NAME=COMMAND": algorithms that answer the protocol.
  std::string query_timeout = "10s";
  std::string prepare_timeout = "10min";
  double memory_gb = default_memory_gb();  ///< 0 for no limit.
  bool rivals = true;                      ///< Those that are set up (rivals.h).
  bool reuse = false;                      ///< ProcessLimits::reuse.

  static double default_memory_gb();

  /// @throws BadArgument for a time that cannot be read
  ProcessLimits limits() const;
};

/// Adds --isolate, --external, --query-timeout, --prepare-timeout and --memory-limit. The default of --isolate is what
/// `options` has.
void add_process_options(CLI::App& command, ProcessOptions& options);

/// The options as words for a shell, each with a space before it, without those that are as in `usual`.
std::string process_words(const ProcessOptions& options, const ProcessOptions& usual = {});

/// "NAME=COMMAND". @throws BadArgument
std::pair<std::string, std::string> parse_external(const std::string& text);

}  // namespace sixdof
