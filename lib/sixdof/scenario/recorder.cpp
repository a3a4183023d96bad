#include <sixdof/scenario/recorder.h>

#include <chrono>
#include <ctime>
#include <utility>

#include <fmt/format.h>

#include <sixdof/query/ask.h>

namespace sixdof {
namespace {

/// The query alone; exceptions and values that are not finite become a status.
Outcome<Response> respond_guarded(Query& query, const Pose& X_AB, std::string& diagnosis) {
  const auto failed = [&](std::string words) { diagnosis = std::move(words); };
  const auto ask = [&] {
    Outcome<Response> outcome = query.respond(X_AB);
    examine(query, outcome, failed);
    return outcome;
  };
  return ask_guarded(ask, failed);
}

}  // namespace

Outcome<Response> respond_at(const Scenario& scenario, Query& query, double progress, std::string& diagnosis) {
  const Pose X_AB = scenario.pose(progress);
  Outcome<Response> outcome = respond_guarded(query, X_AB, diagnosis);
  if (outcome.ok()) outcome.value = outcome.value.about(X_AB * scenario.reference_b());
  return outcome;
}

Recording record(const Scenario& scenario, Query& query, std::size_t count) {
  Recording recording;
  recording.progress = scenario.steps(count);
  for (const double progress : recording.progress) recording.poses.push_back(scenario.pose(progress));
  std::string diagnosis;
  respond_guarded(query, recording.poses.front(), diagnosis);
  const std::clock_t processor_start = std::clock();
  for (const Pose& X_AB : recording.poses) {
    const auto start = std::chrono::steady_clock::now();
    Outcome<Response> outcome = respond_guarded(query, X_AB, diagnosis);
    const auto stop = std::chrono::steady_clock::now();
    Response response;
    if (outcome.ok()) {
      response = outcome.value.about(X_AB * scenario.reference_b());
    } else if (recording.first_failure.empty()) {
      recording.first_failure = fmt::format("{}: {}", to_string(outcome.status), diagnosis);
    }
    recording.status.push_back(outcome.status);
    recording.forces.push_back(response.force);
    recording.torques.push_back(response.torque);
    recording.penalties.push_back(response.penalty);
    recording.times_ns.push_back(std::chrono::duration<double, std::nano>(stop - start).count());
  }
  const double processor_s = static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
  recording.processor_ns = processor_s * 1e9 / static_cast<double>(count);
  return recording;
}

}  // namespace sixdof
