#include "bench/cli/algorithm_options.h"

#include "bench/common/all_algorithms.h"

namespace sixdof::cli {

CLI::Option* add_algorithm_options(CLI::App& command, AlgorithmOptions& options, const std::string& description) {
  auto* const algorithm = command.add_option("--algorithm", options.name, description);
  command
      .add_option("-p,--parameter", options.parameters,
                  "Parameter of the algorithm: NAME=VALUE (sixdof algorithms lists them); may be repeated")
      ->allow_extra_args(false);
  return algorithm;
}

SelectedAlgorithm select_algorithm(const AlgorithmOptions& options) {
  SelectedAlgorithm selected;
  register_all_algorithms(selected.registry);
  selected.algorithm = &selected.registry.find(options.name);
  selected.settings = selected.algorithm->settings();
  selected.settings.set_all(options.parameters);
  return selected;
}

}  // namespace sixdof::cli
