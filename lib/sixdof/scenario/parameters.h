#pragma once

#include <string>
#include <vector>

#include <sixdof/query/settings.h>
#include <sixdof/scenario/solids.h>

/// Parameters that several scenarios share.

namespace sixdof {

/// A length between 1e-6 and 1e6 in the meshes' unit.
Parameter length_parameter(const std::string& name, const std::string& meaning, const std::string& default_value);

/// "facets" and "round".
void add_round_parameters(std::vector<Parameter>& parameters);
int facets_of(const Settings& settings);
RoundParts round_parts_of(const Settings& settings);

/// @throws BadArgument with this message unless `holds`
void require(bool holds, const std::string& message);

}  // namespace sixdof
