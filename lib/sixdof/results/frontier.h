#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/results/estimate.h>
#include <sixdof/results/row.h>

/// Pareto frontiers in the plane of cost and error.

namespace sixdof::results {

/// A point of a plane of cost and error; of both the smaller is the better.
struct Tradeoff {
  Estimate cost, error;
  bool faulty = false;  ///< Has a fault (fault.h), so its error is not that of all configurations.
};

/// Whether `p` is to be preferred to `q`: its interval lies below that of `q` in one coordinate, and in the other its
/// value is not larger (up to k_rounding). Where both intervals overlap the points are not ranked. Nothing dominates by
/// a faulty point.
bool dominates(const Tradeoff& p, const Tradeoff& q);

/// Which points are on the Pareto frontier: no other dominates them and they are not faulty.
std::vector<bool> frontier(std::span<const Tradeoff> points);

/// Which points need more rounds of timing: they are on the frontier, or would be with another cost in its interval,
/// and their cost's interval overlaps that of another such point with another error.
std::vector<bool> uncertain(std::span<const Tradeoff> points);

/// A point of a study (a row of `sixdof precision`) in the plane of two metrics; empty where it lacks one of them.
std::optional<Tradeoff> tradeoff_of(const Row& point, const std::string& cost, const std::string& error);

/// Per point: on the frontier of all points, and on that of its own algorithm. Interpreted algorithms
/// (interpreter_of()) have frontiers of their own.
struct OnFrontier {
  bool overall = false, own = false;
};
std::vector<OnFrontier> frontiers(std::span<const Row> points, const std::string& cost, const std::string& error);

}  // namespace sixdof::results
