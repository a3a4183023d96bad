#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

#include <sixdof/query/registry.h>

namespace sixdof::cli {

/// The options of a command that uses one algorithm.
struct AlgorithmOptions {
  std::string name;
  std::vector<std::string> parameters;  ///< "NAME=VALUE".
};

/// Adds --algorithm and -p,--parameter NAME=VALUE. @returns the option --algorithm
CLI::Option* add_algorithm_options(CLI::App& command, AlgorithmOptions& options, const std::string& description);

/// An algorithm of this build with its settings.
struct SelectedAlgorithm {
  Registry registry;
  const Algorithm* algorithm = nullptr;  ///< In `registry`.
  Settings settings;
};

/// @throws BadArgument if the algorithm or a parameter does not exist, or a value is not allowed
SelectedAlgorithm select_algorithm(const AlgorithmOptions& options);

}  // namespace sixdof::cli
