#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/query/settings.h>
#include <sixdof/results/paper_table.h>
#include <sixdof/results/row.h>
#include "bench/study/equivalent.h"

/// Results of `sixdof equivalent`: rows of a file, and how well the predictions of eta were.

namespace sixdof::study {

/// One search in a scenario.
struct EquivalentResult {
  std::string scenario;
  std::string algorithm;
  Settings settings;  ///< Of the parameters that were not searched.
  std::string law;    ///< Of the ideal that eta compares with.
  std::array<ResolutionAxis, 2> axes;
  SearchOptions options;
  SearchResult search;
  bool isolated = false;                        ///< The algorithm runs in a process of its own.
  std::optional<Measurement> at_defaults = {};  ///< With the settings as they are.
};

/// "equivalent/scenario:Ia/algorithm:vps/tau:0.9ms" is the answer; ".../step:0" the first prediction, ".../step:1" and
/// so on its refinements; ".../voxel_size:0.016/point_spacing:0.004" a point of the grid; ".../defaults" what was
/// measured with the settings as they are. With an eta given, "eta:0.05" stands in place of tau. Answer and steps have
/// the counters eta_predicted, eta_measured, predicted_ns, measured_ns, and tau_ns or eta_wanted; the others the
/// measured ones.
std::vector<results::Row> equivalent_rows(const EquivalentResult& result);

/// The answers of searches for a given time, for the paper's table. Others are left out.
std::vector<results::EqualTimeAnswer> equal_time_answers(std::span<const EquivalentResult> searches);

/// How far predictions of eta were from what was measured, over several searches.
struct PredictionError {
  std::size_t searches = 0;
  double difference = 0.0;  ///< Mean of |predicted - measured|, a difference of etas.
  double relative = 0.0;    ///< Mean of |predicted - measured| / measured.
};

/// Of the first predictions or of the answers. Searches whose eta is not defined or zero there are left out.
PredictionError prediction_error(std::span<const EquivalentResult> results, bool first);

/// "tau = 0.9ms" or "eta = 0.05".
std::string given_text(const SearchOptions& options);

/// "voxel_size=0.016 point_spacing=0.004".
std::string resolution_text(const std::array<ResolutionAxis, 2>& axes, const Resolution& at);

/// "0.9ms" and so on: in the largest unit of which the time is at least a tenth, six digits.
std::string time_text(double nanoseconds);

/// The inverse, of a number with a unit: ns, us, ms or s. @throws BadArgument without a unit, or not above zero
double parse_time_ns(const std::string& text);

}  // namespace sixdof::study
