#pragma once

#include <functional>
#include <string_view>

#include <sixdof/base/error.h>

namespace sixdof {

/// Exit codes of every program of this project.
constexpr int k_exit_error = 1;    ///< The work could not be done; one line on stderr says why.
constexpr int k_exit_usage = 2;    ///< The command line was not understood.
constexpr int k_exit_defects = 3;  ///< The work was done, and its result has defects; one line on stderr says which.
constexpr int k_exit_interrupted = 130;  ///< Ctrl-C or SIGTERM (128 + SIGINT, as in shells).

/// Ends the work with k_exit_defects.
struct DefectsFound : Error {
  using Error::Error;
};

/// Runs `work` and turns whatever it throws into one line "PROGRAM: MESSAGE" on stderr and an exit code. A clean return
/// whose output could not be written (disk full, closed pipe) is an error too.
/// @throws CLI::Error, which the caller's parser reports
int run_guarded(std::string_view program, const std::function<void()>& work);

/// Prints the line "PROGRAM: MESSAGE" on stderr.
void print_message(std::string_view program, std::string_view message);

}  // namespace sixdof
