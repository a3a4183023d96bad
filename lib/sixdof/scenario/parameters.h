#pragma once

#include <string>
#include <vector>

#include <sixdof/query/settings.h>
#include <sixdof/scenario/solids.h>

namespace sixdof {

/// Pieces that the scenarios' settings share.
Parameter length_parameter(const std::string& name, const std::string& meaning, const std::string& standard);

/// "facets" and "round".
void add_round_parameters(std::vector<Parameter>& parameters);
int facets_of(const Settings& settings);
RoundParts round_parts_of(const Settings& settings);

/// @throws BadArgument with these words unless `holds`.
void require(bool holds, const std::string& words);

}  // namespace sixdof
