#pragma once

#include <string>
#include <vector>

#include <sixdof/algorithm/settings.h>
#include <sixdof/scenario/solids.h>

namespace sixdof {

/// Pieces that the scenarios' settings share.
Knob length_knob(const std::string& name, const std::string& meaning, const std::string& standard);

/// "facets" and "round".
void add_round_knobs(std::vector<Knob>& knobs);
int facets_of(const Settings& settings);
RoundParts round_parts_of(const Settings& settings);

/// @throws BadArgument with these words unless `holds`.
void require(bool holds, const std::string& words);

}  // namespace sixdof
