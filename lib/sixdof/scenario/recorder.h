#pragma once

#include <string>
#include <vector>

#include <sixdof/scenario/scenario.h>

namespace sixdof {

/// Steps follow one another at the rate of a haptic loop, so a recording of 1,000 steps is one second.
inline constexpr double k_haptic_rate_hz = 1000.0;
inline constexpr std::size_t k_default_steps = 1000;

/// An algorithm's answers along a scenario's path: one entry per step in every array. A step without an answer has a
/// status that says why, and zero wrench and penalty (a device would be sent zero).
struct Recording {
  std::vector<double> progress;
  std::vector<Pose> poses;  ///< X_AB.
  std::vector<Status> status;
  std::vector<Eigen::Vector3d> forces;   ///< On B, in A's frame.
  std::vector<Eigen::Vector3d> torques;  ///< On B about the scenario's reference point, in A's frame.
  std::vector<double> penalties;
  std::vector<double> times_ns;  ///< Wall-clock time of each query alone, successful or not.
  double processor_ns = 0.0;     ///< Mean processor time per step, the recorder's own overhead included.
  std::string first_failure;     ///< Diagnosis of the first step without an answer; empty if there is none.

  std::size_t size() const { return progress.size(); }
};

/// Asks `query` for its response at one progress, torque about the scenario's reference point. An exception becomes
/// Status::failed, a value that is not finite Status::non_finite; `diagnosis` receives the reason.
Outcome<Response> respond_at(const Scenario& scenario, Query& query, double progress, std::string& diagnosis);

/// Runs `query`, prepared for the scenario's a() and b(), over `count` steps (Scenario::steps) in order, after one
/// untimed query at the first step. Does not throw for a query that fails. @throws BadArgument for fewer than 2 steps
Recording record(const Scenario& scenario, Query& query, std::size_t count = k_default_steps);

}  // namespace sixdof
