#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "bench/harness/depth_truth.h"
#include "bench/harness/response_error.h"

namespace sixdof::bench {

/// How far responses are from what their algorithm's own law says.
struct OwnLawErrors {
  std::optional<std::array<VectorError, 2>> errors = {};  ///< Of forces and torques; none without a law.
  std::array<std::size_t, 2> unjudged = {};  ///< Answers whose truth is not known well enough: force, torque.

  /// Counters with "own" in their names.
  void report(benchmark::UserCounters& counters) const {
    if (!errors) return;
    const auto count = [&](const std::string& counter, auto value) { counters[counter] = static_cast<double>(value); };
    for (const auto& [error, suffix] : {std::pair(&errors->at(0), "F"), {&errors->at(1), "T"}}) {
      if (error->magnitude) count(fmt::format("magnitude_error_own_{}", suffix), error->magnitude->relative);
      if (!error->direction.gamma_degrees) continue;
      count(fmt::format("gamma_own_{}_deg", suffix), *error->direction.gamma_degrees);
      count(fmt::format("gamma_own_max_{}_deg", suffix), error->direction.largest_degrees);
    }
    count("compared_own", errors->at(0).direction.compared);
    if (unjudged[0] > 0) count("unjudged_own", unjudged[0]);
    if (unjudged[1] > 0) count("unjudged_own_T", unjudged[1]);
  }
};

/// Against the truths of a law of depth, the torques about the truth's reference point.
/// @param ask (place) -> Outcome<Response>, at the pose of truths[place]; what fails there is counted elsewhere
template <class Ask>
OwnLawErrors compare_with_law(std::span<const DepthTruth> truths, const Ask& ask) {
  OwnLawErrors own;
  VectorSeries forces, torques;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const Outcome<Response> answer = ask(i);
    if (!answer.ok()) continue;
    const Response& truth = truths[i].response;
    const auto [response, scale] = scaled_about(answer.value, truth.reference);
    if (truths[i].force_judged) forces.add(truth.force, response.force, scale);
    if (truths[i].torque_judged) torques.add(truth.torque, response.torque, scale);
    own.unjudged[0] += truths[i].force_judged ? 0 : 1;
    own.unjudged[1] += truths[i].torque_judged ? 0 : 1;
  }
  own.errors = {forces.error(), torques.error()};
  return own;
}

}  // namespace sixdof::bench
