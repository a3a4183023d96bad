#pragma once

#include <array>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <Eigen/Core>

#include <sixdof/base/own_command.h>
#include <sixdof/query/registry.h>
#include "bench/common/all_algorithms.h"
#include "bench/common/help_format.h"

/// What several commands share.

namespace sixdof::cli {

/// Ends the help of `command` with `more`, if there is any, and two examples, each a full command line for a shell. One
/// that begins with a program of this project gets its name in a project of `sixdof new-algorithm`.
/// test/cli/examples_test.cpp runs the examples of all commands in one empty folder, in the order in which `sixdof
/// --help` lists the commands, so a later example may use a file that an earlier one wrote. None needs a fetched model.
inline void add_examples(CLI::App& command, const std::string& first, const std::string& second,
                         const std::string& more = {}) {
  command.footer((more.empty() ? "" : more + "\n\n") + "Examples:\n  " + own_command(first) + "\n  " +
                 own_command(second));
}

/// As JSON takes it.
inline std::array<double, 3> coordinates(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// The options of a command that uses one algorithm.
struct AlgorithmOptions {
  std::string name;
  std::vector<std::string> parameters;  ///< "NAME=VALUE".
  ProcessOptions process = {};
};

/// Adds --algorithm and -p,--parameter NAME=VALUE. @returns the option --algorithm
inline CLI::Option* add_algorithm_options(CLI::App& command, AlgorithmOptions& options,
                                          const std::string& description) {
  auto* const algorithm = command.add_option("--algorithm", options.name, description)->type_name("ALGORITHM");
  command
      .add_option("-p,--parameter", options.parameters,
                  "Parameter of the algorithm (sixdof algorithms lists them); may be repeated")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  return algorithm;
}

/// An algorithm of this build with its settings.
struct SelectedAlgorithm {
  Registry registry;
  const Algorithm* algorithm = nullptr;  ///< In `registry`.
  Settings settings;
};

/// @throws BadArgument if the algorithm or a parameter does not exist, or a value is not allowed
inline SelectedAlgorithm select_algorithm(const AlgorithmOptions& options) {
  SelectedAlgorithm selected;
  register_all_algorithms(selected.registry, options.process);
  selected.algorithm = &selected.registry.find(options.name);
  selected.settings = selected.algorithm->settings();
  selected.settings.set_all(options.parameters);
  return selected;
}

}  // namespace sixdof::cli
