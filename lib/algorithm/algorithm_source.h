#pragma once

#include <memory>

#include <sixdof/algorithm/algorithm.h>
#include <sixdof/configuration/distance_source.h>

namespace sixdof {

/// Lets an algorithm define the distances of a configuration set. It has to be exact, and its answers have to depend on
/// the pose alone. `algorithm` outlives the oracle.
/// @throws BadArgument if the algorithm answers no distance queries
std::shared_ptr<const DistanceSource> make_distance_source(const Algorithm& algorithm);

}  // namespace sixdof
