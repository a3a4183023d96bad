#pragma once

#include <vector>

#include <sixdof/stability/judge.h>

namespace sixdof::stability {

/// Bounds on the error of a length.
struct Bounds {
  double rounding;    ///< That of the input and of a backward stable computation.
  double resolution;  ///< Beyond that, what an algorithm that approximates declares; 0 for others.
  double slack;       ///< Beyond both, k_declared_accuracy.

  double largest() const { return rounding + resolution + slack; }
  Verdict verdict(double error) const {
    return error <= rounding ? Verdict::exact : error <= largest() ? Verdict::resolution : Verdict::wrong;
  }
  /// From which depth on a direction is known.
  double least_depth() const { return rounding + resolution; }
};

Bounds bounds_of(const Shot& shot, const Answers& answers);

/// Factor from an error of lengths to one of volumes: the area that may move.
double moving_area(const Shot& shot);

/// The angle by which rounding may turn a force at a depth (radians): the cap that is pushed out is as wide as it is
/// deep at least, and its border moves by the rounding of lengths.
double rounding_angle(const Bounds& bounds, double depth);

/// Whether a query gave no answer though it was asked for one, and what that means: a Finding per query.
void judge_statuses(const Shot& shot, std::size_t index, const Answers& answers, const Limits& limits,
                    std::vector<Finding>& findings);

/// Answers against Shot::truth, and against each other.
void judge_truth(const Case& member, std::size_t index, const Answers& answers, const Traits& traits,
                 std::vector<Finding>& findings);

/// An error of a length at one shot.
Finding length_finding(const char* metric, double error, double size, const Bounds& bounds, std::size_t shot,
                       std::string words);

}  // namespace sixdof::stability
