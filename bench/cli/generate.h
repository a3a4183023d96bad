#pragma once

#include <string_view>
#include <vector>

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof generate --a A [--b B] --grid GRID [--distances LIST] [--volumes LIST] -o FILE`: makes a configuration set;
/// with `--shards N [--shard I] -o DIR` in parts.
void add_generate_command(CLI::App& app);

/// Percentages as typed: numbers and ranges FIRST:LAST, separated by commas ("0,1,5:10"). @throws BadArgument
std::vector<int> parse_percents(std::string_view text);

}  // namespace sixdof::cli
