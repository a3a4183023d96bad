#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/harness/variants.h"

namespace sixdof::bench {

/// How many configurations a row, by its name, may ask in a list of rows; nothing if it does not belong to the list.
using Suite = std::function<std::optional<std::size_t>(std::string_view)>;

/// Reads a list of rows (bench/default_suite.json). A row belongs to it if one entry lists every part of the row's
/// name. "distance/algorithm:fcl-rss/pair:bunny/volume:05" needs an entry with "distance" under "query", "fcl-rss"
/// under "algorithm", and so on; "vps" stands for its variants, too (sixdof/query/variant.h); the word "all" instead of
/// a list allows everything, of algorithms those of default runs (Traits::in_default_runs()). Parts without a colon
/// behind the first ("II" of "scenario/II/algorithm:exact") are free, unless an entry has "scenario": ["II"].
/// "settings": {"voxel_size": "0.01"} in an entry: its rows are of these variants of its algorithms, which are in no
/// other entry. "sample": 32 in an entry: its rows ask at most 32 configurations (RowFields::sample_limit). The first
/// entry that a row belongs to counts.
/// @param external_algorithms belong wherever an entry lists algorithms
/// @param named_only algorithms that "all" leaves out
/// @param rivals for which "rivals" stands in a list of algorithms (common/rivals.h)
/// @throws BadFile
Suite read_suite(const std::filesystem::path& file, const std::vector<std::string>& external_algorithms,
                 const std::vector<std::string>& named_only, const std::vector<std::string>& rivals = {});

/// The variants that the "settings" of a list's entries need. @throws BadFile
std::vector<VariantRequest> suite_variants(const std::filesystem::path& file);

}  // namespace sixdof::bench
