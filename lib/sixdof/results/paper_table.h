#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The table of the values that Weller et al. 2010 print (paper.h), beside those that were measured in their place at
/// equal time, and which of them are worse.

namespace sixdof::results {

/// Of one algorithm along a scenario's path.
struct ScenarioMeasures {
  /// By names of the table of metrics. A name without suffix is over the scenario's window, against the right ideal;
  /// with "_all" over the whole path, which is absent where the window is all of it; with "_all_by_paper" over the
  /// whole path against the ideal as printed.
  std::map<std::string, double> values;
  double mean_ns = 0.0;  ///< Processor time of a query.
};

/// What `sixdof equivalent` found in a scenario at a given mean time.
struct EqualTimeAnswer {
  std::string scenario, algorithm;
  double tau_ns = 0.0;     ///< The given time.
  std::string resolution;  ///< "voxel_size=0.016 point_spacing=0.004".
  std::string remark;      ///< "all faster"; empty where there is none.
  ScenarioMeasures found = {};
  std::optional<ScenarioMeasures> at_defaults = {};  ///< With the default resolution.
};

/// A value in place of the printed one.
struct Reading {
  double value = 0.0;
  bool worse = false;  ///< Than the printed one.
};

/// One printed value and its readings (lib/sixdof/scenario/README.md, "The paper's values"); absent where the measure
/// is not defined.
struct PaperLine {
  double tau_ns = 0.0;
  std::string scenario, algorithm, measure;
  double printed = 0.0;
  std::string resolution, remark;
  double mean_ns = 0.0;
  std::optional<Reading> as_printed;          ///< Formula and ideal as printed, over the whole path.
  std::optional<Reading> whole_path, window;  ///< Against the right ideal.
  std::optional<Reading> window_at_defaults;  ///< The same in the window, with the default resolution,
  std::optional<double> mean_ns_at_defaults;  ///< which takes so long.
};

/// By the metric's better direction. @throws BadArgument for a measure that the table of metrics does not have
bool worse_than_printed(std::string_view measure, double value, double printed);

/// Whose printed values were asked for: by tau in the order of the answers, then in the order of k_paper_values.
std::vector<PaperLine> paper_lines(std::span<const EqualTimeAnswer> answers);

}  // namespace sixdof::results
