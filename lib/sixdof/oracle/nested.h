#pragma once

#include <cstdint>
#include <vector>

#include <sixdof/geometry/pose.h>
#include <sixdof/oracle/distance_search.h>

namespace sixdof::detail {

/// Whether a piece of one surface lies inside the other body, given that the surfaces do not meet: one vertex of each
/// piece decides. False unless both meshes are solid. @param triangles scratch
bool is_nested(const DistanceBody& a, const DistanceBody& b, const Pose& X_AB, std::vector<std::uint32_t>& triangles);

}  // namespace sixdof::detail
