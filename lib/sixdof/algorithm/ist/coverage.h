#pragma once

#include <span>

#include <sixdof/algorithm/ist/sphere.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::ist {

/// How far the greatest gap may be overestimated, as a part of it.
inline constexpr double k_gap_tolerance = 0.05;

/// An upper bound on the distance from any point of the mesh's surface to the nearest of the spheres inside (length):
/// what queries of the spheres do not see. It is at most k_gap_tolerance too large. @pre at least one sphere
double largest_gap(const Mesh& mesh, std::span<const Sphere> spheres);

}  // namespace sixdof::ist
