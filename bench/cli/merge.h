#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof merge DIR -o FILE`: one configuration set of the shards in a folder.
void add_merge_command(CLI::App& app);

}  // namespace sixdof::cli
