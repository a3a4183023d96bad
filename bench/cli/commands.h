#pragma once

namespace sixdof::cli {

/// The program `sixdof`: parses the command line and runs one command. @returns the exit code (common/run_guarded.h);
/// without arguments it prints what to do first on stderr and returns k_exit_usage, since no command was given
int run(int argc, const char* const* argv);

}  // namespace sixdof::cli
