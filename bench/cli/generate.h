#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof generate --a A [--b B] --grid GRID [--distances LIST] [--volumes LIST] -o FILE`: makes a configuration set.
/// With `--shards N [--shard I] -o FOLDER` in parts; with `--plan` it only prints what would be made and at what cost.
void add_generate_command(CLI::App& app);

}  // namespace sixdof::cli
