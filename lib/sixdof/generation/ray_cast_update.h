#pragma once

#include <sixdof/generation/ray_cast_traversal.h>
#include <sixdof/geometry/triangle_pair.h>

namespace sixdof::ray_cast {

/// Replaces the best hit by that of a pair of triangles if it is larger by more than a tie. Internal: use ray_cast.h.
/// @return whether it did; if not, it may set best.separating_axis
bool try_update(Cast& cast, TrianglePair pair);

}  // namespace sixdof::ray_cast
