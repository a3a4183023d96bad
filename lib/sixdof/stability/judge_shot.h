#pragma once

#include <vector>

#include <sixdof/stability/judge.h>

namespace sixdof::stability {

/// Bounds on the error of a length, for what is measured at one shot.
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

/// An error of a volume: bounded as the length by which the surfaces of `measured` would have to move to cause it.
Finding volume_finding(const char* metric, double error, const Shot& measured, const Bounds& bounds, std::size_t shot,
                       std::string words);

/// An angle between two directions that should be the same (radians).
/// @param excused beyond `allowed` it counts as within the resolution while it is less than 90 degrees
Finding angle_finding(const char* metric, const Eigen::Vector3d& u, const Eigen::Vector3d& v, double allowed,
                      bool excused, std::size_t shot, std::string words);

/// What Traits::limits declare.
Finding declared_finding(const char* metric, const char* unit, std::size_t shot, std::string words);

/// Calls examine(name, status, words) for each kind of query.
template <class Examine>
void for_each_query(const Answers& answers, const Examine& examine) {
  examine("collide", answers.collide.outcome.status, answers.collide.words);
  examine("distance", answers.distance.outcome.status, answers.distance.words);
  examine("respond", answers.respond.outcome.status, answers.respond.words);
}

/// What a query that ended in this way did. @pre it is not Status::ok
Verdict verdict_of(Status status);

}  // namespace sixdof::stability
