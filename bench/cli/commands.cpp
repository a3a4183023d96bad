#include "bench/cli/commands.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

#include <fmt/format.h>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <sixdof/base/error.h>
#include "bench/cli/algorithms.h"
#include "bench/cli/generate.h"
#include "bench/cli/info.h"
#include "bench/cli/merge.h"
#include "bench/cli/models.h"
#include "bench/cli/quality.h"
#include "bench/cli/query.h"
#include "bench/cli/show.h"
#include "bench/cli/table.h"
#include "bench/cli/verify.h"

namespace sixdof::cli {
namespace {

int report(const char* program, const char* message, int exit_code) {
  fmt::print(stderr, "{}: {}\n", program, message);
  return exit_code;
}

}  // namespace

void add_commands(CLI::App& app) {
  add_algorithms_command(app);
  add_info_command(app);
  add_models_command(app);
  add_quality_command(app);
  add_query_command(app);
  add_show_command(app);
  add_table_command(app);
  add_generate_command(app);
  add_merge_command(app);
  add_verify_command(app);
}

int run_guarded(const char* program, const std::function<void()>& work) {
  try {
    work();
  } catch (const CLI::Error&) {
    throw;
  } catch (const Interrupted& e) {
    return report(program, e.what(), k_exit_interrupted);
  } catch (const std::bad_alloc&) {
    return report(program, "out of memory", k_exit_error);
  } catch (const std::exception& e) {
    const std::string message = std::ferror(stdout) != 0 ? std::string("standard output: ") + e.what() : e.what();
    return report(program, message.c_str(), k_exit_error);
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    return report(program, fmt::format("standard output: {}", std::strerror(errno)).c_str(), k_exit_error);
  }
  return 0;
}

int run(int argc, const char* const* argv) {
  CLI::App app("sixdof: how fast and how right are collision queries in six degrees of freedom?", "sixdof");
  app.set_version_flag("--version", std::string("sixdof ") + SIXDOF_VERSION);
  app.require_subcommand(1);
  add_commands(app);
  try {
    return run_guarded("sixdof", [&] { app.parse(argc, argv); });
  } catch (const CLI::ParseError& e) {
    // Help and version end here too, with code 0.
    return app.exit(e) == 0 ? 0 : k_exit_usage;
  }
}

}  // namespace sixdof::cli
