#pragma once

#include <Eigen/Core>

#include <sixdof/oracle/distance_search.h>

/// The closest points of bodies that are far apart. Internal: use distance.h.
///
/// Let s lead from A's centre to B's, let w = s / |s|, and let e be the difference of a point of B and a point of A,
/// each relative to its body's centre, x = w . e its part along w and p the length of the rest. Then
///   (|s + e|^2 - |s|^2) / (2 |s|) = x + (x^2 + p^2) / (2 |s|)
/// has its minimum at the same points as the distance |s + e|. Its terms are of the bodies' size, so it distinguishes
/// points whose distances round to the same double. A search for that minimum ends as soon as no pair is closer by more
/// than a few roundings of the distance.
///
/// From |s| = k_corners r on, where r is the sum of the radii, the second term is less than half a rounding of the
/// distance. There the closest points are the corners that reach farthest along w and -w, each found in one tree.
///
/// distance_search.cpp, which bounds distances themselves, would take long: the distances of thousands of pairs of
/// triangles differ by less than a rounding, and it measures all of these.
namespace sixdof::detail {

/// Distance of the centres divided by the sum of the radii. From k_far on bodies count as far apart; from k_corners on
/// only corners matter.
inline constexpr double k_far = 50.0;
inline constexpr double k_corners = 1e8;

/// Distances that exceed the smallest by at most this times the distance count as equal to it.
inline constexpr double k_far_pair_error = 10.0 * 0x1p-53;

/// Whether the bodies are farther apart than k_far. A function of the pose alone.
bool are_far(const DistanceBody& a, const DistanceBody& b, const Pose& X_AB);

/// Sets the closest pair with its points and distance, whatever the search knew before: the same on every instruction
/// set. No distance is less by more than k_far_pair_error; it is infinite if it exceeds the largest double.
/// @pre are_far()
void take_far_pair(DistanceSearch& search);

}  // namespace sixdof::detail
