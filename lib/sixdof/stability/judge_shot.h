#pragma once

#include <vector>

#include <sixdof/stability/judge.h>

namespace sixdof::stability {

/// Bounds on the error of a length.
struct Bounds {
  double rounding;    ///< That of the input and of a backward stable computation.
  double resolution;  ///< Beyond that, what the algorithm declares.

  double largest() const { return rounding + resolution; }
  Verdict verdict(double error) const {
    return error <= rounding ? Verdict::exact : error <= largest() ? Verdict::resolution : Verdict::wrong;
  }
};

Bounds bounds_of(const Shot& shot, const Answers& answers);

/// Factor from an error of lengths to one of volumes: the area that may move.
double moving_area(const Shot& shot);

/// The angle by which rounding may turn a force at a depth (radians). A cap that is pushed out has an area like
/// depth^2, whose border moves by the rounding of lengths. A force by the volume law is itself an area, with an error
/// of the rounding times the body's size.
double rounding_angle(const Shot& shot, const Bounds& bounds, double depth, const Eigen::Vector3d& force,
                      const Profile& profile);

/// Whether a query gave no answer though it was asked for one, and what that means: a Finding per query.
void judge_statuses(const Shot& shot, std::size_t index, const Answers& answers, const Limits& limits,
                    std::vector<Finding>& findings);

/// Answers against Shot::truth, and against each other.
void judge_truth(const Case& member, std::size_t index, const Answers& answers, const Profile& profile,
                 std::vector<Finding>& findings);

/// An error of a length at one shot.
Finding length_finding(const char* metric, double error, double size, const Bounds& bounds, std::size_t shot,
                       std::string words);

}  // namespace sixdof::stability
