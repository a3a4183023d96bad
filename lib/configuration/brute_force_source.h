#pragma once

#include <memory>

#include <sixdof/configuration/distance_source.h>

namespace sixdof {

/// `brute-force`: the least distance over all pairs of triangles, about 0.1 us each. It has no tree whose culling could
/// be wrong and shares no code with the backends, so it checks them where meshes are small.
std::shared_ptr<const DistanceSource> make_brute_force_source();

}  // namespace sixdof
