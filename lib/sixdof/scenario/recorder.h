#pragma once

#include <string>
#include <vector>

#include <sixdof/scenario/scenario.h>

namespace sixdof {

/// Stamps follow one another at the rate of a haptic loop, so a recording of 1,000 stamps is one second.
inline constexpr double k_haptic_rate_hz = 1000.0;
inline constexpr std::size_t k_default_stamps = 1000;

/// What an algorithm answered along a scenario's path: one entry per time stamp in every array. A stamp without an
/// answer is a stamp: its status says why, its wrench and penalty are zero (what a device would be sent).
struct Recording {
  std::vector<double> progress;
  std::vector<Pose> poses;  ///< X_AB.
  std::vector<Status> status;
  std::vector<Eigen::Vector3d> forces;   ///< On B, in A's frame.
  std::vector<Eigen::Vector3d> torques;  ///< On B about the scenario's reference point, in A's frame.
  std::vector<double> penalties;
  std::vector<double> times_ns;  ///< Of the query alone, successful or not.
  double processor_ns = 0.0;     ///< Mean processor time per stamp, with the recorder's own some 100 ns.
  std::string first_failure;     ///< Diagnosis of the first stamp without an answer; empty if there is none.

  std::size_t size() const { return progress.size(); }
};

/// Asks `query` for its response at one progress. Exceptions become Status::failed, a value that is not finite becomes
/// Status::non_finite; torque about the scenario's reference point. `words` receives the reason of a failure.
Outcome<Response> respond_at(const Scenario& scenario, Query& query, double progress, std::string& words);

/// Runs `query`, prepared for the scenario's a() and b(), over `count` stamps (Scenario::stamps), in order, after one
/// untimed query at the first stamp. Never throws for what the query does. @throws BadArgument for fewer than 2 stamps.
Recording record(const Scenario& scenario, Query& query, std::size_t count = k_default_stamps);

}  // namespace sixdof
