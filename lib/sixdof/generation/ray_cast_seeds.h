#pragma once

#include <vector>

#include <sixdof/generation/ray_cast_search.h>

/// Where a ray's first search starts. Internal: use distance_generator.h.
namespace sixdof::ray_cast {

/// Replaces the best hit by that of a pair of triangles which is probably hit early, if it is larger. Of corners that
/// are spread over both surfaces it takes the pair that comes within the target first, and from there in turn the
/// closest corner of the other surface. The same pair on every instruction set.
void seed_first_hit(Cast& cast);

}  // namespace sixdof::ray_cast
