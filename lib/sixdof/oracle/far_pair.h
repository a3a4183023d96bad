#pragma once

#include <Eigen/Core>

#include <sixdof/oracle/distance_search.h>

/// The closest points of bodies that are far apart. Internal: use distance.h.
///
/// Let s lead from A's centre to B's, let w = s / |s|, and let e be the difference of a point of B and a point of A,
/// each relative to its body's centre. Their distance |s + e| is between |s| + w . e and that + |e|^2 / (2 |s|). |e| is
/// at most r, the sum of the radii. Where |s| > k_far r, the last term is less than half a rounding of the distance. So
/// the closest points are the corners that reach farthest along w and -w. Each is found in one tree.
///
/// distance_search.cpp would take long there: coordinates are rounded to a visible part of the bodies' size, the
/// distances of thousands of pairs of triangles differ by no more, and it measures all of these.
namespace sixdof::detail {

/// Distance of the centres per sum of the radii, from which bodies are far apart.
inline constexpr double k_far = 1e8;

/// Whether the bodies are farther apart than k_far. A function of the pose alone.
bool are_far(const DistanceBody& a, const DistanceBody& b, const Pose& X_AB);

/// Sets the closest pair with its points and distance, whatever the search knew before. Each point is the farthest
/// corner along w up to a unit in the last place of the distance, the same corner on every instruction set. The
/// distance is exact up to k_triangle_distance_error, and infinite if it exceeds the largest double.
/// @pre are_far()
void take_far_pair(DistanceSearch& search);

}  // namespace sixdof::detail
