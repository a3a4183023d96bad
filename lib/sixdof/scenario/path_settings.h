#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// The settings of an algorithm along a scenario's path. Some algorithms have another resolution there than by default:
/// one of at most 0.9 ms a query, the paper's time (README.md, "Resolutions along the paths"). It holds where neither
/// `assignments` nor the name of a variant sets one of its parameters.
/// @param assignments what the user sets, each "parameter=value"
/// @throws BadArgument as Settings::set_all() does
Settings settings_along(std::string_view scenario, const Algorithm& algorithm,
                        const std::vector<std::string>& assignments);

}  // namespace sixdof
