#pragma once

#include <functional>

#include <CLI/App.hpp>

namespace sixdof::cli {

/// Exit codes of every program of this project.
constexpr int k_exit_error = 1;          ///< The work could not be done; one line on stderr says why.
constexpr int k_exit_usage = 2;          ///< The command line was not understood.
constexpr int k_exit_interrupted = 130;  ///< Ctrl-C or SIGTERM (128 + SIGINT, as shells have it).

/// Adds every command to the application.
void add_commands(CLI::App& app);

/// Runs `work` and turns whatever it throws into one line "PROGRAM: MESSAGE" on stderr and an exit code; a clean return
/// whose output could not be written (disk full, closed pipe) is an error too. Never a stack trace.
int run_guarded(const char* program, const std::function<void()>& work);

/// The program `sixdof`.
int run(int argc, const char* const* argv);

}  // namespace sixdof::cli
