#pragma once

#include <string>

#include <CLI/App.hpp>

namespace sixdof {

/// Ends the help of `command` with two examples, each a full command line for a shell. test/cli/examples_test.cpp runs
/// the examples of all commands of `sixdof` in one empty folder, in the order in which `sixdof --help` lists the
/// commands, so a later example may use a file that an earlier one wrote. None needs a fetched model.
inline void add_examples(CLI::App& command, const std::string& first, const std::string& second) {
  command.footer("Examples:\n  " + first + "\n  " + second);
}

}  // namespace sixdof
