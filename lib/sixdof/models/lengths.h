#pragma once

#include <string>

namespace sixdof {

/// @throws BadArgument unless `value` is positive and finite: "cone: radius is -1, but must be positive and finite".
void check_length(const std::string& recipe, const std::string& which, double value);

/// @throws BadArgument with "RECIPE: MESSAGE" unless `holds`.
void check_shape(bool holds, const std::string& recipe, const std::string& message);

}  // namespace sixdof
