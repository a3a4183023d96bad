#pragma once

#include <memory>
#include <string>

#include <sixdof/algorithm/registry.h>
#include <sixdof/configuration/distance_source.h>

namespace sixdof::cli {

/// The oracle of that name: "brute-force", or an algorithm of the registry (which outlives it) that answers distances.
/// @throws BadArgument
std::shared_ptr<const DistanceSource> distance_source_argument(const Registry& registry, const std::string& name);

}  // namespace sixdof::cli
