#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sixdof/results/paper.h>
#include <sixdof/results/row_group.h>

namespace sixdof::results {

/// A measure of a scenario row over the whole path, and what the paper prints.
struct PaperMeasure {
  std::string name;             ///< "sigma_F".
  std::optional<double> value;  ///< Empty where it is not defined.
  std::optional<double> printed;
};

/// A row of a scenario beside the paper's: `sixdof-bench --suite paper`.
struct PaperScenarioLine {
  std::string scenario, algorithm;
  std::string law;                 ///< Of the ideal that the measures compare with; empty in older results.
  std::string resolution;          ///< resolution_text().
  std::string printed_resolution;  ///< The same of the paper; empty where it prints none.
  double mean_ns = 0.0;
  std::vector<PaperMeasure> measures;  ///< sigma, gamma and nu of forces and torques, always the same ones.
};

/// Names of the measures, in their order.
const std::vector<std::string>& paper_measures();

/// The scenario rows that could be run, in their order.
std::vector<PaperScenarioLine> paper_scenario_lines(const std::vector<RowGroup>& groups);

}  // namespace sixdof::results
