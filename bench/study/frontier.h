#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "bench/study/estimate.h"

namespace sixdof::study {

/// A point of a plane of cost and error; of both the smaller is the better.
struct Tradeoff {
  Estimate cost, error;
  bool faulty = false;  ///< Has failures, so its error is not that of all configurations.
};

/// Values up to this one are errors of rounding: they count as equal.
inline constexpr double k_rounding = 1e-12;

/// Whether `p` is to be preferred to `q`: its interval lies below that of `q` in one coordinate, and in the other its
/// value is not larger. Where both intervals overlap the points are not ranked. Nothing dominates by a faulty point.
bool dominates(const Tradeoff& p, const Tradeoff& q);

/// Which points are on the Pareto frontier: no other dominates them and they are not faulty.
std::vector<bool> frontier(std::span<const Tradeoff> points);

/// Which points need more rounds of timing: they are on the frontier, or would be with another cost in its interval,
/// and their cost's interval overlaps that of another such point with another error.
std::vector<bool> uncertain(std::span<const Tradeoff> points);

}  // namespace sixdof::study
